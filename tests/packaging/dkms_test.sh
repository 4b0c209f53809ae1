#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What DKMS does, done by hand: the sources in one folder, away from this tree; the commands of dkms.conf with the
# variables DKMS sets; the module where dkms.conf says, for the right kernel; and nothing left after CLEAN.
#   dkms_test.sh KERNEL_HEADERS
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
kernel_source_dir=$(cd "$1" && pwd)
kernelver=$(sed -n 's/^#define UTS_RELEASE "\(.*\)"/\1/p' "$kernel_source_dir/include/generated/utsrelease.h")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $*"
    [ ! -f "$work/said" ] || tail -n 20 "$work/said"
    exit 1
}

make -s -C "$top/kmod" sources "TO=$work/phantom_rt" || fail "make sources"
cd "$work/phantom_rt"
find . -type f | sort >"$work/before"
! grep -rlF "$top" . || fail "a source names the tree it was copied from"

MAKE=() CLEAN='' PACKAGE_VERSION='' BUILT_MODULE_NAME=() BUILT_MODULE_LOCATION=()
# shellcheck source=/dev/null
. ./dkms.conf
# DKMS puts its own make in the place of a leading "make".
run() {
    env -i PATH="$PATH" HOME="$work" sh -c "make -j$(nproc) KERNELRELEASE=$kernelver ${1#make }" >"$work/said" 2>&1
}
run "${MAKE[0]}" || fail "'${MAKE[0]}' failed for $kernelver"
module=${BUILT_MODULE_LOCATION[0]}/${BUILT_MODULE_NAME[0]}.ko
[ -f "$module" ] || fail "no $module where dkms.conf says"
grep -q 'check-fp: .* all in the float units' "$work/said" || fail "check-fp did not look at the module"

information() { modinfo -F "$1" "$module"; }
[ "$(information vermagic | cut -d' ' -f1)" = "$kernelver" ] || fail "vermagic is $(information vermagic)"
[ "$(information version)" = "$PACKAGE_VERSION" ] || fail "the module's version is '$(information version)', dkms.conf has $PACKAGE_VERSION"

run "$CLEAN" || fail "'$CLEAN' failed"
find . -type f | sort >"$work/after"
diff "$work/before" "$work/after" || fail "CLEAN left or took files"
echo "ok: $kernelver: built as DKMS does, outside the tree, and cleaned"
