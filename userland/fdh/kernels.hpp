// SPDX-License-Identifier: GPL-2.0-or-later
// All that is compiled once per instruction set.
#pragma once

#include "fdh/leaf_kernels.hpp"
#include "fdh/order_kernels.hpp"
#include "fdh/search_kernels.hpp"

/// Instantiates everything for one instruction set.
#define PHANTOM_FDH_KERNELS(isa)                                                                             \
    namespace phantom::fdh {                                                                                 \
    template const SearchKernels<6>& kernels_of<isa, 6>();                                                   \
    template const SearchKernels<14>& kernels_of<isa, 14>();                                                 \
    template const SearchKernels<18>& kernels_of<isa, 18>();                                                 \
    template const SearchKernels<26>& kernels_of<isa, 26>();                                                 \
    template const OrderKernels& order_kernels_of<isa>();                                                    \
    template const LeafKernels<6>& leaf_kernels_of<isa, 6>();                                                \
    template const LeafKernels<14>& leaf_kernels_of<isa, 14>();                                              \
    template const LeafKernels<18>& leaf_kernels_of<isa, 18>();                                              \
    template const LeafKernels<26>& leaf_kernels_of<isa, 26>();                                              \
    }
