// SPDX-License-Identifier: GPL-2.0-only
/*
 * usermode.c - a machine: device, clock, servo and character device, with calls like system calls.
 */
#include <phantom_platform.h>
#include "clocks.h"
#include "device/phantom_device.h"
#include "phantom_chardev.h"
#include "phantom_usermode.h"

/* A desktop arm's. */
#define USERMODE_FORCE_DEFAULT_UN 10000000

/* A device in front of the simulated one, that fails when told to. */
struct phantom_um_device {
	struct phantom_device device; /* first, as the others read it */
	struct phantom_device *behind;
	int error; /* of every read; word */
	int write_error; /* of every write; word */
};

struct phantom_um {
	struct phantom_um_device device;
	union {
		struct phantom_real_clock real;
		struct phantom_virtual_clock virtual;
	} clock;
	struct phantom_device_ops device_ops;
	u32 clock_kind;
	u32 files; /* open; counted atomically */
	struct phantom_servo servo;
	struct phantom_chardev chardev;
};

/*
 * The descriptor: a call in flight keeps the file alive while another thread closes it, and release
 * comes with the last of them, as in the kernel.
 */
struct phantom_um_file {
	struct phantom_um *machine;
	struct phantom_file *file;
	const void *view; /* of the status page; exchanged once */
	bool nonblocking;
	u32 users; /* counted atomically */
};

/* ---- the device ---------------------------------------------------------- */

static struct phantom_um_device *um_device_of(struct phantom_device *device)
{
	return container_of(device, struct phantom_um_device, device);
}

static int um_device_start(struct phantom_device *device)
{
	struct phantom_device *behind = um_device_of(device)->behind;

	return behind->ops->start(behind);
}

static void um_device_stop(struct phantom_device *device)
{
	struct phantom_device *behind = um_device_of(device)->behind;

	behind->ops->stop(behind);
}

static int um_device_read(struct phantom_device *device, s64 tip_nm[3])
{
	struct phantom_um_device *front = um_device_of(device);
	int error = READ_ONCE(front->error);

	return error ? error : front->behind->ops->read(front->behind, tip_nm);
}

static int um_device_write(struct phantom_device *device, const s32 force_un[3])
{
	struct phantom_um_device *front = um_device_of(device);
	int error = READ_ONCE(front->write_error);

	return error ? error : front->behind->ops->write(front->behind, force_un);
}

static void um_device_move(struct phantom_device *device, const s64 tip_nm[3])
{
	struct phantom_device *behind = um_device_of(device)->behind;

	behind->ops->move(behind, tip_nm);
}

static int um_device_init(struct phantom_um *machine, u32 max_force_un)
{
	struct phantom_um_device *front = &machine->device;
	struct phantom_device *behind = phantom_device_sim_create(max_force_un);

	if (IS_ERR(behind))
		return (int)PTR_ERR(behind);
	front->behind = behind;
	front->device = *behind;
	machine->device_ops = *behind->ops;
	machine->device_ops.start = um_device_start;
	machine->device_ops.stop = um_device_stop;
	machine->device_ops.read = um_device_read;
	machine->device_ops.write = um_device_write;
	machine->device_ops.move = um_device_move;
	front->device.ops = &machine->device_ops;
	return 0;
}

/* ---- the machine --------------------------------------------------------- */

const struct phantom_float_ops *const *phantom_um_sections(void)
{
	static const struct phantom_float_ops *const all[] = {
		&phantom_float_avx512, &phantom_float_avx2,  &phantom_float_sse2,
		&phantom_float_double, &phantom_float_fixed, NULL};

	if (phantom_platform_has_avx512())
		return all;
	return phantom_platform_has_avx2() ? all + 1 : all + 2;
}

/* By arithmetic. DOUBLE is offered only to who asks for it; float runs with the best then. */
static int um_choose_ops(u32 isa, const struct phantom_float_ops *ops[PHANTOM_ARITHS])
{
	const struct phantom_float_ops *const *have = phantom_um_sections();
	bool best = isa == PHANTOM_ISA_NONE || isa == PHANTOM_ISA_DOUBLE;

	memset(ops, 0, PHANTOM_ARITHS * sizeof(ops[0]));
	ops[PHANTOM_ARITH_FIXED] = &phantom_float_fixed;
	if (isa == PHANTOM_ISA_DOUBLE)
		ops[PHANTOM_ARITH_DOUBLE] = &phantom_float_double;
	if (isa == PHANTOM_ISA_FIXED)
		return -EINVAL;
	for (; *have && !ops[PHANTOM_ARITH_FLOAT]; have++)
		if (best || (*have)->isa == isa)
			ops[PHANTOM_ARITH_FLOAT] = *have;
	return ops[PHANTOM_ARITH_FLOAT] ? 0 : -EINVAL;
}

