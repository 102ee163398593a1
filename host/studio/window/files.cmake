set(files appearance.cpp appearance.hpp autosave.cpp autosave.hpp files.cpp
    main_window.cpp main_window.hpp
    menus.cpp options_dialog.cpp options_dialog.hpp seeing.cpp project_file.cpp project_file.hpp
    start_page.cpp start_page.hpp starting.cpp
    started_work.cpp started_work.hpp status_line.cpp status_line.hpp)
