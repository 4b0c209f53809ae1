/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_context.h - the rules of phantom_servo.h, "what may be called where", as assertions.
 *
 * A kernel with PROVE_LOCKING and DEBUG_ATOMIC_SLEEP warns where one does not hold; without, they
 * cost nothing. User mode aborts, in every build.
 */
#ifndef PHANTOM_CONTEXT_H
#define PHANTOM_CONTEXT_H

#include <phantom_platform.h>
#include "phantom_servo.h"

/* Process context, control mutex held. */
static inline void phantom_context_control(const struct phantom_servo *servo)
{
	might_sleep();
	lockdep_assert_held(&servo->control);
}

/* Process context, sets.submitting held. */
static inline void phantom_context_submitter(const struct phantom_sets *sets)
{
	might_sleep();
	lockdep_assert_held(&sets->submitting);
}

/* Process context without the mutexes: the callee may take them. */
static inline void phantom_context_file(const struct phantom_servo *servo)
{
	might_sleep();
	lockdep_assert_not_held(&servo->control);
	lockdep_assert_not_held(&servo->sets.submitting);
}

/* The servo thread, outside float sections. */
static inline void phantom_context_servo(const struct phantom_servo *servo)
{
	lockdep_assert_preemption_enabled();
	lockdep_assert(READ_ONCE(servo->thread) == current);
}

/* Whoever has the run state: the servo thread, or control while there is none. */
static inline void phantom_context_run(const struct phantom_servo *servo)
{
	lockdep_assert(READ_ONCE(servo->thread) == current ||
		       (!READ_ONCE(servo->thread) && lockdep_is_held(&servo->control)));
}

/* Between kernel_fpu_begin() and kernel_fpu_end(). */
static inline void phantom_context_section(void)
{
	lockdep_assert_preemption_disabled();
}

#endif /* PHANTOM_CONTEXT_H */
