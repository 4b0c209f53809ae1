// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of floats as the search needs them, one set of functions per instruction set: arithmetic is the
// language's own, comparisons give masks, and `compress` packs the lanes of a mask. Included only by units
// compiled for their instruction set; everything is a member of a class of that set, so no code compiled for
// one can be linked into another.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "fdh/isa.hpp"

namespace phantom::fdh {

/// `compress` and `compress_index` write a whole vector: room for `width` elements must follow.
template <Isa I>
struct Simd;

template <>
struct Simd<Isa::scalar> {
    static constexpr int width = 1;
    using Float = float;
    using Mask = bool;

    static Float load(const float* p) { return *p; }
    static void store(float* p, Float v) { *p = v; }
    static Float set(float x) { return x; }
    static Float min(Float a, Float b) { return a < b ? a : b; } // x86's rule for NaN: the second
    static Float max(Float a, Float b) { return a > b ? a : b; }
    static Float sqrt(Float a) { return __builtin_sqrtf(a); }
    static Mask less(Float a, Float b) { return a < b; }
    static Mask less_equal(Float a, Float b) { return a <= b; }
    static Mask both(Mask a, Mask b) { return a && b; }
    static Float select(Mask m, Float a, Float b) { return m ? a : b; }
    static unsigned bits(Mask m) { return m; }
    static unsigned signs(const std::uint32_t* p) { return *p >> 31; }
    static unsigned count(unsigned bits) { return bits; }
    static void compress(float* to, Float v, unsigned) { *to = v; }
    static void compress_masked(std::uint32_t* to, const std::uint32_t* from, std::uint32_t mask, unsigned)
    {
        *to = *from & mask;
    }
    static void compress_index(std::uint32_t* to, std::uint32_t first, unsigned) { *to = first; }
};

#if defined(__SSE2__)
template <>
struct Simd<Isa::sse2> {
    static constexpr int width = 4;
    using Float = __m128;
    using Mask = __m128;

    static Float load(const float* p) { return _mm_loadu_ps(p); }
    static void store(float* p, Float v) { _mm_storeu_ps(p, v); }
    static Float set(float x) { return _mm_set1_ps(x); }
    static Float min(Float a, Float b) { return _mm_min_ps(a, b); }
    static Float max(Float a, Float b) { return _mm_max_ps(a, b); }
    static Float sqrt(Float a) { return _mm_sqrt_ps(a); }
    static Mask less(Float a, Float b) { return _mm_cmplt_ps(a, b); }
    static Mask less_equal(Float a, Float b) { return _mm_cmple_ps(a, b); }
    static Mask both(Mask a, Mask b) { return _mm_and_ps(a, b); }
    static Float select(Mask m, Float a, Float b) { return _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b)); }
    static unsigned bits(Mask m) { return static_cast<unsigned>(_mm_movemask_ps(m)); }
    static unsigned signs(const std::uint32_t* p)
    {
        return bits(_mm_castsi128_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))));
    }
    static unsigned count(unsigned bits) { return 0x4332322132212110u >> (4 * bits) & 15; }

    // Every lane is written and the next one overwrites those not wanted: no branch to mispredict.
    template <class T, class Lane>
    static void pack(T* to, unsigned bits, const Lane& lane)
    {
        for (unsigned i = 0; i < width; i++) {
            *to = lane(i);
            to += bits >> i & 1;
        }
    }
    static void compress(float* to, Float v, unsigned bits)
    {
        std::uint32_t lanes[width]; // as bits: a float's move must not touch a NaN
        _mm_storeu_ps(reinterpret_cast<float*>(lanes), v);
        pack(reinterpret_cast<Bits*>(to), bits, [&](unsigned i) { return lanes[i]; });
    }
    static void compress_masked(std::uint32_t* to, const std::uint32_t* from, std::uint32_t mask,
                                unsigned bits)
    {
        pack(to, bits, [&](unsigned i) { return from[i] & mask; });
    }
    static void compress_index(std::uint32_t* to, std::uint32_t first, unsigned bits)
    {
        pack(to, bits, [&](unsigned i) { return first + i; });
    }

  private:
    typedef std::uint32_t Bits __attribute__((may_alias));
};
#endif

