#!/usr/bin/env bash
# Against the VTK of PyVista's wheels (cvista, and its development kit cvista-sdk): a newer VTK, OpenGL
# by glad and EGL instead of glew and an X server. CMake comes from the package index too, since the
# kit's files want a newer one. The module is built with its wrappers; the C++ tests and the package's
# are run. The Python tests and examples speak of VTK by the name that it has elsewhere.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install "${cpp_packages[@]}" libopenimageio-dev openimageio-tools python3-dev python3-venv \
  libegl1 libgl1-mesa-dri
[[ -x /venv/bin/python ]] || python3 -m venv /venv
/venv/bin/pip install --quiet 'cmake>=4' cvista-sdk cvista-rendering cvista-io
sdk=$(/venv/bin/python -c 'import cvista_sdk.cmake as sdk; print(sdk.__path__[0])')
build /venv/bin/cmake -DVTK_DIR="$sdk" -DPython3_EXECUTABLE=/venv/bin/python
run_tests /venv/bin/ctest -E '^(python|image)'
