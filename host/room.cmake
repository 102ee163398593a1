# nutik_room(<name> SOURCES … HEADERS … [USES …] [LINKS …] [PRIVATE_LINKS …])
#
# A room of the house: the library nutik::<name> from host/<name>/. HEADERS are those that other projects
# may include, and those that these include: they are installed, and each compiles on its own there. USES
# names the rooms it knows of; LINKS and PRIVATE_LINKS what else it needs, in its headers or only inside.
# What a room newly links to, nutik-config.cmake.in has to find.

add_library(nutik_warnings INTERFACE)
target_compile_options(nutik_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow -Wpedantic)
# GCC 12 warns of std::string's own code (its bug 105651).
target_compile_options(nutik_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(NUTIK_WARNINGS_AS_ERRORS)
  target_compile_options(nutik_warnings INTERFACE -Werror)
endif()

# <format> where the standard library has it, else fmt (host/capture/format.hpp).
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -std=c++20)
check_cxx_source_compiles("#include <format>\n#ifndef __cpp_lib_format\n#error\n#endif\nint main() {}"
                          NUTIK_HAS_STD_FORMAT)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT NUTIK_HAS_STD_FORMAT)
  find_package(fmt REQUIRED)
endif()

function(nutik_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;HEADERS;USES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(nutik_${name} STATIC ${ROOM_SOURCES})
  add_library(nutik::${name} ALIAS nutik_${name})
  set_target_properties(nutik_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(
    nutik_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/host>
                         $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/nutik>)
  target_compile_features(nutik_${name} PUBLIC cxx_std_20)
  list(TRANSFORM ROOM_USES PREPEND nutik::)
  target_link_libraries(nutik_${name} PUBLIC ${ROOM_USES} ${ROOM_LINKS}
                                      PRIVATE ${ROOM_PRIVATE_LINKS} $<BUILD_INTERFACE:nutik_warnings>)
  install(TARGETS nutik_${name} EXPORT nutik-targets)
  install(FILES ${ROOM_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nutik/${name})
endfunction()
