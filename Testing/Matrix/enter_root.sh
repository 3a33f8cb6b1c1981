#!/usr/bin/env bash
# Runs a command inside a root folder, contained as contained.sh says:
#
#   enter_root.sh ROOT [--read FROM=TO] [--write FROM=TO] ... -- COMMAND [ARGUMENT ...]
#
# --read and --write show a folder or file of this machine inside the root, the first so that nothing
# can be written to it.
set -euo pipefail

if [[ $1 != --contained ]]; then
  exec "$(dirname "${BASH_SOURCE[0]}")/contained.sh" "${BASH_SOURCE[0]}" --contained "$@"
fi
root=$2
shift 2

# Mounts $1 at $2 of the root, where a folder or an empty file is made for it.
show() {
  local to=$root$2
  if [[ -d $1 ]]; then
    mkdir -p "$to"
  else
    mkdir -p "${to%/*}"
    [[ -e $to ]] || : >"$to"
  fi
  mount --bind "$1" "$to"
}

mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
while [[ $1 != -- ]]; do
  show "${2%%=*}" "${2#*=}"
  [[ $1 != --read ]] || mount -o remount,bind,ro "$root${2#*=}"
  shift 2
done
shift
exec chroot "$root" "$@"
