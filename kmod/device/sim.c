// SPDX-License-Identifier: GPL-2.0-only
/*
 * sim.c - the simulated device: the tip is where PHANTOM_SIM_MOVE put it last, the force goes
 * nowhere. Its numbers are those of a desktop arm, with a cube of 200 mm to work in.
 */
#include <phantom_platform.h>
#include "device/mailbox.h"
#include "device/phantom_device.h"

#define PHANTOM_SIM_WORKSPACE_NM 100000000 /* +-100 mm */
#define PHANTOM_SIM_RESOLUTION_NM 1

struct phantom_sim {
	struct phantom_device device;
	struct mutex moving; /* makes the movers one writer of the mailbox */
	struct phantom_mailbox tip;
};

static struct phantom_sim *phantom_sim_of(struct phantom_device *device)
{
	return container_of(device, struct phantom_sim, device);
}

static int phantom_sim_start(struct phantom_device *device)
{
	return 0;
}

static void phantom_sim_stop(struct phantom_device *device)
{
}

static int phantom_sim_read(struct phantom_device *device, s64 tip_nm[3])
{
	phantom_mailbox_read(&phantom_sim_of(device)->tip, tip_nm);
	return 0;
}

static int phantom_sim_write(struct phantom_device *device, const s32 force_un[3])
{
	return 0;
}

static void phantom_sim_move(struct phantom_device *device, const s64 tip_nm[3])
{
	struct phantom_sim *sim = phantom_sim_of(device);

	mutex_lock(&sim->moving);
	phantom_mailbox_post(&sim->tip, tip_nm);
	mutex_unlock(&sim->moving);
}

static void phantom_sim_destroy(struct phantom_device *device)
{
	struct phantom_sim *sim = phantom_sim_of(device);

	mutex_destroy(&sim->moving);
	kfree(sim);
}

static const struct phantom_device_ops phantom_sim_ops = {
	.name = "sim",
	.kind = PHANTOM_DEVICE_SIM,
	.start = phantom_sim_start,
	.stop = phantom_sim_stop,
	.read = phantom_sim_read,
	.write = phantom_sim_write,
	.move = phantom_sim_move,
	.destroy = phantom_sim_destroy,
};

struct phantom_device *phantom_device_sim_create(u32 max_force_un)
{
	struct phantom_sim *sim;
	int axis;

	if (!max_force_un || max_force_un > PHANTOM_DEVICE_FORCE_MAX_UN)
		return ERR_PTR(-EINVAL);
	sim = kzalloc(sizeof(*sim), GFP_KERNEL);
	if (!sim)
		return ERR_PTR(-ENOMEM);
	mutex_init(&sim->moving);
	phantom_mailbox_init(&sim->tip, sizeof(s64[3]));
	sim->device.ops = &phantom_sim_ops;
	sim->device.model = "simulated";
	for (axis = 0; axis < 3; axis++) {
		sim->device.workspace_min_nm[axis] = -PHANTOM_SIM_WORKSPACE_NM;
		sim->device.workspace_max_nm[axis] = PHANTOM_SIM_WORKSPACE_NM;
	}
	sim->device.max_force_un = max_force_un;
	sim->device.resolution_nm = PHANTOM_SIM_RESOLUTION_NM;
	return &sim->device;
}
