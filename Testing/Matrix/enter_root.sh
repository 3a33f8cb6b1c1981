#!/usr/bin/env bash
# Runs a command inside a root folder:
#
#   enter_root.sh ROOT [--read FROM=TO] [--write FROM=TO] ... -- COMMAND [ARGUMENT ...]
#
# --read and --write show a folder or file of this machine inside the root, the first so that nothing
# can be written to it. The command gets name spaces of its own for mounts and processes: when it
# ends, in whatever way, or when the caller is killed, the kernel itself ends what it started and
# takes back what was mounted. So there is nothing to clean up, and nothing to forget.
set -euo pipefail

if [[ $1 != --inside ]]; then
  # The kernel ends unshare with the caller, and the command with unshare.
  exec setpriv --pdeathsig KILL \
    unshare --mount --propagation private --pid --fork --kill-child \
    "${BASH_SOURCE[0]}" --inside "$@"
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
