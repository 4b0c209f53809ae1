/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * mailbox.h - the latest position, handed from one thread to another without waiting on either
 * side.
 *
 * Three boxes: the writer fills one, the reader looks at one, and the third lies between them.
 * Posting exchanges the writer's with the middle one, reading the reader's with the middle one when
 * that is fresh. A reader never sees half a position and never an old one twice as new.
 *
 * One writer at a time (the caller serialises), one reader.
 */
#ifndef PHANTOM_MAILBOX_H
#define PHANTOM_MAILBOX_H

#include <phantom_platform.h>

#define PHANTOM_MAILBOX_FRESH 4U /* beside the box's number: not yet read */

struct phantom_mailbox {
	s64 box[3][3]; /* each is its holder's alone */
	u32 middle; /* number of the box between, | FRESH; exchanged */
	u32 filling; /* writer's */
	u32 reading; /* reader's */
};

static inline void phantom_mailbox_init(struct phantom_mailbox *mailbox)
{
	memset(mailbox, 0, sizeof(*mailbox));
	mailbox->reading = 1;
	mailbox->filling = 2;
}

static inline void phantom_mailbox_post(struct phantom_mailbox *mailbox, const s64 value[3])
{
	memcpy(mailbox->box[mailbox->filling], value, sizeof(mailbox->box[0]));
	mailbox->filling = xchg(&mailbox->middle, mailbox->filling | PHANTOM_MAILBOX_FRESH) &
			   ~PHANTOM_MAILBOX_FRESH;
}

static inline void phantom_mailbox_read(struct phantom_mailbox *mailbox, s64 value[3])
{
	if (READ_ONCE(mailbox->middle) & PHANTOM_MAILBOX_FRESH)
		mailbox->reading =
			xchg(&mailbox->middle, mailbox->reading) & ~PHANTOM_MAILBOX_FRESH;
	memcpy(value, mailbox->box[mailbox->reading], sizeof(mailbox->box[0]));
}

#endif /* PHANTOM_MAILBOX_H */