#if defined(__AVX2__)
struct LaneOrders {
    std::uint64_t of[256] = {}; ///< the lanes whose bits are set, a byte each, then zeros
    constexpr LaneOrders()
    {
        for (unsigned bits = 0; bits < 256; bits++)
            for (std::uint64_t lane = 0, place = 0; lane < 8; lane++)
                if (bits >> lane & 1)
                    of[bits] |= lane << (8 * place++);
    }
};

template <>
struct Simd<Isa::avx2> {
    static constexpr int width = 8;
    using Float = __m256;
    using Mask = __m256;

    static Float load(const float* p) { return _mm256_loadu_ps(p); }
    static void store(float* p, Float v) { _mm256_storeu_ps(p, v); }
    static Float set(float x) { return _mm256_set1_ps(x); }
    static Float min(Float a, Float b) { return _mm256_min_ps(a, b); }
    static Float max(Float a, Float b) { return _mm256_max_ps(a, b); }
    static Float sqrt(Float a) { return _mm256_sqrt_ps(a); }
    static Mask less(Float a, Float b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
    static Mask less_equal(Float a, Float b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
    static Mask both(Mask a, Mask b) { return _mm256_and_ps(a, b); }
    static Float select(Mask m, Float a, Float b) { return _mm256_blendv_ps(b, a, m); }
    static unsigned bits(Mask m) { return static_cast<unsigned>(_mm256_movemask_ps(m)); }
    static unsigned signs(const std::uint32_t* p)
    {
        return bits(_mm256_castsi256_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))));
    }
    static unsigned count(unsigned bits) { return static_cast<unsigned>(__builtin_popcount(bits)); }
    static void compress(float* to, Float v, unsigned bits)
    {
        _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(v, order(bits)));
    }
    static void compress_masked(std::uint32_t* to, const std::uint32_t* from, std::uint32_t mask,
                                unsigned bits)
    {
        const __m256i v = _mm256_and_si256(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)),
                                           _mm256_set1_epi32(static_cast<int>(mask)));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(v, order(bits)));
    }
    static void compress_index(std::uint32_t* to, std::uint32_t first, unsigned bits)
    {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_add_epi32(order(bits), _mm256_set1_epi32(static_cast<int>(first))));
    }

  private:
    static constexpr LaneOrders orders{};
    static __m256i order(unsigned bits)
    {
        return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&orders.of[bits])));
    }
};
#endif

#if defined(__AVX512F__)
// The masked forms keep GCC 12 from warning of an uninitialized register inside its own header; it emits the
// unmasked instruction.
template <>
struct Simd<Isa::avx512> {
    static constexpr int width = 16;
    using Float = __m512;
    using Mask = __mmask16;
    static constexpr Mask all = 0xffff;

    static Float load(const float* p) { return _mm512_loadu_ps(p); }
    static void store(float* p, Float v) { _mm512_storeu_ps(p, v); }
    static Float set(float x) { return _mm512_set1_ps(x); }
    static Float min(Float a, Float b) { return _mm512_maskz_min_ps(all, a, b); }
    static Float max(Float a, Float b) { return _mm512_maskz_max_ps(all, a, b); }
    static Float sqrt(Float a) { return _mm512_maskz_sqrt_ps(all, a); }
    static Mask less(Float a, Float b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
    static Mask less_equal(Float a, Float b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
    static Mask both(Mask a, Mask b) { return static_cast<Mask>(a & b); }
    static Float select(Mask m, Float a, Float b) { return _mm512_mask_blend_ps(m, b, a); }
    static unsigned bits(Mask m) { return m; }
    static unsigned signs(const std::uint32_t* p) { return _mm512_movepi32_mask(_mm512_loadu_si512(p)); }
    static unsigned count(unsigned bits) { return static_cast<unsigned>(__builtin_popcount(bits)); }
    static void compress(float* to, Float v, unsigned bits)
    {
        _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<Mask>(bits), v));
    }
    static void compress_masked(std::uint32_t* to, const std::uint32_t* from, std::uint32_t mask,
                                unsigned bits)
    {
        const __m512i v =
            _mm512_and_si512(_mm512_loadu_si512(from), _mm512_set1_epi32(static_cast<int>(mask)));
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<Mask>(bits), v));
    }
    static void compress_index(std::uint32_t* to, std::uint32_t first, unsigned bits)
    {
        const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        const __m512i index = _mm512_add_epi32(lane, _mm512_set1_epi32(static_cast<int>(first)));
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<Mask>(bits), index));
    }
};
#endif

} // namespace phantom::fdh
