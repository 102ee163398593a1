nutik-cl encode --tolerance 2 clip.mkv clip.tik

# Three parts: the street before the car comes, subtracted; the drive, ever stronger; the flash at its end.
cat > picture.fn << END
M0{[0:-26.5], [150000000:-26.5], [150000001:0],
   [200000000:0], [1791666667:5],
   [1791666668:210], [1800000000:210], [1800000001:0]}
END
nutik-cl -k picture.fn clip.tik picture.png
FnPlotter.py picture.fn --duration 2s -o plot.png
