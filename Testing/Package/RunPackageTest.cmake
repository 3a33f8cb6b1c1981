# Installs the build tree, moves the result elsewhere (an installed package must not know where it was
# made), then builds and runs a small outside project against it and imports the Python package from
# it. Run by ctest with `cmake -P`; stops at the first step that fails.
cmake_minimum_required(VERSION 3.20)

function (step name)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if (NOT result EQUAL 0)
    message("${output}")
    message(FATAL_ERROR "package test: '${name}' failed (${result})")
  endif ()
  message(STATUS "${name}: ok")
endfunction ()

# A library path from the caller's shell could hide a missing run path.
unset(ENV{LD_LIBRARY_PATH})
unset(ENV{PYTHONPATH})

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
step("install" "${CMAKE_COMMAND}" --install "${BUILD_TREE}" --config "${BUILD_TYPE}"
  --prefix "${WORK}/made")
file(RENAME "${WORK}/made" "${WORK}/prefix")

# A header that is installed is a promise: these are all that a program needs. The others name types of
# libraries that a consumer has no headers of.
set(expected_headers
  vtkHybridBARTImporter.h vtkHybridIOBARTModule.h vtkHybridMaterial.h vtkHybridRayTracingPass.h
  vtkHybridRenderingOpenGL2Module.h vtkHybridRenderingSceneModule.h vtkHybridVersion.h)
list(TRANSFORM expected_headers PREPEND "HybridRayTracing/")
file(GLOB_RECURSE headers RELATIVE "${WORK}/prefix/include" "${WORK}/prefix/include/*")
if (NOT headers STREQUAL expected_headers)
  message(FATAL_ERROR "package test: the installed headers are\n  ${headers}\nand should be\n  "
    "${expected_headers}")
endif ()

step("configure the outside project" "${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${WORK}/build"
  -G "${GENERATOR}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_PREFIX_PATH=${WORK}/prefix"
  "-DVTK_DIR=${VTK_DIR}" "-DHRT_EXPECTED_VERSION=${VERSION}")
step("build the outside project" "${CMAKE_COMMAND}" --build "${WORK}/build" --config "${BUILD_TYPE}")
step("run the outside project" "${CMAKE_CTEST_COMMAND}" --test-dir "${WORK}/build"
  -C "${BUILD_TYPE}" --output-on-failure --no-tests=error)

if (PYTHON_DESTINATION)
  step("import the Python package" "${CMAKE_COMMAND}" -E env
    "PYTHONPATH=${WORK}/prefix/${PYTHON_DESTINATION}" PYTHONDONTWRITEBYTECODE=1
    "${PYTHON}" -c "import vtkhybrid; assert vtkhybrid.__version__ == '${VERSION}'; \
assert vtkhybrid.__file__.startswith('${WORK}/prefix'); vtkhybrid.vtkHybridRayTracingPass()")
endif ()
