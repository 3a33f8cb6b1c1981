#!/usr/bin/env bash
# Builds and tests the project on the systems that it supports, each in a root folder of its own made
# by debootstrap, and prints one line of result for each:
#
#   matrix.sh [LINE ...]        LINE: debian12 debian13 paraview cvista; none: all of them
#
# What a line does inside its root stands in lines/. Everything lives in build-matrix/, is kept, and
# makes the next run short; a folder of it may be deleted at any time.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source_tree=$(cd "$here/../.." && pwd)
work=$source_tree/build-matrix

all_lines=(debian12 debian13 paraview cvista)
declare -A release=([debian12]=bookworm [debian13]=trixie [paraview]=bookworm [cvista]=trixie)
declare -A script=([debian12]=debian [debian13]=debian [paraview]=paraview [cvista]=cvista)

say() { printf '== %s\n' "$*" >&2; }
die() { printf 'matrix: %s\n' "$*" >&2; exit 1; }

# --- Roots -------------------------------------------------------------------------------------------

# The mirror that this machine's own sources name.
debian_mirror() {
  local mirror
  # Debian's security archive and backports bear other labels.
  list() {
    apt-get indextargets --format '$(ORIGIN)|$(LABEL)|$(REPO_URI)' 'Created-By: Packages' |
      sed -n 's/^Debian|Debian|//p' | sort -u
  }
  mirror=${HRT_DEBIAN_MIRROR:-$(list)}
  if [[ -z $mirror ]]; then # no lists have been fetched yet
    apt-get update -q >&2 || true
    mirror=$(list)
  fi
  [[ -n $mirror ]] || die "apt names no mirror of Debian: set HRT_DEBIAN_MIRROR"
  printf '%s\n' "${mirror%%$'\n'*}"
}

# A bare root of the release $1; each line starts from a copy of it. (A subshell, which ends the lock.)
make_base() (
  base=$work/base/$1
  mkdir -p "$work/base"
  exec 8>"$work/base/lock" # a line of another run may want the same
  flock 8
  [[ ! -d $base ]] || exit 0
  say "making a root of Debian $1"
  rm -rf "$base.new"
  mkdir -p "$base.new"
  "$here/contained.sh" debootstrap --variant=minbase "$1" "$base.new" "$(debian_mirror)"
  # No package may start a service, and none needs to reach the disk at once.
  printf '#!/bin/sh\nexit 101\n' >"$base.new/usr/sbin/policy-rc.d"
  chmod +x "$base.new/usr/sbin/policy-rc.d"
  echo force-unsafe-io >"$base.new/etc/dpkg/dpkg.cfg.d/matrix"
  mv "$base.new" "$base"
)

# How this machine reaches its mirror and the package index: files and settings of the root $1.
connect() {
  local file
  for file in /etc/resolv.conf /etc/hosts; do
    cp -L "$file" "$1$file"
  done
  {
    apt-config dump | grep -E '^Acquire::(https?::Proxy|Check-(Valid-Until|Date)) ' || true
    [[ -z $certificates ]] || echo 'Acquire::https::CaInfo "/run/matrix/certificates";'
  } >"$1/etc/apt/apt.conf.d/90matrix"
}

make_root() {
  local line=$1 root=$work/$1/root
  make_base "${release[$line]}"
  if [[ ! -d $root ]]; then
    mkdir -p "$work/$line"
    rm -rf "$root.new"
    cp -a "$work/base/${release[$line]}" "$root.new"
    mv "$root.new" "$root"
  fi
  connect "$root"
}

# Brings the copy of the project in the root $1 up to date. Times are kept, so that only what has
# changed is built again; build folders of an earlier run stay.
copy_project() {
  local project=$1/project folder
  rm -rf "$project.new"
  mkdir "$project.new"
  tar -C "$source_tree" -c --exclude='./build*' --exclude=./.git --exclude=__pycache__ \
    --exclude=.pytest_cache . | tar -C "$project.new" -x
  for folder in "$project"/build*; do
    [[ ! -d $folder ]] || mv "$folder" "$project.new/"
  done
  rm -rf "$project"
  mv "$project.new" "$project"
}

# --- One line ----------------------------------------------------------------------------------------

