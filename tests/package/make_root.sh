#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# An empty Debian with what packages depend on: make_root.sh SUITE MIRROR ROOT DEPENDS
# Packages that were downloaded are kept beside it. ROOT.depends is written once all of it is there.
set -euo pipefail
suite=$1 mirror=$2 root=$3 depends=$4
log=$root.log archives=$root.archives
trap 'umount "$root/var/cache/apt/archives" "$root/proc" 2>/dev/null || true' EXIT

# logged COMMAND... shows the end of what it said only where it fails.
logged() { "$@" >>"$log" 2>&1 || { tail -n 30 "$log"; exit 1; }; }
in_root() { logged chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }

rm -rf --one-file-system "$root" "$root.depends" "$log"
mkdir -p "$root" "$archives/partial"
logged debootstrap --variant=minbase --cache-dir="$archives" "$suite" "$root" "$mirror"

# What this machine's apt uses of Debian, the root's uses, too.
apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
  sort -u >"$root/etc/apt/sources.list"
apt-config dump | grep -E '^Acquire::(http|https|Check)' >"$root/etc/apt/apt.conf.d/90host" || true
cp /etc/resolv.conf "$root/etc/resolv.conf"
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"  # no services
chmod 755 "$root/usr/sbin/policy-rc.d"

mount -t proc proc "$root/proc"
mount --bind "$archives" "$root/var/cache/apt/archives"
in_root apt-get -q update
in_root apt-get -q -y --no-install-recommends satisfy "$depends"
echo "$depends" >"$root.depends"
