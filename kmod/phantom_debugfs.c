// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_debugfs.c - the files of /sys/kernel/debug/phantom_rt.
 */
#include <phantom_platform.h>
#include "phantom_debugfs.h"
#include "phantom_kernel.h"

static struct dentry *phantom_debugfs_root;

static const char *const phantom_state_names[] = {"IDLE", "RUNNING", "FAULT"};
static const char *const phantom_model_names[] = {"off", "paper", "projected"};
static const char *const phantom_combine_names[] = {"paper", "bounded"};
static const char *const phantom_proxy_names[] = {"off", "paper", "constrained"};
static const char *const phantom_arith_names[] = {"float", "fixed", "double"};
static const char *const phantom_isa_names[] = {"none",	  "sse2",   "avx2",
						"double", "avx512", "fixed"};

#define phantom_name(names, index) ((index) < ARRAY_SIZE(names) ? (names)[index] : "unknown")

/* A copy of the status page, to be freed. NULL without memory. */
static struct phantom_status *phantom_debugfs_read(const struct phantom_servo *servo)
{
	struct phantom_status *status = kmalloc(sizeof(*status), GFP_KERNEL);

	/* asleep, so that a reader of high priority lets the servo finish what it writes */
	while (status && !phantom_stats_copy(&servo->stats, status))
		usleep_range(10, 100);
	return status;
}

static void phantom_debugfs_faults(struct seq_file *file, u32 faults)
{
	size_t bit;

	seq_puts(file, "faults       ");
	for (bit = 0; bit < ARRAY_SIZE(phantom_fault_names); bit++)
		if (faults >> bit & 1)
			seq_printf(file, "%s ", phantom_fault_names[bit]);
	seq_puts(file, faults ? "\n" : "none\n");
}

static void phantom_debugfs_settings(struct seq_file *file, const struct phantom_status *status)
{
	const struct phantom_model *model = &status->model;

	seq_printf(file, "state        %s\n", phantom_name(phantom_state_names, status->state));
	phantom_debugfs_faults(file, status->faults);
	seq_printf(file, "rate         %u Hz\n", status->rate_hz);
	seq_printf(file, "model        %s, %u steps, combine %s, proxy %s, %s, %s\n",
		   phantom_name(phantom_model_names, model->model), model->newton_steps,
		   phantom_name(phantom_combine_names, model->combine),
		   phantom_name(phantom_proxy_names, model->proxy),
		   phantom_name(phantom_arith_names, model->arith),
		   phantom_name(phantom_isa_names, status->isa));
}

/* Tenths of a percent of the time since START that no tick ran. */
static u64 phantom_debugfs_idle(const struct phantom_status *status)
{
	u64 run_ns = status->time_ns - status->start_ns;

	if (!status->tick || !run_ns || status->busy_ns > run_ns)
		return 1000;
	return 1000 - div64_u64(status->busy_ns, div64_u64(run_ns, 1000) + 1);
}

static void phantom_debugfs_counters(struct seq_file *file, const struct phantom_status *status)
{
	u64 idle = phantom_debugfs_idle(status);

	seq_printf(file, "ticks        %llu, %llu missed, idle %llu.%llu %%\n", status->tick,
		   status->missed, idle / 10, idle % 10);
	seq_printf(file, "sections     %llu, longest %u ns\n", status->sections,
		   status->section_max_ns);
	seq_printf(file, "sets         %llu taken, %llu patches refused, %llu fades\n",
		   status->sets, status->refused, status->fades);
	seq_printf(file, "clamped      %llu ticks, %llu conversions saturated\n", status->clamped,
		   status->saturated);
}

static void phantom_debugfs_motion(struct seq_file *file, const struct phantom_status *status)
{
	seq_printf(file, "tip          %lld %lld %lld nm\n", status->tip_nm[0], status->tip_nm[1],
		   status->tip_nm[2]);
	seq_printf(file, "proxy        %lld %lld %lld nm\n", status->proxy_nm[0],
		   status->proxy_nm[1], status->proxy_nm[2]);
	seq_printf(file, "velocity     %d %d %d nm/s\n", status->velocity_nm_s[0],
		   status->velocity_nm_s[1], status->velocity_nm_s[2]);
	seq_printf(file, "force        %d %d %d uN, %u contacts\n", status->force_un[0],
		   status->force_un[1], status->force_un[2], status->contacts);
	seq_printf(file, "flags        %#x\n", status->flags);
}

static int phantom_status_show(struct seq_file *file, void *unused)
{
	const struct phantom_servo *servo = file->private;
	struct phantom_status *status = phantom_debugfs_read(servo);

	if (!status)
		return -ENOMEM;
	phantom_debugfs_settings(file, status);
	phantom_debugfs_counters(file, status);
	phantom_debugfs_motion(file, status);
	kfree(status);
	return 0;
}
DEFINE_SHOW_ATTRIBUTE(phantom_status);

