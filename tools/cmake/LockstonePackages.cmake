# Debian packages by CPack: `tools/package.sh` builds and checks them.
#
#   liblockstone-c0   the C library, for programs that were built with it
#   liblockstone-dev  headers, static libraries, package configurations
#   lockstone         the command, a unit of systemd
set(packaging ${PROJECT_SOURCE_DIR}/tools/packaging)

# lockstone_compress(FILE to): gzip without name and time, so that two builds give the same bytes.
function(lockstone_compress file to)
  execute_process(COMMAND gzip -9nc ${file} OUTPUT_FILE ${to} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(text ${PROJECT_BINARY_DIR}/packaging)
file(MAKE_DIRECTORY ${text})
lockstone_compress(${packaging}/changelog ${text}/changelog.gz)
lockstone_compress(${packaging}/lockstone.1 ${text}/lockstone.1.gz)

set(package_runtime liblockstone-c0)
set(package_development liblockstone-dev)
set(package_tools lockstone)
foreach(component IN ITEMS runtime development tools)
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${package_${component}})
  install(FILES ${text}/changelog.gz DESTINATION ${doc} COMPONENT ${component})
  if(NOT component STREQUAL "tools")
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSE
      DESTINATION ${doc} RENAME copyright COMPONENT ${component})
  endif()
endforeach()
install(FILES ${packaging}/systemd/lockstone@.service
  DESTINATION lib/systemd/system COMPONENT tools)
install(FILES ${text}/lockstone.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lockstone)
set(CPACK_PACKAGE_VENDOR "The Lockstone authors")
set(CPACK_PACKAGE_CONTACT "The Lockstone authors <lockstone@users.noreply.github.com>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "deterministic lockstep physics")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL runtime c development tools)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

# lockstone_describe(GROUP package section text): the summary is the same for all.
set(about "Bodies, joints and contacts in fixed-point numbers: the same inputs give the
same state, bit for bit, on every machine and compiler. With sessions in
lockstep or with rollback, recorded matches and their verification.")
function(lockstone_describe group name section more)
  string(TOUPPER ${group} GROUP)
  set(CPACK_DEBIAN_${GROUP}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${GROUP}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${GROUP}_DESCRIPTION "${about}\n\n${more}" PARENT_SCOPE)
endfunction()
lockstone_describe(runtime liblockstone-c0 libs
  "This package has the shared library of the C interface.")
lockstone_describe(dev liblockstone-dev libdevel
  "This package has the headers of the C and the C++ interface, static libraries,\nand the files by which CMake and pkg-config find them.")
lockstone_describe(tools lockstone utils
  "This package has the command: it hosts and joins matches, verifies, bisects\nand compares their logs, also for games of one's own.")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "liblockstone-c0 (= ${PROJECT_VERSION}), libenet-dev, libsodium-dev, libwebsockets-dev, libzstd-dev")
# The linker's cache learns of the library, and packages that use it of its name.
file(WRITE ${text}/triggers "activate-noawait ldconfig\n")
file(WRITE ${text}/shlibs "liblockstone_c 0 liblockstone-c0 (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${text}/triggers ${text}/shlibs)

include(CPack)
cpack_add_component_group(runtime)
cpack_add_component_group(dev)
cpack_add_component_group(tools)
cpack_add_component(runtime GROUP runtime)
cpack_add_component(c GROUP dev)
cpack_add_component(development GROUP dev)
cpack_add_component(tools GROUP tools)
