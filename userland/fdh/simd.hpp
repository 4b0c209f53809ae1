// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors as GCC and Clang know them, and the operations the language lacks: minimum, maximum, square root,
// and the lanes of a comparison as bits. Included only by the search units, each compiled for its instruction
// set; everything is a template over that set, so no code compiled for one can be linked into another.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "fdh/isa.hpp"

namespace phantom::fdh {

template <class T, int Width>
struct VectorType {
    typedef T type __attribute__((vector_size(sizeof(T) * Width)));
};

template <Isa I>
struct Simd {
    static constexpr int float_width = I == Isa::scalar ? 1 : I == Isa::sse2 ? 4 : 8;
    static constexpr int double_width = I == Isa::scalar ? 1 : I == Isa::sse2 ? 2 : I == Isa::avx2 ? 4 : 8;
    using Float = typename VectorType<float, float_width>::type;
    using Double = typename VectorType<double, double_width>::type;

    static Float load(const float* p)
    {
        Float v;
        __builtin_memcpy(&v, p, sizeof v);
        return v;
    }
    static Double load_double(const float* p)
    {
#if defined(__AVX512F__)
        if constexpr (I == Isa::avx512) // GCC 12 would convert it in halves
            return Double(_mm512_maskz_cvtps_pd(0xff, _mm256_loadu_ps(p)));
#endif
        typename VectorType<float, double_width>::type v;
        __builtin_memcpy(&v, p, sizeof v);
        return __builtin_convertvector(v, Double);
    }

    // x86's rule for NaN, everywhere: the second operand. The masked forms keep GCC 12 from warning of an
    // uninitialized register inside its own header; it emits the unmasked instruction.
    template <class V>
    static V min(V a, V b)
    {
#if defined(__SSE2__)
        if constexpr (I == Isa::sse2 && sizeof(a[0]) == 4)
            return V(_mm_min_ps(__m128(a), __m128(b)));
        else if constexpr (I == Isa::sse2)
            return V(_mm_min_pd(__m128d(a), __m128d(b)));
#endif
#if defined(__AVX2__)
        if constexpr (sizeof(a) == 32 && sizeof(a[0]) == 4)
            return V(_mm256_min_ps(__m256(a), __m256(b)));
        else if constexpr (sizeof(a) == 32)
            return V(_mm256_min_pd(__m256d(a), __m256d(b)));
#endif
#if defined(__AVX512F__)
        if constexpr (sizeof(a) == 64)
            return V(_mm512_maskz_min_pd(0xff, __m512d(a), __m512d(b)));
#endif
        return a < b ? a : b;
    }
    template <class V>
    static V max(V a, V b)
    {
#if defined(__SSE2__)
        if constexpr (I == Isa::sse2 && sizeof(a[0]) == 4)
            return V(_mm_max_ps(__m128(a), __m128(b)));
        else if constexpr (I == Isa::sse2)
            return V(_mm_max_pd(__m128d(a), __m128d(b)));
#endif
#if defined(__AVX2__)
        if constexpr (sizeof(a) == 32 && sizeof(a[0]) == 4)
            return V(_mm256_max_ps(__m256(a), __m256(b)));
        else if constexpr (sizeof(a) == 32)
            return V(_mm256_max_pd(__m256d(a), __m256d(b)));
#endif
#if defined(__AVX512F__)
        if constexpr (sizeof(a) == 64)
            return V(_mm512_maskz_max_pd(0xff, __m512d(a), __m512d(b)));
#endif
        return a > b ? a : b;
    }

    static Double sqrt(Double a)
    {
#if defined(__SSE2__)
        if constexpr (I == Isa::sse2)
            return Double(_mm_sqrt_pd(__m128d(a)));
#endif
#if defined(__AVX2__)
        if constexpr (I == Isa::avx2)
            return Double(_mm256_sqrt_pd(__m256d(a)));
#endif
#if defined(__AVX512F__)
        if constexpr (I == Isa::avx512)
            return Double(_mm512_maskz_sqrt_pd(0xff, __m512d(a)));
#endif
        for (int i = 0; i < double_width; i++)
            a[i] = __builtin_sqrt(a[i]);
        return a;
    }

    /// Bit i set where lane i of a comparison is true.
    template <class Mask>
    static unsigned bits(Mask m)
    {
#if defined(__SSE2__)
        if constexpr (I == Isa::sse2 && sizeof(m[0]) == 4)
            return static_cast<unsigned>(_mm_movemask_ps(__m128(m)));
        else if constexpr (I == Isa::sse2)
            return static_cast<unsigned>(_mm_movemask_pd(__m128d(m)));
#endif
#if defined(__AVX2__)
        if constexpr (sizeof(m) == 32 && sizeof(m[0]) == 4)
            return static_cast<unsigned>(_mm256_movemask_ps(__m256(m)));
        else if constexpr (sizeof(m) == 32)
            return static_cast<unsigned>(_mm256_movemask_pd(__m256d(m)));
#endif
#if defined(__AVX512DQ__)
        if constexpr (sizeof(m) == 64)
            return static_cast<unsigned>(_mm512_movepi64_mask(__m512i(m)));
#endif
        unsigned result = 0;
        for (unsigned i = 0; i < sizeof(m) / sizeof(m[0]); i++)
            result |= (m[i] & 1u) << i;
        return result;
    }
};

} // namespace phantom::fdh
