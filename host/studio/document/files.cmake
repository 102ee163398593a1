set(files document.cpp document.hpp)
