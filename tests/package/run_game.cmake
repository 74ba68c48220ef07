# cmake -D prefix=… -D source_dir=… -D scratch_dir=… … -P run_game.cmake: builds the example game and the
# libraries that must be refused against the installed package, and plays with them.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(build source folder)
  run(${CMAKE_COMMAND} -S ${source} -B ${folder} -G ${generator}
    -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_BUILD_TYPE=${config}
    -D CMAKE_CXX_COMPILER=${compiler}
    -D CMAKE_CXX_FLAGS=${flags})
  run(${CMAKE_COMMAND} --build ${folder} --config ${config})
endfunction()

build(${source_dir}/tools/examples/rolling ${scratch_dir}/rolling)
build(${CMAKE_CURRENT_LIST_DIR}/game ${scratch_dir}/bad_games)
set(library_in_c none)
set(tool_in_c none)
if(with_c)
  build(${source_dir}/tools/examples/pushers ${scratch_dir}/pushers)
  set(library_in_c ${scratch_dir}/pushers/libpushers_game.so)
  set(tool_in_c ${scratch_dir}/pushers/pushers)
endif()
run(${python} -B ${CMAKE_CURRENT_LIST_DIR}/game_test.py
  ${scratch_dir}/rolling/rolling ${prefix}/bin/lockstone
  ${scratch_dir}/rolling/librolling_game.so ${scratch_dir}/bad_games ${network} ${library_in_c} ${tool_in_c})
