#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The Debian packages as their users have them: tests/package/empty_root.sh
# Builds them, has lintian look at them, and installs them with apt in an empty Debian, where there is nothing of this
# tree; runs there what users do first (use.sh); removes them, and compares the files with those before.
# Needs root, debootstrap and Debian's mirror, which is the one that this machine's apt uses. The empty Debian, with what
# the packages depend on, is kept in ~/.cache/crisp-package. Exits with 77 where it cannot run.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
cache=${XDG_CACHE_HOME:-$HOME/.cache}/crisp-package
suite=bookworm

skip() { echo "skipped: $*"; exit 77; }
[ "$(id -u)" = 0 ] || skip "it must be run as root"
for program in debootstrap lintian help2man dpkg-deb; do
  command -v "$program" >/dev/null || skip "$program is missing: .ci/install packaging"
done
mirror=$(apt-get indextargets --format '$(REPO_URI)' "Codename: $suite" 'Created-By: Packages' 2>/dev/null | head -n 1)
[ -n "$mirror" ] || skip "this machine's apt knows no mirror of Debian $suite"

mkdir -p "$cache"
try=$(mktemp -d "$cache.XXXXXX")
may() { unshare --mount --propagation private sh -c "$1" >/dev/null 2>&1; }
may "mknod '$try/null' c 1 3 && mkdir '$try/a' '$try/b' '$try/c' '$try/d' && mount -t overlay overlay -o lowerdir='$try/a',upperdir='$try/b',workdir='$try/c' '$try/d'" &&
  can_mount=1 || can_mount=
/usr/lib/apt/apt-helper download-file "${mirror%/}/dists/$suite/InRelease" "$try/InRelease" >/dev/null 2>&1 && can_load=1 || can_load=
rm -rf "$try"
[ "$can_mount" ] || skip "this machine makes no devices, or mounts no overlays"
[ "$can_load" ] || skip "$mirror cannot be reached"

if [ -z "${CRISP_OWN_MOUNTS:-}" ]; then  # what is mounted below ends with this script, however it ends
  exec env CRISP_OWN_MOUNTS=1 unshare --mount --propagation private "$0"
fi

step() { printf '\n== %s (at %d s)\n' "$*" "$SECONDS"; }

step "packages"
cd "$source"
cmake --workflow --preset package >build/package.log 2>&1 || { tail -n 50 build/package.log; exit 1; }
packages=(build/package/*.deb)
ls -l "${packages[@]}"

step "lintian"
# The packages are not meant for Debian's archive: no bug there asks for them, and whoever distributes them names an
# address (-DCRISP_MAINTAINER).
lintian --fail-on error,warning --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog,initial-upload-closes-no-bugs \
  "${packages[@]}"

# What the packages need of Debian, and what a program that uses them is built with.
depends=$(for package in "${packages[@]}"; do dpkg-deb -f "$package" Depends; done | sed 's/, */\n/g' |
  grep -v -e '^$' -e '^\(lib\|python3-\)\?crisp' | sort -u | paste -sd, )
depends+=", g++, cmake, ninja-build, man-db"

root=$cache/root
work=$(mktemp -d "$cache.XXXXXX")
trap 'umount -R "$work/root" 2>/dev/null || true; rm -rf --one-file-system "$work"' EXIT

if [ "$(cat "$root.depends" 2>/dev/null)" != "$depends" ]; then
  step "an empty Debian, and what the packages depend on"
  "$here/make_root.sh" "$suite" "$mirror" "$root" "$depends"
fi

# The packages come into a copy, whose changes lie beside it.
mkdir "$work/changes" "$work/overlay" "$work/root"
mount -t overlay overlay -o "lowerdir=$root,upperdir=$work/changes,workdir=$work/overlay" "$work/root"
mount -t proc proc "$work/root/proc"
in_root() { chroot "$work/root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
files() { (cd "$work/root" && find . -xdev \( -path ./var/cache/apt -o -path ./var/cache/man -o -path ./var/lib/apt -o -path ./var/log -o -path ./tmp \) -prune -o -print | sort); }
files >"$work/before"

step "installation"
mkdir "$work/root/tmp/packages"
cp "${packages[@]}" "$work/root/tmp/packages/"
in_root apt-get -q -y install --no-install-recommends -o Dpkg::Use-Pty=0 \
  $(cd "$work/root" && ls -d tmp/packages/*.deb | sed 's|^|/|')
[ -z "$(in_root dpkg --audit)" ]

step "use"
mkdir "$work/root/tmp/work"
cp -r "$here/use.sh" "$source/tests/examples" "$work/root/tmp/work/"
PYTHONPATH="$source/tests/docs" /usr/bin/python3 -B -c 'import code_blocks, pathlib, sys
print(next(block.text for block in code_blocks.code_blocks(pathlib.Path(sys.argv[1])) if block.is_python))' \
  "$source/README.md" >"$work/root/tmp/work/readme.py"
in_root sh /tmp/work/use.sh

step "removal"
in_root apt-get -q -y purge $(for package in "${packages[@]}"; do dpkg-deb -f "$package" Package; done) >/dev/null
rm -rf "$work/root/tmp/work" "$work/root/tmp/packages"
files >"$work/after"
diff "$work/before" "$work/after" || { echo "removal has left or taken the files above"; exit 1; }
echo "nothing is left"
printf '\nall of it took %d s\n' "$SECONDS"
