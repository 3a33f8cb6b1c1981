# Finds Embree 4 or 3 and gives it one name, HybridRayTracing::Embree, because distributions still
# ship either. The difference in headers and calls is hidden by Rendering/Core/Structures/EmbreeShim.h,
# which tests __has_include.
find_package(embree 4 QUIET)
if (NOT embree_FOUND)
  find_package(embree 3 QUIET)
endif ()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HybridEmbree
  REQUIRED_VARS embree_DIR embree_FOUND VERSION_VAR embree_VERSION
  REASON_FAILURE_MESSAGE "install libembree-dev (Embree 3 or 4)")
if (HybridEmbree_FOUND AND NOT TARGET HybridRayTracing::Embree)
  add_library(HybridRayTracing::Embree INTERFACE IMPORTED)
  set_target_properties(HybridRayTracing::Embree PROPERTIES INTERFACE_LINK_LIBRARIES embree)
endif ()
