nutik-cl study --style rear-curtain --from 840f --to 885f one-by-one-person-detection.mp4 picture.png
