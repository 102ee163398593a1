# Sourced by what tries an installed program: said TEXT heads what follows, use_program makes pictures in this folder, and
# use_python PYTHON more of them, beside those.

said() { printf '\n== %s\n' "$*"; }

use_program() {
  said "a picture of a clip"
  # Sixty grey pictures of 64 x 48 pixels: a bright square that moves to the right for a second.
  square=zzzzzzzzzzzzzzzz
  for ((k = 0; k < 60; ++k)); do
    for ((y = 0; y < 48; ++y)); do
      if ((y >= 16 && y < 32)); then
        printf '%*s%s%*s' $((k * 48 / 59)) '' $square $((48 - k * 48 / 59)) ''
      else
        printf '%64s' ''
      fi
    done
  done > clip.raw
  nutik-cl --raw 64x48:gray -f 60 clip.raw clip.tik
  nutik-cl --start 10f --exposure 20f clip.tik blur.png
  nutik-cl study clip.tik -o study.png
  nutik-cl video --out-fps 24 clip.tik film.mp4
  nutik-cl thumbnail clip.tik
  test -s blur.png -a -s study.png -a -s film.mp4 -a -s clip-thumbnail.png
}

use_python() {
  "$1" - <<'PYTHON'
import numpy as np
import nutik
capture = nutik.open("clip.tik")
picture = capture.render(start="10f", exposure="20f", codes=True)
picture.write("python.png")
assert open("python.png", "rb").read()[:8] == open("blur.png", "rb").read()[:8]
pictures = np.arange(8 * 6 * 5, dtype=np.uint8).reshape(8, 6, 5)
assert (nutik.encode(pictures, rate=8).render(start="3f", exposure="1f", codes=True).array == pictures[3]).all()
assert nutik.open("film.mp4", rate=24).shape[0] > 0
print("nutik", nutik.__version__, picture.array.shape)
PYTHON
}
