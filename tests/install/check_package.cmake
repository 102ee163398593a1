# Installs the build into an empty folder and has another project find it, build with it and run.
#
#   cmake -D BUILD=… -D CONSUMER=… -D PAGE=… -D WORK=… -D GENERATOR=… -D COMPILER=… -D FLAGS=… -D LAUNCHER=…
#         -P check_package.cmake

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${result}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed)
foreach(file share/bash-completion/completions/nutik-cl share/zsh/site-functions/_nutik-cl
             share/fish/vendor_completions.d/nutik-cl.fish share/man/man1/nutik-cl.1 share/doc/nutik-cl/LICENSE)
  file(READ ${WORK}/installed/${file} text)
  if(NOT text MATCHES "nutik-cl")
    message(FATAL_ERROR "${file} was installed without its text:\n${text}")
  endif()
endforeach()
# Plotters find their parts; drawing needs Matplotlib, which their own tests look for.
foreach(plotter FnPlotter.py NoisePlotter.py)
  run(${CMAKE_COMMAND} -E chdir ${WORK} ${WORK}/installed/bin/${plotter} --help)
endforeach()
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G ${GENERATOR}
    -DPAGE=${PAGE} -DCMAKE_PREFIX_PATH=${WORK}/installed -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(${CMAKE_COMMAND} --build ${WORK}/build --target consumer headers)
run(${WORK}/build/consumer)
# The page's example, by pkg-config, which knows what the build folder holds only where it is installed.
file(GLOB_RECURSE description ${WORK}/installed/nutik.pc)
cmake_path(GET description PARENT_PATH descriptions)
run(sh -c "'${COMPILER}' '${WORK}/build/example.cpp' -o '${WORK}/example' \
$(PKG_CONFIG_PATH='${descriptions}' pkg-config --cflags --libs nutik)")

# A second of nothing, for the page's example.
string(REPEAT "x" 61440 samples)
file(WRITE ${WORK}/clip.raw "${samples}")
run(${WORK}/installed/bin/nutik-cl -q --raw 8x8:gray -f 960 ${WORK}/clip.raw ${WORK}/clip.tik)
run(${CMAKE_COMMAND} -E chdir ${WORK} ${WORK}/example)
file(SIZE ${WORK}/picture.png bytes)  # an error where the example made none
