// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/isa.hpp"

#include <initializer_list>

namespace phantom::fdh {

bool isa_available(Isa isa)
{
    switch (isa) {
    case Isa::best:
    case Isa::scalar:
        return true;
#ifdef PHANTOM_FDH_X86
    case Isa::sse2:
        return __builtin_cpu_supports("sse2");
    case Isa::avx2:
        return __builtin_cpu_supports("avx2");
    case Isa::avx512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#endif
    default:
        return false;
    }
}

Isa resolve_isa(Isa isa)
{
    if (isa != Isa::best)
        return isa;
    for (Isa candidate : {Isa::avx512, Isa::avx2, Isa::sse2})
        if (isa_available(candidate))
            return candidate;
    return Isa::scalar;
}

const char* isa_name(Isa isa)
{
    switch (isa) {
    case Isa::best:
        return "best";
    case Isa::scalar:
        return "scalar";
    case Isa::sse2:
        return "sse2";
    case Isa::avx2:
        return "avx2";
    case Isa::avx512:
        return "avx512";
    }
    return "unknown";
}

} // namespace phantom::fdh
