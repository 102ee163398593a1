set(files covering.cpp covering.hpp difference_dialog.cpp difference_dialog.hpp mask_tools.cpp mask_tools.hpp region_edits.cpp region_edits.hpp
    region_list.cpp region_list.hpp )
