set(triple i686-linux-gnu)
set(processor i686)
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
