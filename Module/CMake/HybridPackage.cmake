# Makes the install tree usable by find_package(HybridRayTracing): vtk_module_build writes and installs
# the targets, the modules' properties and their public headers; here come the configuration that finds
# VTK first, its version file and the licence.
include(CMakePackageConfigHelpers)

set(hrt_package_build_dir "${CMAKE_BINARY_DIR}/package")
configure_file(
  "${CMAKE_CURRENT_LIST_DIR}/HybridRayTracingConfig.cmake.in"
  "${hrt_package_build_dir}/HybridRayTracingConfig.cmake"
  @ONLY)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(
  "${hrt_package_build_dir}/HybridRayTracingConfigVersion.cmake"
  VERSION "${PROJECT_VERSION}"
  COMPATIBILITY SameMinorVersion)

install(FILES
  "${hrt_package_build_dir}/HybridRayTracingConfig.cmake"
  "${hrt_package_build_dir}/HybridRayTracingConfigVersion.cmake"
  DESTINATION "${hrt_cmake_destination}" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE"
  DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/licenses/HybridRayTracing" COMPONENT runtime)
