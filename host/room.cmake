# nutik_room(<name> SOURCES … [HEADERS …] [USES …] [LINKS …] [PRIVATE_LINKS …])
#
# A room of the house: the library nutik::<name> from host/<name>/. HEADERS are those that other projects
# may include, and those that these include (without the word, all): they are installed, and each compiles on its own there. USES
# names the rooms it knows of; LINKS and PRIVATE_LINKS what else it needs, in its headers or only inside.
# What a room newly links to, nutik-config.cmake.in has to find.

add_library(nutik_warnings INTERFACE)
target_compile_options(nutik_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow -Wpedantic)
# GCC 12 warns of std::string's own code (its bug 105651).
target_compile_options(nutik_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# If files are compiled together, names of one seem to shadow those of another, and GCC takes each file for a header.
if(CMAKE_UNITY_BUILD)
  target_compile_options(nutik_warnings INTERFACE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(NUTIK_WARNINGS_AS_ERRORS)
  target_compile_options(nutik_warnings INTERFACE -Werror)
endif()

# What makes a mistake in our code harder to use for who feeds it files. Linked to whatever has our warnings.
option(NUTIK_HARDENED "Stack protector, checked libc calls, read-only relocations, position-independent programs" ON)
option(NUTIK_LIBRARY_ASSERTIONS "Check indices of the standard library's containers, also in optimized builds" ON)
add_library(nutik_hardening INTERFACE)
if(NUTIK_HARDENED)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES CXX)
  target_compile_options(nutik_hardening INTERFACE -fstack-protector-strong)
  # The C library checks what an optimizer knows; sanitizers check more, and in their own way.
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize" AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    target_compile_options(nutik_hardening INTERFACE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  endif()
  target_link_options(nutik_hardening INTERFACE LINKER:-z,relro LINKER:-z,now)
endif()
if(NUTIK_LIBRARY_ASSERTIONS)
  target_compile_definitions(nutik_hardening INTERFACE _GLIBCXX_ASSERTIONS)
endif()
target_link_libraries(nutik_warnings INTERFACE nutik_hardening)

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
                         $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(nutik_${name} PUBLIC cxx_std_20)
  list(TRANSFORM ROOM_USES PREPEND nutik::)
  target_link_libraries(nutik_${name} PUBLIC ${ROOM_USES} ${ROOM_LINKS}
                                      PRIVATE ${ROOM_PRIVATE_LINKS} $<BUILD_INTERFACE:nutik_warnings>)
  set_property(GLOBAL APPEND PROPERTY NUTIK_ROOMS ${name})
  install(TARGETS nutik_${name} EXPORT nutik-targets COMPONENT development)
  if(NOT ROOM_HEADERS)
    install(DIRECTORY ./ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nutik/${name} COMPONENT development
            FILES_MATCHING PATTERN "*.hpp")
  endif()
  foreach(header IN LISTS ROOM_HEADERS)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nutik/${name}/${folder} COMPONENT development)
  endforeach()
endfunction()

# nutik_module(<name> SOURCES … ENTRY … LINKS …)
#
# The library nutik-<name>.so, which is loaded when it is first needed (host/media/module.hpp). ENTRY is the source that
# says what it gives, and of which version it is.
function(nutik_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;ENTRY;LINKS" ${ARGN})
  add_library(nutik_${name} MODULE ${MODULE_SOURCES})
  # Alone, as no other file need be compiled again for another version.
  set_source_files_properties(${MODULE_ENTRY} PROPERTIES COMPILE_DEFINITIONS NUTIK_VERSION="${PROJECT_VERSION}")
  set_target_properties(nutik_${name} PROPERTIES PREFIX "" OUTPUT_NAME nutik-${name} SUFFIX .so NO_SONAME ON
                                                 CXX_VISIBILITY_PRESET hidden)
  target_link_libraries(nutik_${name} PRIVATE ${MODULE_LINKS} nutik_warnings)
  # One whose libraries lack something is refused when it is loaded.
  target_link_options(nutik_${name} PRIVATE LINKER:-z,now)
  install(TARGETS nutik_${name} DESTINATION ${CMAKE_INSTALL_LIBDIR}/nutik COMPONENT modules)
endfunction()
