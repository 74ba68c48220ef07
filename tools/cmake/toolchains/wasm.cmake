# WebAssembly by Emscripten, to be run by Node. web.cmake sets other flags and includes this file.
set(triple wasm32-unknown-emscripten)
set(processor wasm32)
set(system Emscripten)
set(compiler em++)
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(CMAKE_C_COMPILER emcc)
set(CMAKE_AR emar)
set(CMAKE_RANLIB emranlib)
if(NOT DEFINED wasm_compile_flags)
  set(wasm_compile_flags "-fexceptions -msimd128 -fno-slp-vectorize")  # see web.cmake
  set(wasm_link_flags "-fexceptions -sNODERAWFS=1 -sEXIT_RUNTIME=1")
  # Loaded in one piece: the loader for pieces takes Node's fetch() for a browser's.
  string(APPEND wasm_link_flags " -sENVIRONMENT=node -sWASM_ASYNC_COMPILATION=0")
endif()
set(CMAKE_CXX_FLAGS_INIT
  "${wasm_compile_flags} -include ${CMAKE_CURRENT_LIST_DIR}/wasm_algorithms.h")
set(CMAKE_EXE_LINKER_FLAGS_INIT "${wasm_link_flags} -sALLOW_MEMORY_GROWTH=1 -sTOTAL_STACK=4MB")
# CMake does not know the system: where below the roots to look, a Unix says by itself.
set(CMAKE_SYSTEM_PREFIX_PATH /)
