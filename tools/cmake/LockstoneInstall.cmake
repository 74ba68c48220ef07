# Install rules and the package that find_package(lockstone) finds.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lockstone)

# Each component has targets of its own, so that the core is found without the libraries that net
# and replay need.
set(rooms core net replay view watch)
if(TARGET lockstone_tool)
  list(APPEND rooms tool)
endif()
foreach(room IN LISTS rooms)
  set(folder ${room})
  if(room MATCHES "tool|view|watch")
    set(folder tools/${room})
  endif()
  install(TARGETS lockstone_${room}
    EXPORT lockstone_${room}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT lockstone_${room}
    NAMESPACE lockstone:: FILE lockstone_${room}.cmake DESTINATION ${package_dir}
    COMPONENT development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/include/
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
endforeach()
# A game's continuous integration may build the libraries alone.
if(TARGET lockstone)
  install(TARGETS lockstone RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools OPTIONAL)
endif()

install(FILES ${PROJECT_SOURCE_DIR}/LICENSE
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/lockstone RENAME copyright COMPONENT tools)

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/tools/cmake/lockstoneConfig.cmake.in
  ${PROJECT_BINARY_DIR}/lockstoneConfig.cmake
  INSTALL_DESTINATION ${package_dir}
  NO_SET_AND_CHECK_MACRO)
# Before 1.0 every minor version may break.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lockstoneConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/lockstoneConfig.cmake
  ${PROJECT_BINARY_DIR}/lockstoneConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/tools/cmake/FindENet.cmake
  ${PROJECT_SOURCE_DIR}/tools/cmake/FindSodium.cmake
  ${PROJECT_SOURCE_DIR}/tools/cmake/FindWebSockets.cmake
  ${PROJECT_SOURCE_DIR}/tools/cmake/FindZstd.cmake
  DESTINATION ${package_dir} COMPONENT development)

if(PROJECT_IS_TOP_LEVEL AND TARGET lockstone_c AND TARGET lockstone AND UNIX AND NOT APPLE)
  include(LockstonePackages)
endif()
