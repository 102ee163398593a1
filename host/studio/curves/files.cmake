set(files curve_editor.cpp curve_editor.hpp curve_keys.cpp curve_mouse.cpp curve_paint.cpp
          curve_paint.hpp drags.cpp drags.hpp handles.cpp handles.hpp number_editor.cpp
          number_editor.hpp points.cpp points.hpp snapping.cpp snapping.hpp)
