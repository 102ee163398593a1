set(files colours.cpp colours.hpp sample_times.cpp sample_times.hpp series.cpp series.hpp strip_input.cpp time_axis.cpp
          time_axis.hpp time_fields.cpp time_fields.hpp time_strip.cpp time_strip.hpp typed_numbers.cpp typed_numbers.hpp
          view_events.hpp)
