/* SPDX-License-Identifier: GPL-2.0-only */
/* clocks.h - the two clocks of a user-mode machine, see phantom_clock.h. */
#ifndef PHANTOM_CLOCKS_H
#define PHANTOM_CLOCKS_H

#include <phantom_platform.h>
#include "phantom_clock.h"
#include "phantom_usermode.h"

struct phantom_real_clock {
	struct phantom_clock clock;
	int cpu; /* fixed; -1 = not pinned */
	pthread_t thread;
	struct phantom_servo *servo;
	wait_queue_head_t wait; /* woken when the run is over */
	u32 over; /* the run has ended by itself; word */
	u32 abandon; /* the run has to end at once; word */
	s32 fifo; /* as phantom_um_thread_info; word */
	u64 stall_ns; /* to be added to the next deadline; exchanged */
};

struct phantom_virtual_clock {
	struct phantom_clock clock;
	struct mutex stepping; /* whoever holds it is the servo thread */
	u64 now_ns; /* word; changed under stepping */
	struct phantom_servo *servo; /* under stepping; NULL: not started, or over */
	u64 stall_ns; /* to be added to the next deadline; exchanged */
};

void phantom_real_clock_init(struct phantom_real_clock *real, int cpu);
void phantom_real_clock_destroy(struct phantom_real_clock *real);

void phantom_virtual_clock_init(struct phantom_virtual_clock *virtual);
void phantom_virtual_clock_destroy(struct phantom_virtual_clock *virtual);
/* Ticks run; -EAGAIN when not started. */
int phantom_virtual_clock_step(struct phantom_virtual_clock *virtual, u32 ticks);
/* Where the clock stands from now on, until it is stepped. */
void phantom_virtual_clock_set(struct phantom_virtual_clock *virtual, u64 now_ns);
/* One tick with that number, at now_ns, of the period that began at due_ns. 1, or -EAGAIN. */
int phantom_virtual_clock_replay(struct phantom_virtual_clock *virtual, u64 tick, u64 now_ns,
				 u64 due_ns);

#endif /* PHANTOM_CLOCKS_H */
