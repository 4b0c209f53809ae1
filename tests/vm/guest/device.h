// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * device.h - what every test does with /dev/phantom_rt0: open, call, look at the status page, submit a
 * flat plate, move the simulated tip. A failure in here fails the test.
 */
#ifndef VM_DEVICE_H
#define VM_DEVICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "phantom_abi.h"

#define VM_NS_PER_MS 1000000ull
#define VM_NS_PER_S 1000000000ull

uint64_t vm_now_ns(void);
void vm_sleep_ns(uint64_t ns);

/* ---- calls ---- */

/* A file, or -errno. */
int vm_try_open(int flags);
int vm_open(int flags);
/* The feeder, with every setting at its default: 1 kHz, no latched fault. */
int vm_open_feeder(void);
/* What the ioctl returns, or -errno. */
int vm_ioctl(int fd, unsigned long request, const void* argument);
/* Fails the test unless the call gives exactly that (0 or -errno). */
void vm_expect(int fd, unsigned long request, const void* argument, int expected, const char* what);
const char* vm_error_name(int error);

/* The rate, or the highest that a kernel slow by its own checks has time for (vm.most_hz=). */
uint32_t vm_rate(uint32_t rate_hz);
void vm_set_rate(int fd, uint32_t rate_hz);
/* Starts with sets that do not go stale within the test; all other limits at their defaults. */
void vm_start(int fd);
void vm_move(int fd, int64_t x_nm, int64_t y_nm, int64_t z_nm);

/* ---- status page ---- */

/* Bytes to map. */
size_t vm_status_size(int fd);
const struct phantom_status* vm_map(int fd);
/* A consistent copy of what stands before the histograms; those too, but for a tick. */
void vm_status(const struct phantom_status* page, struct phantom_status* copy);
uint32_t vm_state(const struct phantom_status* page);
/* Waits until the tick counter has gone that far; fails after five seconds. */
void vm_wait_ticks(const struct phantom_status* page, uint64_t ticks);
/* Waits for a state; fails after five seconds. */
void vm_wait_state(const struct phantom_status* page, uint32_t state);
int64_t vm_force_size(const int32_t force_un[3]);

/* ---- the plate ---- */

/*
 * A square in z = 0, 40 mm wide, normal +z, of 32 triangles with their neighbours, k = 1 N/mm,
 * R = 2 mm. It promises to be the whole scene. With the tip at height h above its middle part:
 *
 *     F = k (R - h) z  for -R' < h < R,   zero above R        (h < 0: below the surface, held by the proxy)
 */
#define VM_PLATE_CELLS 4
#define VM_PLATE_PATCHES (2 * VM_PLATE_CELLS * VM_PLATE_CELLS)
#define VM_PLATE_STIFFNESS 1000 /* mN/mm = uN/um */
#define VM_PLATE_RADIUS_NM 2000000
#define VM_PLATE_HALF_NM 20000000

struct vm_plate {
    struct phantom_set set;
    struct phantom_patch patches[VM_PLATE_PATCHES];
    struct phantom_material material;
    struct phantom_object object;
};

/* The set's pointers lead into *plate, which must stay where it is. */
void vm_plate_make(struct vm_plate* plate, uint64_t id);
void vm_plate_submit(int fd, uint64_t id);
/* uN along z at that height. */
int64_t vm_plate_force(int64_t height_nm);

/*
 * Feeder in contact: plate submitted, tip 1 mm above a triangle near its middle, started, full force reached.
 * The force is then 1 N along +z.
 */
#define VM_CONTACT_HEIGHT_NM 1000000
void vm_touch(int fd, const struct phantom_status* page);

#endif /* VM_DEVICE_H */
