nutik-cl background --deflicker one-by-one-person-detection.mp4 picture.png
