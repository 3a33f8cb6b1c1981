# Finds OpenImageIO and gives it one name, HybridRayTracing::OpenImageIO. Debian 12's package names
# include folders of OpenCV that it does not depend on and that CMake would refuse when they are not
# there: only folders that exist are kept.
find_package(OpenImageIO QUIET CONFIG)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HybridOpenImageIO
  REQUIRED_VARS OpenImageIO_FOUND VERSION_VAR OpenImageIO_VERSION
  REASON_FAILURE_MESSAGE "install libopenimageio-dev")
if (HybridOpenImageIO_FOUND AND NOT TARGET HybridRayTracing::OpenImageIO)
  foreach (target IN ITEMS OpenImageIO::OpenImageIO OpenImageIO::OpenImageIO_Util)
    if (TARGET ${target})
      get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
      set(existing)
      foreach (folder IN LISTS folders)
        if (IS_DIRECTORY "${folder}")
          list(APPEND existing "${folder}")
        endif ()
      endforeach ()
      set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${existing}")
    endif ()
  endforeach ()
  add_library(HybridRayTracing::OpenImageIO INTERFACE IMPORTED)
  set_target_properties(HybridRayTracing::OpenImageIO PROPERTIES
    INTERFACE_LINK_LIBRARIES OpenImageIO::OpenImageIO)
endif ()
