// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_stats.c - status page, histograms and the ring of tick records.
 */
#include <phantom_platform.h>
#include "phantom_stats.h"

/* The part of the page that the sequence counter guards, in words. */
#define PHANTOM_PAGE_WORDS (offsetof(struct phantom_status, latency) / sizeof(u64))
#define PHANTOM_TICK_WORDS (sizeof(struct phantom_tick) / sizeof(u64))

/* What a page of memory is on every machine that the float sections run on. */
#define PHANTOM_PAGE_BYTES 4096U

static_assert(offsetof(struct phantom_status, latency) % sizeof(u64) == 0);
static_assert(sizeof(struct phantom_tick) % sizeof(u64) == 0);

u32 phantom_stats_page_size(void)
{
	return (sizeof(struct phantom_status) + PHANTOM_PAGE_BYTES - 1) & ~(PHANTOM_PAGE_BYTES - 1);
}

int phantom_stats_init(struct phantom_stats *stats)
{
	memset(stats, 0, sizeof(*stats));
	stats->page = phantom_platform_share(phantom_stats_page_size());
	if (!stats->page)
		return -ENOMEM;
	stats->ring = vzalloc(PHANTOM_RING_RECORDS * sizeof(*stats->ring));
	if (!stats->ring) {
		phantom_platform_unshare(stats->page, phantom_stats_page_size());
		stats->page = NULL;
		return -ENOMEM;
	}
	stats->next.abi_version = PHANTOM_ABI_VERSION;
	return 0;
}

void phantom_stats_destroy(struct phantom_stats *stats)
{
	vfree(stats->ring);
	phantom_platform_unshare(stats->page, phantom_stats_page_size());
}

static void phantom_stats_empty(struct phantom_histogram *histogram)
{
	u32 bucket;

	for (bucket = 0; bucket < PHANTOM_HISTOGRAM_BUCKETS; bucket++)
		WRITE_ONCE(histogram->count[bucket], 0);
	WRITE_ONCE(histogram->max_ns, 0);
}

void phantom_stats_begin(struct phantom_stats *stats)
{
	struct phantom_status *next = &stats->next;

	next->tick = 0;
	next->missed = 0;
	next->busy_ns = 0;
	memset(next->velocity_nm_s, 0, sizeof(next->velocity_nm_s));
	memset(next->normal_q30, 0, sizeof(next->normal_q30));
	memset(next->force_un, 0, sizeof(next->force_un));
	next->contacts = 0;
	next->flags = 0;
	next->sets = 0;
	next->fades = 0;
	next->saturated = 0;
	next->refused = 0;
	next->clamped = 0;
	next->sections = 0;
	next->section_max_ns = 0;
	phantom_stats_empty(&stats->page->latency);
	phantom_stats_empty(&stats->page->duration);
	phantom_stats_empty(&stats->page->section);
}

/*
 * The first word holds the sequence and the ABI's version; it is stored before the others with an
 * odd sequence and after them with an even one.
 */
void phantom_stats_publish(struct phantom_stats *stats)
{
	const u64 *from = (const u64 *)&stats->next;
	u64 *to = (u64 *)stats->page;
	u32 sequence = stats->next.sequence;
	size_t word;

	stats->next.lost = (u32)atomic_read(&stats->lost);
	WRITE_ONCE(stats->page->sequence, sequence + 1);
	smp_wmb(); /* odd before any word: readers of a new word see it */
	WRITE_ONCE(stats->page->abi_version, stats->next.abi_version);
	for (word = 1; word < PHANTOM_PAGE_WORDS; word++)
		WRITE_ONCE(to[word], from[word]);
	stats->next.sequence = sequence + 2;
	smp_store_release(&stats->page->sequence, sequence + 2); /* even after the last word */
}

bool phantom_stats_copy(const struct phantom_stats *stats, struct phantom_status *copy)
{
	u32 sequence = smp_load_acquire(&stats->page->sequence); /* before the words */
	const u64 *from = (const u64 *)stats->page;
	u64 *to = (u64 *)copy;
	size_t word;

	for (word = 0; word < PHANTOM_PAGE_WORDS; word++)
		to[word] = READ_ONCE(from[word]);
	smp_rmb(); /* the words before the sequence */
	return !(sequence & 1) && READ_ONCE(stats->page->sequence) == sequence;
}

static u32 phantom_stats_bucket(u32 duration_ns)
{
	u32 octave;

	if (duration_ns < 8)
		return duration_ns;
	octave = ilog2(duration_ns);
	return 8 * (octave - 2) + ((duration_ns >> (octave - 3)) & 7);
}

void phantom_stats_count(struct phantom_histogram *histogram, u64 duration_ns)
{
	u32 duration = min_t(u64, duration_ns, U32_MAX);
	u32 bucket = phantom_stats_bucket(duration);
	u32 count = READ_ONCE(histogram->count[bucket]);

	if (count != U32_MAX)
		WRITE_ONCE(histogram->count[bucket], count + 1);
	if (duration > READ_ONCE(histogram->max_ns))
		WRITE_ONCE(histogram->max_ns, duration);
}

void phantom_stats_record(struct phantom_stats *stats, const struct phantom_tick *record)
{
	const u64 *from = (const u64 *)record;
	u64 *to = (u64 *)&stats->ring[stats->head % PHANTOM_RING_RECORDS];
	size_t word;

	smp_wmb(); /* the last head before these words: see phantom_stats_read() */
	for (word = 0; word < PHANTOM_TICK_WORDS; word++)
		WRITE_ONCE(to[word], from[word]);
	smp_store_release(&stats->head, stats->head + 1); /* after the words */
}

u64 phantom_stats_head(const struct phantom_stats *stats)
{
	return smp_load_acquire(&stats->head); /* pairs with phantom_stats_record(), as below */
}

bool phantom_stats_read(struct phantom_stats *stats, u64 *cursor, struct phantom_tick *record)
{
	for (;;) {
		u64 head = smp_load_acquire(&stats->head); /* before the words */
		u64 *from, *to = (u64 *)record;
		size_t word;

		/* the record that is being written now may sit in the oldest place */
		if (head >= *cursor + PHANTOM_RING_RECORDS) {
			u64 oldest = head - PHANTOM_RING_RECORDS + 1;

			atomic_add((int)min_t(u64, oldest - *cursor, S32_MAX), &stats->lost);
			*cursor = oldest;
		}
		if (*cursor >= head)
			return false;
		from = (u64 *)&stats->ring[*cursor % PHANTOM_RING_RECORDS];
		for (word = 0; word < PHANTOM_TICK_WORDS; word++)
			to[word] = READ_ONCE(from[word]);
		smp_rmb(); /* the words before head */
		if (READ_ONCE(stats->head) >= *cursor + PHANTOM_RING_RECORDS)
			continue;
		(*cursor)++;
		return true;
	}
}
