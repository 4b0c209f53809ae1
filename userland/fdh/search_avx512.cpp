// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/search_kernels.hpp"

PHANTOM_FDH_SEARCH(phantom::fdh::Isa::avx512)
