nutik-cl study --from 1175f --to 1240f --moments 2 one-by-one-person-detection.mp4 picture.png
