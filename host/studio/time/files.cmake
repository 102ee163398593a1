set(files time_axis.cpp time_axis.hpp)
