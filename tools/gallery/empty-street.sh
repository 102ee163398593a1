nutik-cl encode --tolerance 2 clip.mkv clip.tik

# Each of 32 columns is exposed when it is quietest: when nobody is in it.
nutik-cl mask --grid 32x1 clip.tik regions.pgm
nutik-cl activity --by 6 -m regions.pgm --tag all --moment quietest clip.tik |
  xargs -L1 nutik-cl shutter box clip.tik > picture.fn
nutik-cl -m regions.pgm -k picture.fn clip.tik picture.png
head -n 8 picture.fn > first-four.fn
FnPlotter.py first-four.fn --duration 9s -o plot.png

# The same in one command, which asks each pixel for itself.
nutik-cl background clip.tik plate.png
