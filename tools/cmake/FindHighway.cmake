# Finds the headers of Google Highway. The project uses them alone, so that nothing of the library is
# linked. Defines the interface target Highway::header.
find_path(Highway_INCLUDE_DIR NAMES hwy/highway.h)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Highway REQUIRED_VARS Highway_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libhwy-dev, or configure with -DLOCKSTONE_WITH_HIGHWAY=OFF")

if(Highway_FOUND AND NOT TARGET Highway::header)
  add_library(Highway::header INTERFACE IMPORTED)
  target_include_directories(Highway::header INTERFACE ${Highway_INCLUDE_DIR})
endif()
mark_as_advanced(Highway_INCLUDE_DIR)
