set(files capture_facts.hpp document.cpp document.hpp texts.cpp texts.hpp)
