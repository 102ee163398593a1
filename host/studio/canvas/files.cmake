set(files canvas.cpp canvas.hpp outlines.cpp outlines.hpp view.cpp view.hpp)
