set(triple arm-linux-gnueabihf)
set(processor armv7l)
# Notes about an old change of the calling convention, which concern nobody who builds everything again.
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
