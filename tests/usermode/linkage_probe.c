// SPDX-License-Identifier: GPL-2.0-or-later
// The linkage's sine and cosine, which a float unit keeps to itself, within a test's reach.
#define phantom_linkage_three_joint linkage_probe_ops
#include "float/linkage.c"

#include "arm_machine.h"

void arm_sine_cosine(int64_t numerator, int64_t denominator, double* sine, double* cosine)
{
    const struct linkage_angle angle = linkage_turns(numerator, denominator);

    *sine = angle.sine;
    *cosine = angle.cosine;
}
