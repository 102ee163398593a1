nutik-cl study --style rear-curtain --from 840f --to 885f --between auto one-by-one-person-detection.mp4 picture.png
