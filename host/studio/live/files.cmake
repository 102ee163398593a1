set(files changed_pixels.cpp changed_pixels.hpp jobs.cpp jobs.hpp live_view.cpp live_view.hpp
    opening.cpp opening.hpp)
