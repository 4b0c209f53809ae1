/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The numbers of kmod/float/number_fixed.h and wide_soft.h, one function each, for a test in C++. */
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FIXED_PROBE_BITS 36 /* of a real behind the point */
#define FIXED_PROBE_LIMIT (INT64_C(1) << 61)

int64_t fixed_probe_mul(int64_t a, int64_t b);
int64_t fixed_probe_mul_sub(int64_t a, int64_t b, int64_t c, int64_t d);
int64_t fixed_probe_mul_fitting(int64_t a, int64_t b);
int64_t fixed_probe_mul_sub_fitting(int64_t a, int64_t b, int64_t c, int64_t d);
int64_t fixed_probe_mul_small(int64_t a, int64_t b);
int64_t fixed_probe_mul_sum_small(int64_t a, int64_t b, int64_t c, int64_t d, int64_t e, int64_t f);
int64_t fixed_probe_divide(int64_t a, int64_t b);
int64_t fixed_probe_sqrt(int64_t a);
int64_t fixed_probe_length(int64_t x, int64_t y, int64_t z);
int64_t fixed_probe_root_of_ratio(int64_t a, int64_t b);
void fixed_probe_bring_to_one(int64_t vector[3]);
void fixed_probe_unit(int64_t vector[3]);
int64_t fixed_probe_from_nm(int64_t nm);
int64_t fixed_probe_to_nm(int64_t mm);
int32_t fixed_probe_to_integer(int64_t value, int32_t scale, uint32_t* saturated);

/* Doubles go by their bits. */
uint64_t wide_probe_from_integer(int64_t a);
uint64_t wide_probe_add(uint64_t a, uint64_t b);
uint64_t wide_probe_sub(uint64_t a, uint64_t b);
uint64_t wide_probe_mul(uint64_t a, uint64_t b);
uint64_t wide_probe_div(uint64_t a, uint64_t b);
uint64_t wide_probe_sqrt(uint64_t a);
int wide_probe_less(uint64_t a, uint64_t b);
int64_t wide_probe_to_real(uint64_t a);

#ifdef __cplusplus
}
#endif
