/* SPDX-License-Identifier: GPL-2.0-or-later */
/*
 * gcc_builtins.h - GCC's names for what clang calls otherwise, for the float sections under the fuzzer.
 *
 * kmod/float uses builtins, as the kernel has no intrinsic headers. With every bit of the mask set the
 * result is the plain operation's; `source` is what lanes that are masked out would get.
 */
#ifndef PHANTOM_FUZZ_GCC_BUILTINS_H
#define PHANTOM_FUZZ_GCC_BUILTINS_H

#ifdef __clang__
#define __builtin_ia32_sqrtps512_mask(a, source, mask, rounding) __builtin_ia32_sqrtps512(a, rounding)
#define __builtin_ia32_minps512_mask(a, b, source, mask, rounding) __builtin_ia32_minps512(a, b, rounding)
#define __builtin_ia32_maxps512_mask(a, b, source, mask, rounding) __builtin_ia32_maxps512(a, b, rounding)
#endif

#endif /* PHANTOM_FUZZ_GCC_BUILTINS_H */
