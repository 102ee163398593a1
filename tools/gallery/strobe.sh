nutik-cl encode --tolerance 2 clip.mkv clip.tik

# While the club is fast, only the golfer is bright in the mean.
nutik-cl --start 0.3s --exposure 0.5s clip.tik mean.png
nutik-cl mask --threshold mean.png 70 --largest --grow 2 clip.tik regions.pgm --preview preview.png

# The golfer at 0.6 s. Round him 24 flashes of a picture each, 10 times as bright, for each shows the club elsewhere;
# what is still there after the swing is taken away 9 times.
nutik-cl shutter box --tag 255 --fps 240 --start 0.6s --exposure 1f > picture.fn
nutik-cl shutter strobe:24,1/7 --tag 0 --fps 240 --start 48f --exposure 162f --gain 20 |
  sed '$s/$/, [1100000000:0], [1100000001:-18], [1200000000:-18], [1200000001:0]/' >> picture.fn
nutik-cl -m regions.pgm -k picture.fn clip.tik picture.png
FnPlotter.py picture.fn --capture clip.tik -o plot.png
