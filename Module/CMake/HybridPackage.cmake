# Makes the build and the install tree usable by find_package(HybridRayTracing): vtk_module_build has
# written the targets and the modules' properties; here come the configuration that finds their
# dependencies first, its version file, the core's headers and the licence.
include(CMakePackageConfigHelpers)

set(hrt_package_build_dir "${CMAKE_BINARY_DIR}/${hrt_cmake_destination}")
set(hrt_package_files
  "${CMAKE_CURRENT_LIST_DIR}/FindHybridEmbree.cmake"
  "${CMAKE_CURRENT_LIST_DIR}/FindHybridGLM.cmake")

configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/HybridRayTracingConfig.cmake.in"
  "${hrt_package_build_dir}/HybridRayTracingConfig.cmake"
  INSTALL_DESTINATION "${hrt_cmake_destination}")
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(
  "${hrt_package_build_dir}/HybridRayTracingConfigVersion.cmake"
  VERSION "${PROJECT_VERSION}"
  COMPATIBILITY SameMinorVersion)
# The configuration looks for the finders beside itself, in the build tree too.
file(COPY ${hrt_package_files} DESTINATION "${hrt_package_build_dir}")

install(FILES
  "${hrt_package_build_dir}/HybridRayTracingConfig.cmake"
  "${hrt_package_build_dir}/HybridRayTracingConfigVersion.cmake"
  ${hrt_package_files}
  DESTINATION "${hrt_cmake_destination}" COMPONENT development)

# Under their path in the source tree, because that is how they include each other.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/Rendering/Core"
  DESTINATION "${hrt_headers_destination}/Rendering" COMPONENT development
  FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE"
  DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/licenses/HybridRayTracing" COMPONENT runtime)
