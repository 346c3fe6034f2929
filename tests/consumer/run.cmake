# Installs the build tree BUILD below WORK, moves the installation elsewhere, builds the consumer project against it
# and runs its programs: cmake -D BUILD=... -D WORK=... -D TYPE=... -D FLAGS=... -P run.cmake
# With -D PYTHON=... -D PACKAGE=... (the package's folder below the prefix) Python runs its examples, too.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(status)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${status}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed)
# What still points to where it was installed breaks now.
file(RENAME ${WORK}/installed ${WORK}/moved)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G Ninja
    -D CMAKE_BUILD_TYPE=${TYPE} -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_PREFIX_PATH=${WORK}/moved)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/circle_area)
run(${WORK}/build/case_results ${CMAKE_CURRENT_LIST_DIR}/disc.toml WORKING_DIRECTORY ${WORK})
foreach(result IN ITEMS boundary.vtu results.h5 results.json)
  if(NOT EXISTS ${WORK}/${result})
    message(FATAL_ERROR "case_results has not written ${result}")
  endif()
endforeach()
run(${WORK}/moved/bin/isorim --version)

if(PYTHON)
  file(GLOB examples ${CMAKE_CURRENT_LIST_DIR}/../../io/python/examples/*.py)
  foreach(example IN LISTS examples)
    run(${CMAKE_COMMAND} -E env PYTHONPATH=${WORK}/moved/${PACKAGE} ${PYTHON} ${example} WORKING_DIRECTORY ${WORK})
  endforeach()
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${WORK}/moved/${PACKAGE} ${PYTHON} -c
      "import isorim; assert isorim.__file__.startswith('${WORK}/moved/${PACKAGE}'), isorim.__file__")
endif()
