set(files canvas_input.cpp picture_canvas.cpp picture_canvas.hpp)
