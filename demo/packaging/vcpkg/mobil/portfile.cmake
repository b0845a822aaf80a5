# Builds the checkout that this port is in: the core and the C interface.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DMOBIL_IMPORT=OFF -DMOBIL_EXPORT=OFF -DMOBIL_RENDER=OFF -DMOBIL_CLUSTER=OFF -DMOBIL_PROGRAM=OFF
    -DMOBIL_TESTS=OFF -DMOBIL_C=ON -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/mobil)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
