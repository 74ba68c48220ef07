# As web.cmake, for processors and browsers without vectors.
set(wasm_compile_flags "-fwasm-exceptions")
set(wasm_link_flags "-fwasm-exceptions")
include(${CMAKE_CURRENT_LIST_DIR}/wasm.cmake)
