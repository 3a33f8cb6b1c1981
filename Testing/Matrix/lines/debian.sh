#!/usr/bin/env bash
# A bare Debian: the one script installs what it needs, builds and runs every test, as it would for a
# newcomer. A package that its list has forgotten is missing here.
set -euo pipefail
cd /project
exec ./run test --output-junit /result/tests.xml
