// nutik-cl: a process that runs one command line.
#include <cstddef>

#include "app/run.hpp"

int main(int argc, char** argv) { return nutik::app::run_process({argv, static_cast<std::size_t>(argc)}); }
