set(files changed_pixels.cpp changed_pixels.hpp exposure_of.cpp exposure_of.hpp jobs.cpp jobs.hpp live_view.cpp live_view.hpp overview.cpp overview.hpp
    opening.cpp opening.hpp picture_image.cpp picture_image.hpp)
