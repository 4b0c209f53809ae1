// SPDX-License-Identifier: GPL-2.0-or-later
#define PHANTOM_REAL_FIXED
#define PHANTOM_LANES 1
#include "lanes.h"

#include "fixed_probe.h"

_Static_assert(FIXED_PROBE_BITS == FIXED_BITS, "the test knows where the point is");
_Static_assert(FIXED_PROBE_LIMIT == FIXED_LIMIT, "and where numbers saturate");

int64_t fixed_probe_mul(int64_t a, int64_t b)
{
    return real_mul(a, b);
}

int64_t fixed_probe_mul_sub(int64_t a, int64_t b, int64_t c, int64_t d)
{
    return real_mul_sub(a, b, c, d);
}

int64_t fixed_probe_mul_fitting(int64_t a, int64_t b)
{
    return real_mul_fitting(a, b);
}

int64_t fixed_probe_mul_sub_fitting(int64_t a, int64_t b, int64_t c, int64_t d)
{
    return real_mul_sub_fitting(a, b, c, d);
}

int64_t fixed_probe_mul_small(int64_t a, int64_t b)
{
    return real_mul_small(a, b);
}

int64_t fixed_probe_mul_sum_small(int64_t a, int64_t b, int64_t c, int64_t d, int64_t e, int64_t f)
{
    return real_mul_sum_small(a, b, c, d, e, f);
}

int64_t fixed_probe_divide(int64_t a, int64_t b)
{
    return real_divide(a, b);
}

int64_t fixed_probe_sqrt(int64_t a)
{
    return real_sqrt(a);
}

int64_t fixed_probe_length(int64_t x, int64_t y, int64_t z)
{
    return real_length(x, y, z);
}

int64_t fixed_probe_root_of_ratio(int64_t a, int64_t b)
{
    return lanes_root_of_ratio((lanes){a}, (lanes){b})[0];
}

void fixed_probe_bring_to_one(int64_t vector[3])
{
    lanes a = {vector[0]}, b = {vector[1]}, c = {vector[2]};

    lanes_bring_to_one(&a, &b, &c);
    vector[0] = a[0];
    vector[1] = b[0];
    vector[2] = c[0];
}

void fixed_probe_unit(int64_t vector[3])
{
    struct real3 unit = real3_unit((struct real3){vector[0], vector[1], vector[2]});

    vector[0] = unit.x;
    vector[1] = unit.y;
    vector[2] = unit.z;
}

int64_t fixed_probe_from_nm(int64_t nm)
{
    return real_from_nm(nm);
}

int64_t fixed_probe_to_nm(int64_t mm)
{
    return real_to_nm(mm);
}

int32_t fixed_probe_to_integer(int64_t value, int32_t scale, uint32_t* saturated)
{
    return real_to_integer(value, scale, saturated);
}

uint64_t wide_probe_from_integer(int64_t a)
{
    return wide_from_integer(a).bits;
}

uint64_t wide_probe_add(uint64_t a, uint64_t b)
{
    return wide_add((wide){a}, (wide){b}).bits;
}

uint64_t wide_probe_sub(uint64_t a, uint64_t b)
{
    return wide_sub((wide){a}, (wide){b}).bits;
}

uint64_t wide_probe_mul(uint64_t a, uint64_t b)
{
    return wide_mul((wide){a}, (wide){b}).bits;
}

uint64_t wide_probe_div(uint64_t a, uint64_t b)
{
    return wide_div((wide){a}, (wide){b}).bits;
}

uint64_t wide_probe_sqrt(uint64_t a)
{
    return wide_sqrt((wide){a}).bits;
}

int wide_probe_less(uint64_t a, uint64_t b)
{
    return wide_less((wide){a}, (wide){b});
}

int64_t wide_probe_to_real(uint64_t a)
{
    return real_from_wide((wide){a});
}
