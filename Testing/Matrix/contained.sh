#!/usr/bin/env bash
# Runs a command in name spaces of its own for mounts and processes: contained.sh COMMAND [ARGUMENT ...]
# When it ends, in whatever way, or when the caller is killed, the kernel itself ends all that it has
# started and takes back all that it has mounted. So there is nothing to clean up, and nothing to forget.
set -euo pipefail
# The kernel ends unshare with the caller, and the command with unshare.
exec setpriv --pdeathsig KILL \
  unshare --mount --propagation private --pid --fork --kill-child --mount-proc "$@"