/* ---- histograms ---------------------------------------------------------- */

/* Shortest duration that the bucket counts, ns: phantom_abi.h, struct phantom_histogram. */
static u64 phantom_debugfs_bucket(u32 bucket)
{
	if (bucket < 8)
		return bucket;
	return (u64)(8 + bucket % 8) << (bucket / 8 - 1);
}

/* The end of the bucket below which that many thousandths of the durations are. */
static u64 phantom_debugfs_percentile(const struct phantom_histogram *histogram, u64 total,
				      u32 thousandths)
{
	u64 wanted = div64_u64(total * thousandths + 999, 1000);
	u64 sum = 0;
	u32 bucket;

	for (bucket = 0; bucket < PHANTOM_HISTOGRAM_BUCKETS; bucket++) {
		sum += READ_ONCE(histogram->count[bucket]);
		if (sum >= wanted)
			break;
	}
	return phantom_debugfs_bucket(bucket + 1);
}

static void phantom_debugfs_histogram(struct seq_file *file, const char *name,
				      const struct phantom_histogram *histogram)
{
	u64 total = 0;
	u32 bucket, count;

	for (bucket = 0; bucket < PHANTOM_HISTOGRAM_BUCKETS; bucket++)
		total += READ_ONCE(histogram->count[bucket]);
	seq_printf(file, "%s: %llu", name, total);
	if (total)
		seq_printf(file,
			   ", median < %llu ns, p99 < %llu ns, p99.9 < %llu ns, longest %u ns",
			   phantom_debugfs_percentile(histogram, total, 500),
			   phantom_debugfs_percentile(histogram, total, 990),
			   phantom_debugfs_percentile(histogram, total, 999),
			   READ_ONCE(histogram->max_ns));
	seq_putc(file, '\n');
	for (bucket = 0; bucket < PHANTOM_HISTOGRAM_BUCKETS; bucket++) {
		count = READ_ONCE(histogram->count[bucket]);
		if (count)
			seq_printf(file, "  %10llu ns  %10u\n", phantom_debugfs_bucket(bucket),
				   count);
	}
}

static int phantom_histograms_show(struct seq_file *file, void *unused)
{
	const struct phantom_servo *servo = file->private;
	const struct phantom_status *page = servo->stats.page;

	phantom_debugfs_histogram(file, "latency", &page->latency);
	phantom_debugfs_histogram(file, "duration", &page->duration);
	phantom_debugfs_histogram(file, "section", &page->section);
	return 0;
}
DEFINE_SHOW_ATTRIBUTE(phantom_histograms);

/* ---- set ----------------------------------------------------------------- */

static int phantom_set_show(struct seq_file *file, void *unused)
{
	const struct phantom_servo *servo = file->private;
	struct phantom_status *status = phantom_debugfs_read(servo);
	u64 now_ns = ktime_get_ns();

	if (!status)
		return -ENOMEM;
	if (status->set_id) {
		seq_printf(file, "set          %llu, %u patches\n", status->set_id,
			   status->set_patches);
		seq_printf(file, "level        %u, %u nm from the mesh\n", status->set_level,
			   status->set_level_error_nm);
		seq_printf(file, "taken        %llu us ago\n",
			   div64_u64(now_ns - min(now_ns, status->set_time_ns), 1000));
	} else {
		seq_puts(file, "set          none\n");
	}
	seq_printf(file, "sets         %zu bytes\n", phantom_set_bytes(&servo->sets));
	seq_printf(file, "ring         %zu bytes, %u records\n",
		   PHANTOM_RING_RECORDS * sizeof(struct phantom_tick), PHANTOM_RING_RECORDS);
	seq_printf(file, "page         %u bytes\n", phantom_stats_page_size());
	seq_printf(file, "servo        %zu bytes\n", sizeof(*servo));
	kfree(status);
	return 0;
}
DEFINE_SHOW_ATTRIBUTE(phantom_set);

/* ---- folders ------------------------------------------------------------- */

void phantom_debugfs_init(void)
{
	phantom_debugfs_root = debugfs_create_dir("phantom_rt", NULL);
}

void phantom_debugfs_exit(void)
{
	debugfs_remove(phantom_debugfs_root);
}

struct dentry *phantom_debugfs_add(const char *name, struct phantom_servo *servo)
{
	struct dentry *folder = debugfs_create_dir(name, phantom_debugfs_root);

	debugfs_create_file("status", 0400, folder, servo, &phantom_status_fops);
	debugfs_create_file("histograms", 0400, folder, servo, &phantom_histograms_fops);
	debugfs_create_file("set", 0400, folder, servo, &phantom_set_fops);
	return folder;
}

void phantom_debugfs_remove(struct dentry *folder)
{
	debugfs_remove(folder);
}
