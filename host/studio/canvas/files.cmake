set(files canvas_input.cpp light_histogram.cpp light_histogram.hpp picture_canvas.cpp picture_canvas.hpp)
