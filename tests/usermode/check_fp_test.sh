#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-or-later
# tools/check-fp must pass a clean module, and fail each kind of stray that is planted in one.
#   check_fp_test.sh CHECK_FP C_COMPILER
set -eu

check=$1
cc=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failed=0

cat >contact_sse2.c <<'END'
static __attribute__((noinline)) float clamp(float x) { return x < 0 ? 0 : x; }
static float tick(float x) { return clamp(x) * 2; }
float (*const table_sse2)(float) = tick;
END
cat >plain.c <<'END'
static __attribute__((noinline)) int clamp(int x) { return x < 0 ? 0 : x; }
int plain(int x) { return clamp(x) * 2; }
END

compile() { # FILE
	"$cc" -O2 -c "$1" -o "${1%.c}.o"
}

# expect 0|1 NAME WORD OBJECT...: links a module, wants that exit status and the word in what is said
expect() {
	want=$1 name=$2 word=$3
	shift 3
	"$cc" -nostdlib -r "$@" -o module.ko
	status=0
	"$check" module.ko >said 2>&1 || status=$?
	if [ $status -ne "$want" ] || ! grep -q -e "$word" said; then
		echo "FAILED: $name: status $status instead of $want, said:"
		cat said
		failed=1
	else
		echo "ok: $name"
	fi
}

plant() { # NAME CODE
	printf '%s\n' "$2" >planted.c
	compile planted.c
	expect 1 "$1" planted_here plain.o contact_sse2.o planted.o
}

compile contact_sse2.c
compile plain.c
expect 0 "clean module" "all in the float units" plain.o contact_sse2.o
expect 0 "order of the objects" "all in the float units" contact_sse2.o plain.o

plant "a scalar float" 'float planted_here(float x) { return x * 2; }'
plant "a static function" 'static __attribute__((noinline)) double planted_here(double x) { return x * x; }
	int other(int x) { return (int)planted_here(x); }'
plant "a copy through xmm" 'void planted_here(void *to, const void *from) {
	__asm__ volatile("movups (%0), %%xmm0\n\tmovups %%xmm0, (%1)" : : "r"(from), "r"(to) : "memory"); }'
plant "ymm" 'void planted_here(void) { __asm__ volatile("vpxor %ymm3, %ymm3, %ymm3"); }'
plant "zmm" 'void planted_here(void) { __asm__ volatile("vpxord %zmm30, %zmm30, %zmm30"); }'
plant "a mask register" 'void planted_here(void) { __asm__ volatile("kxorw %k1, %k1, %k1"); }'
plant "mmx" 'void planted_here(void) { __asm__ volatile("pxor %mm1, %mm1"); }'
plant "x87" 'void planted_here(void) { __asm__ volatile("fldz\n\tfstp %st(0)"); }'
plant "x87 without a register" 'void planted_here(void) { __asm__ volatile("fninit"); }'
plant "the control word" 'void planted_here(void) { unsigned int x = 0; __asm__ volatile("ldmxcsr %0" : : "m"(x)); }'
plant "another section" '__attribute__((section(".init.text"))) float planted_here(float x) { return x + 1; }'

# a global function of a float unit could be called without a section
printf 'float planted_here(float x) { return x + x; }\n' >>contact_sse2.c
compile contact_sse2.c
expect 1 "a global function in a float unit" planted_here plain.o contact_sse2.o

refuses() { # FILE
	status=0
	"$check" "$1" >said 2>&1 || status=$?
	if [ $status -eq 1 ] && grep -q -e "$1" said; then
		echo "ok: refuses $1"
	else
		echo "FAILED: $1: status $status"
		failed=1
	fi
}

refuses nowhere.ko
refuses plain.c # no object file
exit $failed
