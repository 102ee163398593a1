nutik-cl encode --tolerance 2 clip.mkv clip.tik

# 256 columns, each a picture later than the one to its left.
nutik-cl mask --grid 256x1 clip.tik regions.pgm
for column in {0..255}; do
  nutik-cl shutter box --fps 120 --start ${column}f --exposure 1f --tag $column
done > picture.fn
nutik-cl -m regions.pgm -k picture.fn clip.tik picture.png
head -n 8 picture.fn > first-four.fn
FnPlotter.py first-four.fn --duration 13/6s --zoom 0ms..50ms -o plot.png