# The environment of a line: nothing of the caller's shell but what reaches the package index.
line_environment() {
  printf '%s\n' HOME=/root LANG=C.UTF-8 CI=1 \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    CCACHE_DIR=/var/cache/ccache \
    PIP_CERT=/run/matrix/certificates PIP_DISABLE_PIP_VERSION_CHECK=1
  env | grep -E '^(PIP_(INDEX_URL|EXTRA_INDEX_URL|TRUSTED_HOST|DEFAULT_TIMEOUT)|(https?|no)_proxy|(HTTPS?|NO)_PROXY)=' ||
    true
}

run_inside() {
  local line=$1 root=$work/$1/root environment shown=()
  shown=(--read "$here/lines=/run/matrix/lines" --write "$work/$line/result=/result"
    --write "$work/ccache=/var/cache/ccache")
  [[ -z $certificates ]] || shown+=(--read "$certificates=/run/matrix/certificates")
  [[ ! -e /etc/pip.conf ]] || shown+=(--read /etc/pip.conf=/etc/pip.conf)
  mapfile -t environment < <(line_environment)
  if [[ -n ${HRT_DATA_ROOT:-} ]]; then
    shown+=(--read "$HRT_DATA_ROOT=/data")
    environment+=(HRT_DATA_ROOT=/data)
  fi
  "$here/enter_root.sh" "$root" "${shown[@]}" -- \
    /usr/bin/env -i "${environment[@]}" "/run/matrix/lines/${script[$line]}.sh"
}

# The value of the attribute $2 in ctest's report $1.
count() { sed -n "s/^[[:space:]]*$2=\"\([0-9]*\)\"\$/\1/p" "$1" | head -n 1; }

# What the tests of a line came to, from ctest's report $1.
summary() {
  local tests failures skipped
  tests=$(count "$1" tests)
  failures=$(count "$1" failures)
  skipped=$(count "$1" skipped)
  printf '%d of %d tests passed' $((tests - failures - skipped)) "$tests"
  ((skipped == 0)) || printf ', %d skipped' "$skipped"
  ((failures == 0)) || printf ', failed: %s' "$(sed -n 's/.*<testcase name="\([^"]*\)".* status="fail".*/\1/p' "$1" | paste -sd ' ')"
}

prepare_line() {
  mkdir -p "$work/$1/result" "$work/ccache"
  rm -f "$work/$1/result/tests.xml"
  make_root "$1"
  copy_project "$work/$1/root"
}

run_line() {
  local line=$1 log=$work/$1/log report=$work/$1/result/tests.xml start=$SECONDS status=0 said
  mkdir -p "$work/$line"
  exec 9>"$work/$line/lock"
  flock -n 9 || die "another run is at work in build-matrix/$line"
  say "$line (log: build-matrix/$line/log)"
  # A subshell of its own, so that its first failing command ends the line and not the matrix.
  (
    set -e
    prepare_line "$line"
    run_inside "$line"
  ) >"$log" 2>&1 </dev/null &
  job=$!
  wait "$job" || status=$?
  job=
  if [[ -s $report ]]; then
    said=$(summary "$report")
  else
    said="did not get to its tests"
    ((status != 0)) || status=1
  fi
  if ((status == 0)); then
    printf 'matrix: %s: %s (%d s)\n' "$line" "$said" $((SECONDS - start))
  else
    tail -n 40 "$log" >&2
    printf 'matrix: %s: FAILED, %s (%d s)\n' "$line" "$said" $((SECONDS - start))
  fi
  return "$status"
}

# --- All lines ---------------------------------------------------------------------------------------

(($# > 0)) || set -- "${all_lines[@]}"
for line in "$@"; do
  [[ -n ${release[$line]:-} ]] || die "there is no line '$line'; the lines are ${all_lines[*]}"
done
((EUID == 0)) || die "only root can make and enter a root folder"
for tool in debootstrap flock setpriv unshare; do
  command -v "$tool" >/dev/null || die "$tool is missing"
done
certificates=${PIP_CERT:-${SSL_CERT_FILE:-/etc/ssl/certs/ca-certificates.crt}}
[[ -e $certificates ]] || certificates=

# What runs in the background does not hear the terminal's interrupt: end it with this script.
job=
trap '[[ -z $job ]] || kill "$job"' EXIT
trap 'exit 130' INT TERM

failed=0
for line in "$@"; do
  run_line "$line" || failed=1
done
exit "$failed"
