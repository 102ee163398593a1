nutik-cl --start 0f --exposure 15f cine_781.cine picture.png
