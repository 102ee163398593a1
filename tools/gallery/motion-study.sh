# When does something happen, and where is the ball? Look at activity.png and contact.png.
nutik-cl encode --tolerance 2 clip.mkv clip.tik
nutik-cl activity --by 16 clip.tik activity.png
nutik-cl contact --every 0.2s clip.tik contact.png

# At 0 s the room is empty. At five times the ball is what differs from that.
nutik-cl mask --tag 1 --difference 0.36s 0s --largest --smooth 1 --grow 1 \
              --tag 2 --difference 0.75s 0s --largest --smooth 1 --grow 1 \
              --tag 3 --difference 1.27s 0s --largest --smooth 1 --grow 1 \
              --tag 4 --difference 1.78s 0s --largest --smooth 1 --grow 1 \
              --tag 5 --difference 2.20s 0s --largest --smooth 1 --grow 1 \
              clip.tik regions.pgm --preview preview.png

# Its way, three times as strong. The empty room is subtracted again.
echo 'M0 [0:-51], [100000000:-51], [100000001:3], [2700000000:3], [2700000001:0]' > picture.fn
nutik-cl shutter box --tag 1 --fps 240 --start 0.36s --exposure 1f >> picture.fn
nutik-cl shutter box --tag 2 --fps 240 --start 0.75s --exposure 1f >> picture.fn
nutik-cl shutter box --tag 3 --fps 240 --start 1.27s --exposure 1f >> picture.fn
nutik-cl shutter box --tag 4 --fps 240 --start 1.78s --exposure 1f >> picture.fn
nutik-cl shutter box --tag 5 --fps 240 --start 2.20s --exposure 1f >> picture.fn
nutik-cl -m regions.pgm -k picture.fn clip.tik picture.png
FnPlotter.py picture.fn --duration 2.8s -o plot.png
