# The options of every target of the project: language level, warnings, checks.

add_library(lockstone_options INTERFACE)
target_compile_features(lockstone_options INTERFACE cxx_std_20)
target_compile_options(lockstone_options INTERFACE
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion
    -Wsign-conversion -Wcast-align -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual>
  $<$<AND:$<BOOL:${LOCKSTONE_WARNINGS_AS_ERRORS}>,$<CXX_COMPILER_ID:GNU,Clang,AppleClang>>:-Werror>)

# At -Os g++ 12.2 takes results of functions for unused that others read through references: answers to
# impacts came out without their velocities. Its analysis of functions' memory is switched off.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 11)
  target_compile_options(lockstone_options INTERFACE -fno-ipa-modref)
endif()

# lockstone_unite_sources(TARGET): where LOCKSTONE_UNITY_BUILD says so, up to twenty files of one part
# (core/dynamics, net/session, …) are compiled at once: the headers of one unit take a second.
# Elsewhere they are compiled one by one, whatever CMAKE_UNITY_BUILD says.
function(lockstone_unite_sources target)
  set(unite ${LOCKSTONE_UNITY_BUILD})
  if(unite STREQUAL "SESSION")
    set(unite ON)
    if(target STREQUAL "lockstone_core")
      set(unite OFF)
    endif()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${unite} UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  set(folders)
  foreach(source IN LISTS sources)
    string(REGEX MATCH "^[^/]*/" folder ${source})  # none for the files of a library without folders
    string(MAKE_C_IDENTIFIER "in_${folder}" folder)
    list(APPEND folders ${folder})
    list(APPEND ${folder} ${source})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  set(most 20)
  foreach(folder IN LISTS folders)
    list(LENGTH ${folder} length)
    math(EXPR groups "(${length} + ${most} - 1) / ${most}")
    set(index 0)
    foreach(source IN LISTS ${folder})
      math(EXPR group "${index} * ${groups} / ${length}")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
      math(EXPR index "${index} + 1")
    endforeach()
  endforeach()
endfunction()

# lockstone_compile_at(TARGET LEVEL source…): compiles files of core with the option LEVEL, if it is not empty.
# A file that was given a level before keeps it. CMake does not unite files with options of their own, so
# where LOCKSTONE_UNITY_BUILD is SESSION this function does: up to sixteen files with the same level, of
# the room collision or dynamics or of one folder of world. It leaves base, math, the kernels, geometry and
# the commands, of which a program links those that it names.
function(lockstone_compile_at target level)
  set(sources ${ARGN})
  foreach(source IN LISTS sources)
    get_source_file_property(placed ${source} LOCKSTONE_PLACED)
    if(placed)
      list(REMOVE_ITEM sources ${source})
    endif()
  endforeach()
  set_source_files_properties(${sources} PROPERTIES LOCKSTONE_PLACED ON COMPILE_OPTIONS "${level}")
  if(NOT LOCKSTONE_UNITY_BUILD STREQUAL "SESSION")
    return()
  endif()
  set(folders ${sources})
  list(FILTER folders INCLUDE REGEX "^world/")
  list(FILTER folders EXCLUDE REGEX "^world/commands/[^/]*$")
  list(TRANSFORM folders REPLACE "/[^/]*$" "")
  list(REMOVE_DUPLICATES folders)
  foreach(folder IN ITEMS collision dynamics LISTS folders)
    set(rest ${sources})
    if(folder MATCHES "^world")
      list(FILTER rest INCLUDE REGEX "^${folder}/[^/]*$")
    else()
      list(FILTER rest INCLUDE REGEX "^${folder}/")
    endif()
    string(MAKE_C_IDENTIFIER ${folder} name)
    set(batch 0)
    while(rest)
      list(SUBLIST rest 0 16 united)
      list(REMOVE_ITEM rest ${united})
      set(includes)
      foreach(source IN LISTS united)
        string(APPEND includes "#include \"${CMAKE_CURRENT_SOURCE_DIR}/${source}\"\n")
      endforeach()
      set(unit ${CMAKE_CURRENT_BINARY_DIR}/united/${name}${level}_${batch}.cpp)
      file(CONFIGURE OUTPUT ${unit} CONTENT "${includes}" @ONLY)
      target_sources(${target} PRIVATE ${unit})
      set_source_files_properties(${unit} PROPERTIES COMPILE_OPTIONS "${level}")
      set_source_files_properties(${united} PROPERTIES HEADER_FILE_ONLY ON)
      math(EXPR batch "${batch} + 1")
    endwhile()
  endforeach()
endfunction()

# lockstone_add_library(NAME room sources…): one of the three libraries. NAME `core` gives the target
# lockstone_core, known as lockstone::core here and to those who find_package(lockstone).
function(lockstone_add_library name)
  set(target lockstone_${name})
  add_library(${target} STATIC ${ARGN})
  add_library(lockstone::${name} ALIAS ${target})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:lockstone_options>)
  # Consumers compile the same checks in headers as the library does in its sources.
  if(LOCKSTONE_ASSERTS)
    target_compile_definitions(${target} PUBLIC LKS_ENABLE_ASSERTS)
  else()
    target_compile_definitions(${target} PUBLIC $<$<CONFIG:Debug>:LKS_ENABLE_ASSERTS>)
  endif()
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name}
    POSITION_INDEPENDENT_CODE ON
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON)
  # Addresses in WebAssembly are known when it is linked.
  if(CMAKE_SYSTEM_NAME STREQUAL "Emscripten")
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  endif()
  lockstone_unite_sources(${target})
endfunction()

# lockstone_link_core_first(PROGRAM): of the copies of a function in a header the linker takes the first.
# In a program whose own files are compiled with -O0, as tests with sanitizers are, that shall be the one
# of core, which is optimised and checked: else such programs take half as long again.
function(lockstone_link_core_first program)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug" AND UNIX AND NOT APPLE)
    target_link_options(${program} PRIVATE
      LINKER:--whole-archive,$<TARGET_FILE:lockstone_core>,--no-whole-archive)
  endif()
endfunction()
