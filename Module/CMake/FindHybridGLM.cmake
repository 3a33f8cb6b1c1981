# Finds GLM by its headers, because not every distribution ships its CMake package, and gives it the
# name HybridRayTracing::GLM.
find_path(HybridGLM_INCLUDE_DIR glm/glm.hpp)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HybridGLM
  REQUIRED_VARS HybridGLM_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libglm-dev")
mark_as_advanced(HybridGLM_INCLUDE_DIR)
if (HybridGLM_FOUND AND NOT TARGET HybridRayTracing::GLM)
  add_library(HybridRayTracing::GLM INTERFACE IMPORTED)
  target_include_directories(HybridRayTracing::GLM INTERFACE "${HybridGLM_INCLUDE_DIR}")
  target_compile_definitions(HybridRayTracing::GLM INTERFACE GLM_FORCE_SILENT_WARNINGS)
endif ()
