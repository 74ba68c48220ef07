# An overlay port: vcpkg install lockstone --overlay-ports=tools/packaging/vcpkg/ports
# It builds the checkout that it lies in.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../../.." ABSOLUTE)
vcpkg_check_linkage(ONLY_STATIC_LIBRARY)

vcpkg_check_features(OUT_FEATURE_OPTIONS features
  FEATURES
    net LOCKSTONE_WITH_ENET
    security LOCKSTONE_WITH_SODIUM
    compression LOCKSTONE_WITH_ZSTD
    vectors LOCKSTONE_WITH_HIGHWAY)

vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    ${features}
    -DLOCKSTONE_BUILD_TESTS=OFF
    -DLOCKSTONE_BUILD_TOOLS=OFF
    -DLOCKSTONE_INSTALL=ON)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/lockstone)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
