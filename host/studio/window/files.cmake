set(files appearance.cpp appearance.hpp autosave.cpp autosave.hpp clip_dialog.cpp clip_dialog.hpp files.cpp
    main_window.cpp main_window.hpp
    menus.cpp project_file.cpp project_file.hpp
    started_work.cpp started_work.hpp status_line.cpp status_line.hpp)
