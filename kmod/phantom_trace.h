/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_trace.h - the events phantom_rt:* of the kernel's tracer.
 *
 *     echo 1 > /sys/kernel/tracing/events/phantom_rt/enable; cat /sys/kernel/tracing/trace_pipe
 *
 * Off, an event costs a jump that is not taken. `unit` is N of /dev/phantom_rtN; units of the other
 * fields as in phantom_abi.h. usermode/phantom_trace.h has the same names, empty, and is found
 * first there.
 */
#undef TRACE_SYSTEM
#define TRACE_SYSTEM phantom_rt

#if !defined(PHANTOM_TRACE_H) || defined(TRACE_HEADER_MULTI_READ)
#define PHANTOM_TRACE_H

#include <linux/tracepoint.h>
#include "phantom_abi.h"

#define phantom_trace_faults(faults)                                                               \
	__print_flags(faults, "|", {PHANTOM_FAULT_DEVICE, "device"},                               \
		      {PHANTOM_FAULT_OVERSPEED, "overspeed"}, {PHANTOM_FAULT_STALL, "stall"},      \
		      {PHANTOM_FAULT_NUMERIC, "numeric"}, {PHANTOM_FAULT_UNPLUGGED, "unplugged"},  \
		      {PHANTOM_FAULT_SUSPENDED, "suspended"})

#define phantom_trace_state(state)                                                                 \
	__print_symbolic(state, {PHANTOM_STATE_IDLE, "IDLE"}, {PHANTOM_STATE_RUNNING, "RUNNING"},  \
			 {PHANTOM_STATE_FAULT, "FAULT"})

/* The tracer's macros have a layout of their own. */
/* clang-format off */

/* One tick, after its force was sent. Servo thread. */
TRACE_EVENT(phantom_tick,
	TP_PROTO(u32 unit, const struct phantom_tick *record),
	TP_ARGS(unit, record),
	TP_STRUCT__entry(
		__field(u64, tick)
		__field(u64, set_id)
		__array(s64, tip_nm, 3)
		__array(s32, force_un, 3)
		__field(u32, unit)
		__field(u32, contacts)
		__field(u32, flags)
		__field(u32, faults)
		__field(u32, latency_ns)
		__field(u32, duration_ns)
	),
	TP_fast_assign(
		__entry->tick = record->tick;
		__entry->set_id = record->set_id;
		memcpy(__entry->tip_nm, record->tip_nm, sizeof(record->tip_nm));
		memcpy(__entry->force_un, record->force_un, sizeof(record->force_un));
		__entry->unit = unit;
		__entry->contacts = record->contacts;
		__entry->flags = record->flags;
		__entry->faults = record->faults;
		__entry->latency_ns = record->latency_ns;
		__entry->duration_ns = record->duration_ns;
	),
	TP_printk("unit=%u tick=%llu latency_ns=%u duration_ns=%u tip_nm=(%lld %lld %lld) force_un=(%d %d %d) contacts=%u set=%llu flags=%#x faults=%s",
		  __entry->unit, __entry->tick, __entry->latency_ns, __entry->duration_ns,
		  __entry->tip_nm[0], __entry->tip_nm[1], __entry->tip_nm[2],
		  __entry->force_un[0], __entry->force_un[1], __entry->force_un[2],
		  __entry->contacts, __entry->set_id, __entry->flags,
		  phantom_trace_faults(__entry->faults))
);

/* A tick has taken a set. Servo thread. */
TRACE_EVENT(phantom_set,
	TP_PROTO(u32 unit, u64 id, u32 patches, u32 refused, u32 radius_nm),
	TP_ARGS(unit, id, patches, refused, radius_nm),
	TP_STRUCT__entry(
		__field(u64, id)
		__field(u32, unit)
		__field(u32, patches)
		__field(u32, refused)
		__field(u32, radius_nm)
	),
	TP_fast_assign(
		__entry->id = id;
		__entry->unit = unit;
		__entry->patches = patches;
		__entry->refused = refused;
		__entry->radius_nm = radius_nm;
	),
	TP_printk("unit=%u set=%llu patches=%u refused=%u radius_nm=%u", __entry->unit,
		  __entry->id, __entry->patches, __entry->refused, __entry->radius_nm)
);

/* Faults were latched that were not before. Servo thread, or control. */
TRACE_EVENT(phantom_fault,
	TP_PROTO(u32 unit, u32 faults),
	TP_ARGS(unit, faults),
	TP_STRUCT__entry(
		__field(u32, unit)
		__field(u32, faults)
	),
	TP_fast_assign(
		__entry->unit = unit;
		__entry->faults = faults;
	),
	TP_printk("unit=%u faults=%s", __entry->unit, phantom_trace_faults(__entry->faults))
);

/* IDLE, RUNNING, FAULT. Servo thread, or control. */
TRACE_EVENT(phantom_state,
	TP_PROTO(u32 unit, u32 from, u32 to),
	TP_ARGS(unit, from, to),
	TP_STRUCT__entry(
		__field(u32, unit)
		__field(u32, from)
		__field(u32, to)
	),
	TP_fast_assign(
		__entry->unit = unit;
		__entry->from = from;
		__entry->to = to;
	),
	TP_printk("unit=%u from=%s to=%s", __entry->unit, phantom_trace_state(__entry->from),
		  phantom_trace_state(__entry->to))
);

/* clang-format on */

#endif /* PHANTOM_TRACE_H */

#undef TRACE_INCLUDE_PATH
#define TRACE_INCLUDE_PATH .
#undef TRACE_INCLUDE_FILE
#define TRACE_INCLUDE_FILE phantom_trace
#include <trace/define_trace.h>
