/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_stats.h - what a tick leaves behind: the status page, histograms, and a ring of records.
 *
 * One writer: the servo while it runs, the holder of the control mutex while it does not. Any
 * number of readers, who neither wait for it nor hold it up:
 *
 *   page    behind a sequence counter (phantom_abi.h); every word is stored once, whole
 *   ring    `head` counts the records written since the ring was made. The writer stores head only
 *           when a record is complete. A reader copies record i and then looks at head again: the
 *           copy is good when head < i + PHANTOM_RING_RECORDS, else the writer was there already.
 */
#ifndef PHANTOM_STATS_H
#define PHANTOM_STATS_H

#include <phantom_platform.h>
#include "phantom_abi.h"

/* 0.8 s at 10 kHz, 8 s at 1 kHz. A power of two. */
#define PHANTOM_RING_RECORDS 8192U

struct phantom_stats {
	struct phantom_status *page; /* shared, read-only for everyone else */
	struct phantom_status next; /* the writer's draft of the page, histograms unused */
	struct phantom_tick *ring;
	u64 head;
	atomic_t lost; /* records that readers came too late for: they add, the writer publishes */
};

/* Bytes of the page, a multiple of the page size. */
u32 phantom_stats_page_size(void);

int phantom_stats_init(struct phantom_stats *stats);
void phantom_stats_destroy(struct phantom_stats *stats);

/* ---- the writer ---------------------------------------------------------- */
/* A run begins: counters and histograms to zero; rate, model and the set in use stay. */
void phantom_stats_begin(struct phantom_stats *stats);
/* Copies `next` to the page. */
void phantom_stats_publish(struct phantom_stats *stats);
/* One more duration in one of the page's histograms. */
void phantom_stats_count(struct phantom_histogram *histogram, u64 duration_ns);
void phantom_stats_record(struct phantom_stats *stats, const struct phantom_tick *record);

/* ---- readers, any context ------------------------------------------------ */
/* The page but for its histograms. False: the writer came in between, try again. */
bool phantom_stats_copy(const struct phantom_stats *stats, struct phantom_status *copy);
/* Records written so far; the cursor of a reader who wants only what comes. */
u64 phantom_stats_head(const struct phantom_stats *stats);
/* The record at *cursor, which moves on; from the oldest left when that is lost. False: none. */
bool phantom_stats_read(struct phantom_stats *stats, u64 *cursor, struct phantom_tick *record);

#endif /* PHANTOM_STATS_H */
