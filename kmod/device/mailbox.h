/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * mailbox.h - the latest value, handed from one thread to another without waiting on either side.
 *
 * Three boxes: the writer fills one, the reader looks at one, and the third lies between them.
 * Posting exchanges the writer's with the middle one, reading the reader's with the middle one when
 * that is fresh. A reader never sees half a value and never an old one twice as new.
 *
 * One writer at a time (the caller serialises), one reader at a time; any context.
 */
#ifndef PHANTOM_MAILBOX_H
#define PHANTOM_MAILBOX_H

#include <phantom_platform.h>

#define PHANTOM_MAILBOX_BYTES 32 /* the largest value */
#define PHANTOM_MAILBOX_FRESH 4U /* beside the box's number: not yet read */

struct phantom_mailbox {
	u64 box[3][PHANTOM_MAILBOX_BYTES / sizeof(u64)]; /* each is its holder's alone */
	u32 size; /* of the value; fixed */
	u32 middle; /* number of the box between, | FRESH; exchanged */
	u32 filling; /* writer's */
	u32 reading; /* reader's */
};

/* A value of that many bytes, all zero, which is not fresh. */
static inline void phantom_mailbox_init(struct phantom_mailbox *mailbox, u32 size)
{
	memset(mailbox, 0, sizeof(*mailbox));
	mailbox->size = min_t(u32, size, PHANTOM_MAILBOX_BYTES);
	mailbox->reading = 1;
	mailbox->filling = 2;
}

static inline void phantom_mailbox_post(struct phantom_mailbox *mailbox, const void *value)
{
	memcpy(mailbox->box[mailbox->filling], value, mailbox->size);
	mailbox->filling = xchg(&mailbox->middle, mailbox->filling | PHANTOM_MAILBOX_FRESH) &
			   ~PHANTOM_MAILBOX_FRESH;
}

/* True when read() would give a value that it has not given before. */
static inline bool phantom_mailbox_fresh(const struct phantom_mailbox *mailbox)
{
	return READ_ONCE(mailbox->middle) & PHANTOM_MAILBOX_FRESH;
}

static inline void phantom_mailbox_read(struct phantom_mailbox *mailbox, void *value)
{
	if (phantom_mailbox_fresh(mailbox))
		mailbox->reading =
			xchg(&mailbox->middle, mailbox->reading) & ~PHANTOM_MAILBOX_FRESH;
	memcpy(value, mailbox->box[mailbox->reading], mailbox->size);
}

#endif /* PHANTOM_MAILBOX_H */
