#!/usr/bin/env bash
# `run` installs packages, but never at the price of others:
#
#   test_packages.sh RUN FOLDER
#
# A copy of the script RUN is run in FOLDER on a machine that is played by stand-ins: an apt-get that
# changes nothing, writes down how it was called, and says in a simulation what it would remove; a
# dpkg-query that knows no package; a cmake that fails, since nothing is to be built.
set -euo pipefail
run=$1
work=$2
rm -rf "$work"
mkdir -p "$work/bin" "$work/project"
cp "$run" "$work/project/run"
calls=$work/calls

cat >"$work/bin/apt-get" <<'STAND_IN'
#!/usr/bin/env bash
echo "$*" >>"$HRT_TEST_CALLS"
[[ " $* " == *" -s "* ]] || exit 0
for conflict in $HRT_TEST_CONFLICTS; do # each is PACKAGE:REMOVED
  if [[ " $* " == *" ${conflict%%:*} "* ]]; then
    echo "Remv ${conflict#*:} [1.0-1]"
    echo "Inst ${conflict%%:*} (1.0-1 Debian:12 [amd64])"
  fi
done
STAND_IN
printf '#!/bin/sh\nexit 1\n' >"$work/bin/dpkg-query"
printf '#!/bin/sh\nexit 1\n' >"$work/bin/cmake"
chmod +x "$work/bin/"*

failures=0
fail() {
  printf 'FAILED: %s\n' "$*"
  failures=1
}
expect_said() { grep -qF -- "$1" <<<"$output" || fail "nothing said of '$1' in: $output"; }
expect_unsaid() { ! grep -qF -- "$1" <<<"$output" || fail "'$1' said in: $output"; }
# Those of apt's calls that would have changed the machine.
changing_calls() { grep -v -e ' -s ' -e '^update ' "$calls" || true; }

# Plays `./run build` where the packages $1 (PACKAGE:REMOVED ...) exclude others.
play() {
  : >"$calls"
  status=0
  output=$(HRT_TEST_CALLS=$calls HRT_TEST_CONFLICTS=$1 PATH=$work/bin:$PATH \
    "$work/project/run" build 2>&1 </dev/null) || status=$?
  ((status != 0)) || fail "run reports success although nothing could be built"
}

# A package that we need excludes one that is there: both are named, and apt is not let loose.
play "python3-vtk9:python3-paraview"
expect_said "python3-vtk9 conflicts with python3-paraview"
expect_unsaid "libembree-dev conflicts"
expect_unsaid "sudo apt-get install"
[[ -z $(changing_calls) ]] || fail "apt was called: $(changing_calls)"

# Several at once: each pair is named.
play "python3-vtk9:python3-paraview libtbb-dev:libtbb2-dev"
expect_said "python3-vtk9 conflicts with python3-paraview"
expect_said "libtbb-dev conflicts with libtbb2-dev"
[[ -z $(changing_calls) ]] || fail "apt was called: $(changing_calls)"

# Nothing excludes anything: all is installed in one call, which forbids removals once more; or, for
# who is not root, the command is named.
play ""
expect_unsaid "conflicts"
if ((EUID == 0)); then
  grep -q '^install .*--no-remove .*python3-vtk9' "$calls" || fail "apt was not called: $(<"$calls")"
  ! changing_calls | grep -vq -- '--no-remove' || fail "removals allowed: $(changing_calls)"
else
  expect_said "sudo apt-get install"
fi

# A package that is of use only: it is left out with a word, the others are installed.
if ((EUID == 0)); then
  play "openmpi-bin:mpich"
  expect_said "openmpi-bin, which conflicts with mpich"
  changing_calls | grep -q 'python3-vtk9' || fail "the needed packages were not installed"
  changing_calls | grep -q 'ccache' || fail "the other optional packages were not installed"
  ! changing_calls | grep -q 'openmpi-bin' || fail "apt was called: $(changing_calls)"
fi

exit "$failures"
