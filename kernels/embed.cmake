# Writes the kernels into a C++ source, so that the program needs no files beside it.
#
#   cmake -D KERNELS=a.cl;b.cl -D OUTPUT=kernel_sources.cpp -P embed.cmake
#
# #include "x.clh" is replaced by that file, once per kernel file; #line keeps every compiler message
# pointing at the file that a person edits.

set(counter 0)

function(inline_file path result included)
  list(FIND ${included} "${path}" seen)
  if(NOT seen EQUAL -1)
    set(${result} "" PARENT_SCOPE)
    return()
  endif()
  list(APPEND ${included} "${path}")
  get_filename_component(folder "${path}" DIRECTORY)
  get_filename_component(name "${path}" NAME)
  file(READ "${path}" text)
  set(out "#line 1 \"${name}\"\n")
  set(line 1)
  while(text MATCHES "#include \"([^\"]+)\"\n")
    set(match "${CMAKE_MATCH_0}")
    set(file "${CMAKE_MATCH_1}")
    string(FIND "${text}" "${match}" at)
    string(SUBSTRING "${text}" 0 ${at} before)
    string(LENGTH "${match}" length)
    math(EXPR after "${at} + ${length}")
    string(SUBSTRING "${text}" ${after} -1 text)
    string(REGEX MATCHALL "\n" newlines "${before}")
    list(LENGTH newlines count)
    math(EXPR line "${line} + ${count} + 1")
    inline_file("${folder}/${file}" inner ${included})
    string(APPEND out "${before}${inner}#line ${line} \"${name}\"\n")
  endwhile()
  string(APPEND out "${text}")
  set(${result} "${out}" PARENT_SCOPE)
  set(${included} "${${included}}" PARENT_SCOPE)
endfunction()

set(source "// Made by kernels/embed.cmake.\n#include \"opencl/kernel_sources.hpp\"\n\nnamespace nutik {\n\n")
foreach(kernel IN LISTS KERNELS)
  get_filename_component(name "${kernel}" NAME_WE)
  set(included "")
  inline_file("${kernel}" text included)
  string(APPEND source "const char* const k_${name}_source = R\"NUTIK(${text})NUTIK\";\n\n")
endforeach()
string(APPEND source "}  // namespace nutik\n")
file(WRITE "${OUTPUT}" "${source}")
