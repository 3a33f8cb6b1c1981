#!/usr/bin/env bash
# Against the VTK of PyVista's wheels (cvista and its development kit cvista-sdk): OpenGL by glad and
# EGL, no X server. CMake comes from the same place, since the kit's files want a newer one.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install "${cpp_packages[@]}" python3-dev python3-venv libegl1 libgl1-mesa-dri
[[ -x /venv/bin/python ]] || python3 -m venv /venv
/venv/bin/pip install --quiet 'cmake>=4' cvista-sdk cvista-rendering cvista-io
sdk=$(/venv/bin/python -c 'import cvista_sdk.cmake as sdk; print(sdk.__path__[0])')
build /venv/bin/cmake -DVTK_DIR="$sdk" -DPython3_EXECUTABLE=/venv/bin/python
say "testing"
/venv/bin/ctest --test-dir /build --output-on-failure --no-tests=error -j "$(nproc)" \
  --output-junit /result/tests.xml
