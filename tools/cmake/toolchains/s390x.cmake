set(triple s390x-linux-gnu)
set(processor s390x)
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
