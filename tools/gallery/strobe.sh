nutik-cl encode --tolerance 2 clip.mkv clip.tik

# While the club is fast, only the golfer is bright in the mean. The club rests at the right before the swing and at the
# left after it, the golfer in the middle all the time.
nutik-cl --start 0.3s --exposure 0.5s clip.tik mean.png
nutik-cl mask --tag 1 --rectangle 0,0,370,432 --tag 2 --rectangle 318,85,104,306 \
              --tag 255 --threshold mean.png 70 --largest --grow 2 clip.tik regions.pgm --preview preview.png

# 24 flashes of one picture each, 10 times as bright, because each shows the club in another place. The still scene is
# subtracted 9 times: at the right as it is after the swing, at the left as it was before. Around the golfer flashes count
# once.
flashes() { nutik-cl shutter strobe:24,1/7 --fps 240 --start 48f --exposure 162f "$@"; }
flashes --tag 0 --gain 20 |
  sed '$s/$/, [1100000000:0], [1100000001:-18], [1200000000:-18], [1200000001:0]/' > picture.fn
flashes --tag 1 --gain 20 | sed '$s/^M1/M1 [0:-18], [100000000:-18], [100000001:0],/' >> picture.fn
flashes --tag 2 >> picture.fn
nutik-cl shutter box --tag 255 --fps 240 --start 0.6s --exposure 1f >> picture.fn
nutik-cl -m regions.pgm -k picture.fn --feather 6px clip.tik picture.png
FnPlotter.py picture.fn --duration 1.25s -o plot.png
