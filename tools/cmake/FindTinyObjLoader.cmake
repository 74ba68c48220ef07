# Finds the header of tinyobjloader. The project compiles it itself, so that nothing of the library is
# linked. Defines the interface target TinyObjLoader::header.
find_path(TinyObjLoader_INCLUDE_DIR NAMES tiny_obj_loader.h)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TinyObjLoader REQUIRED_VARS TinyObjLoader_INCLUDE_DIR
  REASON_FAILURE_MESSAGE
  "install libtinyobjloader-dev, or configure with -DLOCKSTONE_WITH_ASSET_IMPORT=OFF")

if(TinyObjLoader_FOUND AND NOT TARGET TinyObjLoader::header)
  add_library(TinyObjLoader::header INTERFACE IMPORTED)
  target_include_directories(TinyObjLoader::header SYSTEM INTERFACE ${TinyObjLoader_INCLUDE_DIR})
endif()
mark_as_advanced(TinyObjLoader_INCLUDE_DIR)
