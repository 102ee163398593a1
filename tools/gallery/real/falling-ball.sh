nutik-cl --start 0f --exposure 15f ball_12bit.mraw picture.png
