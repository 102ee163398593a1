set(files boxcars.cpp boxcars.hpp curve_editor.cpp curve_editor.hpp curve_keys.cpp curve_mouse.cpp curve_paint.cpp
          curve_paint.hpp drags.cpp drags.hpp gain_axis.cpp gain_axis.hpp handles.cpp handles.hpp number_editor.cpp
          number_editor.hpp plot_frame.hpp points.cpp points.hpp snapping.cpp snapping.hpp)
