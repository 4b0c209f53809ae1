// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/order_kernels.hpp"
#include "fdh/search_kernels.hpp"

PHANTOM_FDH_KERNELS(phantom::fdh::Isa::avx512)
