# cmake -D build_dir=… -D scratch_dir=… … -P run.cmake: see CMakeLists.txt beside this file.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch_dir})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${build_dir} --config ${config} --prefix ${scratch_dir}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${scratch_dir}/build -G ${generator}
  -D CMAKE_PREFIX_PATH=${scratch_dir}/prefix
  -D CMAKE_BUILD_TYPE=${config}
  -D CMAKE_CXX_COMPILER=${compiler}
  -D CMAKE_CXX_FLAGS=${flags}
  -D wanted_version=${version})
run(${CMAKE_COMMAND} --build ${scratch_dir}/build --config ${config})
run(${CMAKE_CTEST_COMMAND} --test-dir ${scratch_dir}/build --build-config ${config} --output-on-failure)

# The core alone, where nothing else is to be found.
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/core_only -B ${scratch_dir}/core_only -G ${generator}
  -D CMAKE_PREFIX_PATH=${scratch_dir}/prefix
  -D CMAKE_BUILD_TYPE=${config}
  -D CMAKE_CXX_COMPILER=${compiler}
  -D CMAKE_CXX_FLAGS=${flags}
  -D needs_libraries=${needs_libraries}
  -D wanted_version=${version})
run(${CMAKE_COMMAND} --build ${scratch_dir}/core_only --config ${config})

# An installation without the tools says so.
file(GLOB_RECURSE config ${scratch_dir}/prefix/*/lockstoneConfig.cmake)
get_filename_component(package_folder ${config} DIRECTORY)
file(COPY ${package_folder}/ DESTINATION ${scratch_dir}/without_tools)
file(REMOVE ${scratch_dir}/without_tools/lockstone_tool.cmake)
find_package(lockstone QUIET COMPONENTS tool PATHS ${scratch_dir}/without_tools NO_DEFAULT_PATH)
if(lockstone_FOUND OR NOT lockstone_NOT_FOUND_MESSAGE MATCHES "built with LOCKSTONE_BUILD_TOOLS=OFF")
  message(FATAL_ERROR "a component that is missing: ${lockstone_NOT_FOUND_MESSAGE}")
endif()

file(GLOB_RECURSE licences ${scratch_dir}/prefix/share/doc/lockstone/copyright)
if(NOT licences)
  message(FATAL_ERROR "the licence is not installed")
endif()

# The prefix must hold all that its headers need, and must not point back into the sources.
file(GLOB_RECURSE package_files ${scratch_dir}/prefix/*.cmake)
foreach(file IN LISTS package_files)
  file(STRINGS ${file} leaks REGEX "lockstone_options|${build_dir}")
  foreach(leak IN LISTS leaks)
    message(FATAL_ERROR "${file} refers to the build tree: ${leak}")
  endforeach()
endforeach()
