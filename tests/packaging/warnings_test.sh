#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# `make modules` must fail on a warning of the compiler (W=1) and on a finding of sparse, in every source file. In a
# copy of kmod/, each file but the float units gets a function that reads user memory directly, which compiles but
# is an error to sparse; a float unit, which sparse cannot read, gets a function without a prototype.
#   warnings_test.sh KERNEL_HEADERS
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
kdir=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

fail() {
    echo "FAILED: $*"
    failed=1
}

command -v sparse >/dev/null || {
    echo "FAILED: sparse is not installed: run tools/bootstrap modules"
    exit 1
}

# The only kernel there is, so that the build is the one without KDIR.
mkdir -p "$work/build/kernels/root/usr/src" "$work/tools"
ln -s "$kdir" "$work/build/kernels/root/usr/src/"
cp -r "$top/kmod" "$top/shared" "$work/"
cp "$top/tools/check-fp" "$work/tools/"

plant() { # FILE DECLARATION BODY
    printf '%s;\n%s { %s }\n' "$2" "$2" "$3" >>"$work/kmod/$1"
}

checked=()
for file in "$work"/kmod/*.c "$work"/kmod/device/*.c; do
    file=${file#"$work/kmod/"}
    checked+=("$file")
    plant "$file" "int phantom_planted_$(basename "$file" .c)(const int __user *p)" 'return *p;'
done
plant phantom_set.c 'u32 phantom_planted_order(__le32 wire)' 'return wire;'
float_units=(contact_sse2 contact_avx2)
for unit in "${float_units[@]}"; do
    echo 'int phantom_planted(int x) { return x; }' >>"$work/kmod/float/$unit.c"
done

status=0
make -k -j "$(nproc)" -C "$work/kmod" modules >"$work/said" 2>&1 || status=$?
[ $status -ne 0 ] || fail "the build passed with all faults in it"
for file in "${checked[@]}"; do
    grep -qE "/$file:[0-9]+:[0-9]+: error: dereference of noderef expression" "$work/said" ||
        fail "sparse did not find the planted fault in $file"
done
grep -qE '/phantom_set\.c:[0-9:]+ +got restricted __le32' "$work/said" ||
    fail "sparse does not look at byte orders"
for unit in "${float_units[@]}"; do
    grep -qE "/$unit\.c:[0-9:]+ error: no previous prototype" "$work/said" ||
        fail "a warning of the compiler in $unit.c is no error"
done
[ $failed = 0 ] || {
    grep -vE '^  (CC|CHECK|LD)' "$work/said" | tail -n 30
    exit 1
}
echo "ok: ${kdir##*/linux-headers-}: each of $((${#checked[@]} + 1 + ${#float_units[@]})) planted warnings fails the build"
