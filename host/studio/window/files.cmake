set(files appearance.cpp appearance.hpp autosave.cpp autosave.hpp command_line.cpp command_line.hpp files.cpp main_window.cpp main_window.hpp
    menus.cpp picture_export.cpp picture_export.hpp project_file.cpp project_file.hpp
    starting_points.cpp starting_points.hpp status_line.cpp status_line.hpp)
