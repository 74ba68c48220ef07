# WebAssembly for browsers and Node without Emscripten's JavaScript (tools/web), with vectors.
# LLVM 14 moves loads past the calls that overwrite them where it makes vectors of scalars by itself:
# docs/notes/webassembly.md.
set(wasm_compile_flags "-fwasm-exceptions -msimd128 -fno-slp-vectorize")
set(wasm_link_flags "-fwasm-exceptions")
include(${CMAKE_CURRENT_LIST_DIR}/wasm.cmake)
