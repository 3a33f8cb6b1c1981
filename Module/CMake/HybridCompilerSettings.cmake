# Compiler, run path and sanitizer settings that hold for every target of the project, in one place
# so that the core, the modules, the wrappers and the tests cannot drift apart.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
if (NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif ()

# Libraries find each other relative to themselves, so that the build tree and an install tree can be
# moved and need no LD_LIBRARY_PATH. The link path is kept for a VTK outside the system's folders.
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
if (APPLE)
  set(CMAKE_INSTALL_RPATH "@loader_path")
else ()
  set(CMAKE_INSTALL_RPATH "$ORIGIN")
endif ()

# The wrappers make long compilations of unchanged code; ccache, where present, makes a second clean
# build short. A launcher chosen by the user is left alone.
find_program(HRT_CCACHE ccache)
mark_as_advanced(HRT_CCACHE)
if (HRT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER "${HRT_CCACHE}")
  set(CMAKE_CXX_COMPILER_LAUNCHER "${HRT_CCACHE}")
endif ()

set(HRT_SANITIZE "" CACHE STRING "Sanitizers for all targets, e.g. address,undefined or thread")
if (HRT_SANITIZE)
  # A report must fail the test that caused it, hence no recovery.
  add_compile_options(-fsanitize=${HRT_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer -g)
  add_link_options(-fsanitize=${HRT_SANITIZE})
endif ()

option(HRT_FUZZ "Build the fuzzing targets (needs clang); see Documentation/fuzzing.md" OFF)
if (HRT_FUZZ)
  # The libraries tell the fuzzer which branches an input took.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif ()

# Adds the project's warnings to one of its targets (a module may be given by either of its names).
# Generated wrapper code is not ours and is left out.
function (hrt_target_warnings target)
  get_target_property(real "${target}" ALIASED_TARGET)
  if (NOT real)
    set(real "${target}")
  endif ()
  if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options("${real}" PRIVATE -Wall -Wextra)
  endif ()
endfunction ()