static struct phantom_clock *um_clock_init(struct phantom_um *machine,
					   const struct phantom_um_config *config)
{
	machine->clock_kind = config->clock;
	if (config->clock == PHANTOM_UM_CLOCK_VIRTUAL) {
		phantom_virtual_clock_init(&machine->clock.virtual);
		return &machine->clock.virtual.clock;
	}
	phantom_real_clock_init(&machine->clock.real, config->cpu);
	return &machine->clock.real.clock;
}

static void um_clock_destroy(struct phantom_um *machine)
{
	if (machine->clock_kind == PHANTOM_UM_CLOCK_VIRTUAL)
		phantom_virtual_clock_destroy(&machine->clock.virtual);
	else
		phantom_real_clock_destroy(&machine->clock.real);
}

static int um_init(struct phantom_um *machine, const struct phantom_um_config *config)
{
	const struct phantom_float_ops *ops[PHANTOM_ARITHS];
	u32 force = config->max_force_un ? config->max_force_un : USERMODE_FORCE_DEFAULT_UN;
	u32 patches = config->patches_max ? config->patches_max : PHANTOM_PATCHES_MAX;
	struct phantom_clock *clock;
	int error;

	if (config->clock > PHANTOM_UM_CLOCK_VIRTUAL)
		return -EINVAL;
	error = um_choose_ops(config->isa, ops);
	if (error)
		return error;
	error = um_device_init(machine, force);
	if (error)
		return error;
	clock = um_clock_init(machine, config);
	error = phantom_servo_init(&machine->servo, clock, &machine->device.device, ops, patches);
	if (error)
		goto no_servo;
	mutex_lock(&machine->servo.control);
	error = config->rate_hz ? phantom_servo_set_rate(&machine->servo, config->rate_hz) : 0;
	mutex_unlock(&machine->servo.control);
	if (error)
		goto no_rate;
	phantom_chardev_init(&machine->chardev, &machine->servo);
	return 0;

no_rate:
	phantom_platform_wait_destroy(&machine->servo.wait);
	phantom_servo_destroy(&machine->servo);
no_servo:
	um_clock_destroy(machine);
	machine->device.behind->ops->destroy(machine->device.behind);
	return error;
}

struct phantom_um *phantom_um_create(const struct phantom_um_config *config, int *error)
{
	struct phantom_um *machine = kzalloc(sizeof(*machine), GFP_KERNEL);
	int result = machine ? um_init(machine, config) : -ENOMEM;

	if (error)
		*error = result;
	if (!result)
		return machine;
	kfree(machine);
	return NULL;
}

void phantom_um_destroy(struct phantom_um *machine)
{
	if (!machine)
		return;
	phantom_platform_wait_destroy(&machine->servo.wait);
	phantom_servo_destroy(&machine->servo);
	um_clock_destroy(machine);
	machine->device.behind->ops->destroy(machine->device.behind);
	kfree(machine);
}

int phantom_um_step(struct phantom_um *machine, uint32_t ticks)
{
	if (machine->clock_kind != PHANTOM_UM_CLOCK_VIRTUAL)
		return -EINVAL;
	return phantom_virtual_clock_step(&machine->clock.virtual, ticks);
}

int phantom_um_set_time(struct phantom_um *machine, uint64_t now_ns)
{
	if (machine->clock_kind != PHANTOM_UM_CLOCK_VIRTUAL)
		return -EINVAL;
	phantom_virtual_clock_set(&machine->clock.virtual, now_ns);
	return 0;
}

int phantom_um_replay(struct phantom_um *machine, const struct phantom_tick *record,
		      uint64_t due_ns)
{
	struct phantom_um_device *device = &machine->device;
	struct phantom_servo *servo = &machine->servo;
	int error = record->faults & PHANTOM_FAULT_DEVICE ? -EIO : -ENODEV;
	s64 tip_nm[3];
	int result;

	if (machine->clock_kind != PHANTOM_UM_CLOCK_VIRTUAL)
		return -EINVAL;
	memcpy(tip_nm, record->tip_nm, sizeof(tip_nm));
	um_device_move(&device->device, tip_nm);
	WRITE_ONCE(device->error, record->flags & PHANTOM_TICK_UNREAD ? error : 0);
	WRITE_ONCE(device->write_error, record->flags & PHANTOM_TICK_UNSENT ? error : 0);
	if (record->flags & PHANTOM_TICK_CLEARED)
		smp_store_release(&servo->clear_wanted, 1U);
	if (record->flags & PHANTOM_TICK_ABANDONED)
		smp_store_release(&servo->stop_wanted, PHANTOM_WISH_ABANDON);
	else if (record->flags & PHANTOM_TICK_STOPPED)
		smp_store_release(&servo->stop_wanted, PHANTOM_WISH_STOP);
	result = phantom_virtual_clock_replay(&machine->clock.virtual, record->tick,
					      record->time_ns, due_ns);
	servo->busy_ns = record->duration_ns;
	WRITE_ONCE(device->error, 0);
	WRITE_ONCE(device->write_error, 0);
	return result;
}

