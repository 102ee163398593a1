# Debian packages, one for each component: `cpack -G DEB` in the build folder, which tools/packages does.
#
# The engine is static on purpose (docs/how-to/install.md says why): there is no shared library and no SONAME.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME nutik)
set(CPACK_PACKAGE_VENDOR "${authors}")
set(CPACK_PACKAGE_CONTACT "${authors} <${contact}>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_SOURCE_DIR}/before_packing.cmake)
# What before_packing.cmake is told.
set(CPACK_NUTIK_PACKAGING ${CMAKE_CURRENT_SOURCE_DIR})
set(CPACK_NUTIK_CHANGELOG ${CMAKE_CURRENT_BINARY_DIR}/changelog)
set(CPACK_NUTIK_STRIP ${CMAKE_STRIP})

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SOURCE nutik)
set(same "(= ${PROJECT_VERSION})")

# nutik_package(<component> NAME … SUMMARY … TEXT … [DEPENDS …] [RECOMMENDS …] [SUGGESTS …] [SECTION …] [SCRIPTS …])
set(CPACK_COMPONENTS_ALL "")
macro(nutik_package component)
  cmake_parse_arguments(PACKAGE "ANY_ARCHITECTURE" "NAME;SUMMARY;TEXT;DEPENDS;RECOMMENDS;SUGGESTS;SECTION" "SCRIPTS" ${ARGN})
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${PACKAGE_NAME})
  set(CPACK_DEBIAN_${COMPONENT}_DESCRIPTION "${PACKAGE_SUMMARY}\n${PACKAGE_TEXT}")
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_DEPENDS "${PACKAGE_DEPENDS}")
  foreach(relation RECOMMENDS SUGGESTS SECTION)
    if(PACKAGE_${relation})
      set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_${relation} "${PACKAGE_${relation}}")
    endif()
  endforeach()
  if(PACKAGE_ANY_ARCHITECTURE)
    set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_ARCHITECTURE all)
  endif()
  if(PACKAGE_SCRIPTS)
    list(TRANSFORM PACKAGE_SCRIPTS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${PACKAGE_NAME}/)
    set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_CONTROL_EXTRA ${PACKAGE_SCRIPTS})
  endif()
endmacro()

nutik_package(program NAME nutik-cl
  SUMMARY "pictures whose exposure is decided after filming"
  TEXT "nutik-cl turns a video or a sequence of stills into a record of when and how\neach pixel changed, and exposes pictures from it: each pixel is the integral\nof its light times a gain function of time, and every region of a mask has a\nfunction of its own. It computes in OpenCL."
  DEPENDS "nutik-modules ${same}, pocl-opencl-icd | opencl-icd"
  SUGGESTS "nutik-studio, nutik-plotters")
nutik_package(modules NAME nutik-modules SECTION libs
  SUMMARY "what nutik programs read and write clips with"
  TEXT "Modules that nutik-cl, nutik-studio and programs linked to libnutik-dev load\nwhen they first read a video or a still, or find a camera's motion. Modules\nand programs are of one version.")
if(TARGET nutik-studio)
  nutik_package(studio NAME nutik-studio
    SUMMARY "window to draw gain functions and masks in"
    TEXT "Regions are painted on a picture of a clip, each gets a gain function of\ntime, and the picture follows while they are drawn. Projects, function files\nand masks are those that nutik-cl reads."
    DEPENDS "nutik-modules ${same}, pocl-opencl-icd | opencl-icd"
    RECOMMENDS "nutik-cl, qt6-translations-l10n")
endif()
nutik_package(plotters NAME nutik-plotters ANY_ARCHITECTURE SCRIPTS postinst prerm
  SUMMARY "plots of nutik's gain functions and noise files"
  TEXT "FnPlotter.py draws the functions of a function file, NoisePlotter.py what\nnutik-cl measured of a camera's noise."
  DEPENDS "nutik-cl (>= ${PROJECT_VERSION}), python3:any, python3-matplotlib")
if(TARGET nutik_python)
  math(EXPR next_python "${Python_VERSION_MINOR} + 1")
  set(python "${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}")
  nutik_package(python NAME python3-nutik SECTION python SCRIPTS postinst prerm
    SUMMARY "pictures whose exposure is decided after filming, from Python"
    TEXT "The package nutik makes captures from clips and NumPy arrays, and exposes\npictures as arrays."
    DEPENDS "python3 (>= ${python}), python3 (<< ${Python_VERSION_MAJOR}.${next_python}), python3-numpy, pocl-opencl-icd | opencl-icd")
endif()
# What was compiled by one GCC is linked by it or a newer one.
string(REGEX MATCH "^[0-9]+" gcc "${CMAKE_CXX_COMPILER_VERSION}")
if(NOT NUTIK_HAS_STD_FORMAT)
  set(fmt "libfmt-dev, ")
endif()
nutik_package(development NAME libnutik-dev SECTION libdevel
  SUMMARY "static libraries and headers of nutik"
  TEXT "For programs in C++20 that make and expose captures: find_package(nutik) of\nCMake, target nutik::features. The libraries are static, and such a program\nneeds nutik-modules of the same version."
  DEPENDS "nutik-modules ${same}, g++ (>= 4:${gcc}), libdeflate-dev, libjpeg-dev, liblcms2-dev, liblz4-dev, libpng-dev, libtiff-dev, libxxhash-dev, libzstd-dev, libcairo2-dev, ${fmt}ocl-icd-opencl-dev, opencl-clhpp-headers, pkg-config"
  RECOMMENDS "cmake (>= 3.25)")

include(CPack)
