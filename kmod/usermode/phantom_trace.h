/* SPDX-License-Identifier: GPL-2.0-only */
/* phantom_trace.h - the user-mode side of kmod/phantom_trace.h: a process has no such tracer. */
#ifndef PHANTOM_TRACE_H
#define PHANTOM_TRACE_H

#include <phantom_platform.h>
#include "phantom_abi.h"

static inline void trace_phantom_tick(u32 unit, const struct phantom_tick *record)
{
}

static inline void trace_phantom_set(u32 unit, u64 id, u32 patches, u32 refused, u32 radius_nm)
{
}

static inline void trace_phantom_fault(u32 unit, u32 faults)
{
}

static inline void trace_phantom_state(u32 unit, u32 from, u32 to)
{
}

#endif /* PHANTOM_TRACE_H */