void phantom_um_thread(const struct phantom_um *machine, struct phantom_um_thread_info *info)
{
	bool real = machine->clock_kind == PHANTOM_UM_CLOCK_REAL;

	info->fifo = real ? READ_ONCE(machine->clock.real.fifo) : 0;
	info->cpu = real && machine->clock.real.cpu >= 0 ? machine->clock.real.cpu : -1;
}

void phantom_um_suspend(struct phantom_um *machine)
{
	mutex_lock(&machine->servo.control);
	phantom_servo_suspend(&machine->servo);
	mutex_unlock(&machine->servo.control);
}

int phantom_um_resume(struct phantom_um *machine)
{
	int error;

	mutex_lock(&machine->servo.control);
	error = phantom_servo_resume(&machine->servo);
	mutex_unlock(&machine->servo.control);
	return error;
}

void phantom_um_inject_stall(struct phantom_um *machine, uint64_t ns)
{
	if (machine->clock_kind == PHANTOM_UM_CLOCK_REAL)
		xchg(&machine->clock.real.stall_ns, ns);
	else
		xchg(&machine->clock.virtual.stall_ns, ns);
}

void phantom_um_inject_device_error(struct phantom_um *machine, int error)
{
	WRITE_ONCE(machine->device.error, error);
}

/* ---- files --------------------------------------------------------------- */

struct phantom_um_file *phantom_um_open(struct phantom_um *machine, int flags, int *error)
{
	bool feeding = (flags & O_ACCMODE) != O_RDONLY;
	struct phantom_um_file *file = kzalloc(sizeof(*file), GFP_KERNEL);
	int result = file ? 0 : -ENOMEM;

	if (file) {
		file->machine = machine;
		file->nonblocking = flags & O_NONBLOCK;
		file->users = 1;
		file->file = phantom_chardev_open(&machine->chardev, feeding);
		if (IS_ERR(file->file)) {
			result = (int)PTR_ERR(file->file);
			kfree(file);
			file = NULL;
		}
	}
	if (error)
		*error = result;
	return file;
}

static void um_get(struct phantom_um_file *file)
{
	__atomic_add_fetch(&file->users, 1, __ATOMIC_RELAXED);
}

static void um_put(struct phantom_um_file *file)
{
	if (__atomic_sub_fetch(&file->users, 1, __ATOMIC_ACQ_REL))
		return;
	phantom_chardev_release(file->file);
	if (file->view)
		phantom_platform_unshare(file->view, phantom_stats_page_size());
	kfree(file);
}

int phantom_um_close(struct phantom_um_file *file)
{
	um_put(file);
	return 0;
}

int phantom_um_ioctl(struct phantom_um_file *file, unsigned long request, void *argument)
{
	long result;

	um_get(file);
	result = request > U32_MAX
			 ? -ENOTTY
			 : phantom_chardev_ioctl(file->file, (unsigned int)request, argument);
	um_put(file);
	return (int)result;
}

ssize_t phantom_um_read(struct phantom_um_file *file, void *buffer, size_t size)
{
	ssize_t result;

	um_get(file);
	result = phantom_chardev_read(file->file, buffer, size, file->nonblocking);
	um_put(file);
	return result;
}

const struct phantom_status *phantom_um_mmap(struct phantom_um_file *file, int *error)
{
	u32 size = phantom_stats_page_size();
	const void *view = __atomic_load_n(&file->view, __ATOMIC_ACQUIRE);
	const void *none = NULL;

	if (!view) {
		view = phantom_platform_view(file->machine->servo.stats.page, size);
		if (view && !__atomic_compare_exchange_n(&file->view, &none, view, false,
							 __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE)) {
			phantom_platform_unshare(view, size);
			view = none;
		}
	}
	if (error)
		*error = view ? 0 : -ENOMEM;
	return view;
}

int phantom_um_poll(struct phantom_um_file *file, short events, int timeout_ms)
{
	wait_queue_head_t *wait = &file->machine->servo.wait;
	u64 deadline = timeout_ms < 0 ? U64_MAX : ktime_get_ns() + (u64)timeout_ms * NSEC_PER_MSEC;
	bool in_time = true;
	unsigned int mask;

	um_get(file);
	phantom_platform_wait_begin(wait);
	for (;;) {
		mask = phantom_chardev_poll(file->file) & (unsigned short)events;
		if (mask || !in_time)
			break;
		in_time = phantom_platform_wait(wait, deadline);
	}
	phantom_platform_wait_end(wait);
	um_put(file);
	return (int)mask;
}
