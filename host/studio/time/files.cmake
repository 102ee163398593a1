set(files strip_input.cpp time_axis.cpp
          time_axis.hpp time_fields.cpp time_fields.hpp time_strip.cpp time_strip.hpp times.cpp times.hpp
          time_view.cpp time_view.hpp)
