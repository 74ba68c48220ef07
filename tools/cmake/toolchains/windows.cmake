# MinGW; the program runs under Wine as well.
set(triple x86_64-w64-mingw32)
set(processor x86_64)
set(system Windows)
set(compiler ${triple}-g++-posix)
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
