# Finds libwebsockets, whose package config drags in more than it needs. Defines the target
# WebSockets::websockets.
find_path(WebSockets_INCLUDE_DIR NAMES libwebsockets.h)
find_library(WebSockets_LIBRARY NAMES websockets)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(WebSockets REQUIRED_VARS WebSockets_LIBRARY WebSockets_INCLUDE_DIR
  REASON_FAILURE_MESSAGE
  "install libwebsockets-dev, or configure with -DLOCKSTONE_WITH_WEBSOCKETS=OFF")

if(WebSockets_FOUND AND NOT TARGET WebSockets::websockets)
  add_library(WebSockets::websockets UNKNOWN IMPORTED)
  set_target_properties(WebSockets::websockets PROPERTIES
    IMPORTED_LOCATION ${WebSockets_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${WebSockets_INCLUDE_DIR})
endif()
mark_as_advanced(WebSockets_INCLUDE_DIR WebSockets_LIBRARY)
