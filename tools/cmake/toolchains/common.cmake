# The common part of the cross toolchains; each sets `triple` and `processor`, where they are not
# the usual ones `system` and `compiler`, and includes this file.
if(NOT DEFINED system)
  set(system Linux)
endif()
if(NOT DEFINED compiler)
  set(compiler ${triple}-g++)
endif()
set(CMAKE_SYSTEM_NAME ${system})
set(CMAKE_SYSTEM_PROCESSOR ${processor})
set(CMAKE_CXX_COMPILER ${compiler})
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)

# The command uses some libraries by their headers alone, which are the same for every processor.
# The host's copies are shown to the cross compiler through links in the build folder: /usr/include
# itself would give it the host's C library. (The compiler's own checks read this file too, from
# scratch folders that need no links.)
set(host_headers ${CMAKE_BINARY_DIR}/host-headers)
get_property(in_try_compile GLOBAL PROPERTY IN_TRY_COMPILE)
if(NOT in_try_compile)
  file(MAKE_DIRECTORY ${host_headers}/include)
  foreach(name IN ITEMS xxhash.h hwy fmt CLI nlohmann sodium.h sodium)
    if(EXISTS /usr/include/${name})
      file(CREATE_LINK /usr/include/${name} ${host_headers}/include/${name} SYMBOLIC)
    endif()
  endforeach()
endif()

set(CMAKE_FIND_ROOT_PATH /usr/${triple} ${host_headers})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
