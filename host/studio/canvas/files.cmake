set(files canvas.cpp canvas.hpp canvas_input.cpp)
