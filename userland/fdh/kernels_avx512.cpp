// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/kernels.hpp"

PHANTOM_FDH_KERNELS(phantom::fdh::Isa::avx512)
