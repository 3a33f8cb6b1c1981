#!/usr/bin/env bash
# Against the VTK that ParaView brings, which was built with its assertions: the C++ tests and the
# package's. ParaView's CMake files refuse to load without its Python package, which no VTK for Python
# may stand beside; MPI and glew are in its VTK's link lines.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install "${cpp_packages[@]}" cmake paraview-dev python3-paraview mpi-default-dev libglew-dev \
  xvfb xauth libgl1-mesa-dri
vtk=(/usr/lib/*/cmake/paraview-*/vtk)
build cmake -DVTK_DIR="${vtk[0]}" -DHRT_WRAP_PYTHON=OFF
# -noreset: by default the server starts anew whenever its last client leaves, and refuses the next.
run_tests xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" ctest
