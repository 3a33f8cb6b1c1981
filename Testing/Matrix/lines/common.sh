# What the lines of the matrix share. Sourced by the scripts beside it, which run inside a root, as
# root, with the project in /project and a folder for their results in /result.

# Every line builds and tests the whole C++ side; what it takes VTK from is its own business.
cpp_packages=(
  g++ ninja-build ccache libembree-dev libtbb-dev libglm-dev libgtest-dev libbenchmark-dev
)

say() { printf '== %s\n' "$*"; }

# Installs what is missing of the packages $@. In a root made for one purpose nothing may have to go.
install() {
  local missing
  mapfile -t missing < <(
    { dpkg-query -W -f='${db:Status-Abbrev}${Package}\n' "$@" 2>/dev/null || true; } |
      sed -n 's/^ii *//p' | sort -u | comm -13 - <(printf '%s\n' "$@" | sort -u)
  )
  ((${#missing[@]})) || return 0
  say "installing ${missing[*]}"
  apt-get update -q
  DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends --no-remove \
    "${missing[@]}" </dev/null
}

# Configures /project into /build with the CMake $1 and the options after it, and builds. Developers'
# warnings are left out: they are about VTK's own CMake files.
build() {
  local cmake=$1
  shift
  say "configuring and building"
  "$cmake" -S /project -B /build -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_SUPPRESS_DEVELOPER_WARNINGS=ON "$@"
  ninja -C /build
}

# Runs the tests of /build with the command $@, which is ctest, maybe with some of its options or
# within another command.
run_tests() {
  say "testing"
  "$@" --test-dir /build --output-on-failure --no-tests=error -j "$(nproc)" \
    --output-junit /result/tests.xml
}
