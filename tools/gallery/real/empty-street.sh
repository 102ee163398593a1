nutik-cl plate --deflicker one-by-one-person-detection.mp4 picture.png
