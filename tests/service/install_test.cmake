# Installs the client library to a fresh directory, builds the example against it alone, and runs
# the example through a real server. Any step that fails stops with its output.
set(work ${BUILD_DIR}/install_test)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${code}:\n${text}")
  endif()
  set(text "${text}" PARENT_SCOPE)
endfunction()

set(sanitize)
if(SANITIZE)
  set(sanitize -DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE})
endif()
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --component sdk --prefix ${work}/prefix
    --config ${CONFIG})
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/client/sdk/example -B ${work}/example -G Ninja
    -DCMAKE_PREFIX_PATH=${work}/prefix ${sanitize})
run(${CMAKE_COMMAND} --build ${work}/example)

run(${SOURCE_DIR}/tests/service/run_example.sh ${SERVER} ${work}/example/stream_frames)
if(NOT text MATCHES "frame 7: centre")
  message(FATAL_ERROR "the example did not print its frames:\n${text}")
endif()
