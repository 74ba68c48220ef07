# Finds the xxHash header. The project uses it header-only (XXH_INLINE_ALL), so that cross builds
# need no library for the target. Defines the interface target XxHash::header.
find_path(XxHash_INCLUDE_DIR NAMES xxhash.h)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(XxHash REQUIRED_VARS XxHash_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libxxhash-dev")

if(XxHash_FOUND AND NOT TARGET XxHash::header)
  add_library(XxHash::header INTERFACE IMPORTED)
  target_include_directories(XxHash::header INTERFACE ${XxHash_INCLUDE_DIR})
endif()
mark_as_advanced(XxHash_INCLUDE_DIR)
