# For the preset `aarch64`: Debian's compiler for it on another machine, and libraries of Debian's second architecture
# beside that machine's own. tools/cross makes a system that has both.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
# Tests run in it; the preset needs no such processor.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
