nutik-cl encode --tolerance 2 clip.mkv clip.tik

# In the mean of the whole swing only what hardly moves is bright: the golfer, but not the club.
nutik-cl --start 0s --exposure 1.2s clip.tik mean.png
nutik-cl mask --threshold mean.png 70 --largest --smooth 2 clip.tik regions.pgm --preview preview.png

# 24 flashes: the golfer at their mean, the club ten times as bright, for it is elsewhere at each.
nutik-cl shutter strobe:24,0.1 --exposure 1.2s --tag 255 > picture.fn
nutik-cl shutter strobe:24,0.1 --exposure 1.2s --tag 0 --gain 10 >> picture.fn
nutik-cl -m regions.pgm -k picture.fn clip.tik picture.png
FnPlotter.py picture.fn --capture clip.tik -o plot.png
