nutik-cl encode --tolerance 2 clip.mkv clip.tik

# The salmon at 1.65 s: what differs from an earlier picture, without the water, which moves anyway.
nutik-cl mask --tag 255 --difference 1.65s 0s --grow 1 \
              --tag 0 --changed-between 0s 1.2s --grow 5 \
              clip.tik regions.pgm --preview preview.png

# The water for 1.2 s, before the leap; the salmon for a single picture.
nutik-cl shutter box --tag 0 --exposure 1.2s > picture.fn
nutik-cl shutter box --tag 255 --fps 120 --start 1.65s --exposure 1f >> picture.fn
nutik-cl -m regions.pgm -k picture.fn clip.tik picture.png
FnPlotter.py picture.fn --duration 2.25s -o plot.png
