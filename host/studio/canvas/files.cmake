set(files canvas.cpp canvas.hpp canvas_input.cpp outlines.cpp outlines.hpp view.cpp view.hpp)
