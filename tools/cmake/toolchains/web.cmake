# WebAssembly for browsers and Node without Emscripten's JavaScript (tools/web), with vectors.
set(wasm_compile_flags "-fwasm-exceptions -msimd128")
set(wasm_link_flags "-fwasm-exceptions")
include(${CMAKE_CURRENT_LIST_DIR}/wasm.cmake)
