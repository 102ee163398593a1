# What Debian wants of every package, done to the trees that CPack is about to pack: copyright and changelog, compressed
# manual pages, libraries without debug information, rights of the files.

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} COMPONENT)
  set(tree ${CPACK_TEMPORARY_DIRECTORY}/${component}${CPACK_PACKAGING_INSTALL_PREFIX})
  set(documents ${tree}/share/doc/${CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME})
  file(MAKE_DIRECTORY ${documents})
  file(COPY ${CPACK_NUTIK_PACKAGING}/copyright ${CPACK_NUTIK_CHANGELOG} DESTINATION ${documents}
       FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  set(overrides ${CPACK_NUTIK_PACKAGING}/${CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME}/lintian-overrides)
  if(EXISTS ${overrides})
    configure_file(${overrides} ${tree}/share/lintian/overrides/${CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME} COPYONLY
                   FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  endif()
  file(GLOB pages ${tree}/share/man/man1/*.1)
  execute_process(COMMAND gzip -9n ${documents}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE libraries ${tree}/lib/*.a)
  if(libraries)
    execute_process(COMMAND ${CPACK_NUTIK_STRIP} --strip-debug --enable-deterministic-archives ${libraries}
                    COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()
