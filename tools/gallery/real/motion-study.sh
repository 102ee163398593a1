nutik-cl study one-by-one-person-detection.mp4 picture.png
