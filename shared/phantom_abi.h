/* SPDX-License-Identifier: GPL-2.0-only WITH Linux-syscall-note */
/*
 * phantom_abi.h - the user API of phantom_rt.ko, and of its user-mode build.
 *
 * WHAT IT IS
 *   A fast task (the servo tick, 1 ... 10 kHz) turns the position of the tip of a
 *   haptic device into a force, from a small set of triangles. A slow task in user
 *   space (the feeder, some 100 Hz) knows the whole scene and keeps choosing that
 *   set. This header is everything that the two share.
 *
 * LIFE CYCLE
 *   fd = open("/dev/phantom_rt0", O_RDWR)       the feeder; one at a time
 *   ioctl(fd, PHANTOM_GET_INFO, &info)          check abi_version and features
 *   status = mmap(NULL, info.status_size, PROT_READ, MAP_SHARED, fd, 0)
 *   ioctl(fd, PHANTOM_SET_RATE, &rate)          optional, at any time
 *   ioctl(fd, PHANTOM_SET_MODEL, &model)        optional, at any time
 *   ioctl(fd, PHANTOM_SUBMIT_SET, &set)         at least one set before there is force
 *   ioctl(fd, PHANTOM_START, &start)            the force ramps up
 *   loop: poll(fd, POLLPRI), query the scene round status->tip_nm, PHANTOM_SUBMIT_SET
 *   ioctl(fd, PHANTOM_STOP, NULL)               the force ramps down, then the tick ends
 *   close(fd)                                   implies STOP, also when the feeder is killed; the force
 *                                               is zero within PHANTOM_FADE_NS whatever start.ramp_ms
 *   An observer opens O_RDONLY, as many as like: GET_INFO, mmap, poll and read only.
 *
 * STATES
 *
 *            START                     a fault
 *     IDLE --------> RUNNING ---------------------------> FAULT
 *      ^  <--------    |  ^  <--------------------------   |
 *      |   STOP/close  |  |   CLEAR_FAULT (ramps up)       |
 *      +-----------------------------------------------------+ STOP, close
 *
 *   IDLE     no tick, zero force.
 *   RUNNING  the tick runs. Force is given where a set covers the tip.
 *   FAULT    the tick still runs and reports, the force is zero. Latched: only
 *            CLEAR_FAULT, or STOP followed by CLEAR_FAULT, ends it.
 *
 *   When the machine goes to sleep (suspend, hibernation) a run's force ramps down within
 *   PHANTOM_FADE_NS, the device is switched off and PHANTOM_FAULT_SUSPENDED is latched; no tick
 *   runs. When it wakes up the ticks go on without a missed one, in FAULT: nobody's arm jumps.
 *   Steps of the wall clock change nothing: all times are CLOCK_MONOTONIC.
 *
 * UNITS
 *   Everything is an integer in an SI unit; no float crosses this border.
 *     position, length   nm; __s32 relative to the set's origin, __s64 absolute
 *     unit vector        Q1.30: 1.0 is 1 << 30
 *     force              uN (micronewton), __s32
 *     stiffness          mN/mm (= N/m), __u32
 *     damping            mN*s/m, __u32
 *     velocity           nm/s, __s32 (saturates at +-2.1 m/s in the status page)
 *     angular velocity   urad/s, __s32
 *     rotation           Q1.30 quaternion w x y z, of unit length
 *     time               ns, CLOCK_MONOTONIC, __u64; durations in ns, __u32 (saturating)
 *   Conversions saturate, never wrap, and are counted (status->saturated).
 *
 * COVERAGE
 *   A set promises: every triangle of the scene within radius_nm of centre_nm is in it, and every rim
 *   within R of those that are. Outside
 *   the surface the tick needs coverage of the ball of the set's largest contact radius round the
 *   tip; inside it needs tip and proxy covered. Where the promise does not reach, no force is
 *   computed from the part that is there: the last force fades to zero within PHANTOM_FADE_NS,
 *   PHANTOM_TICK_UNCOVERED is set and poll() reports POLLPRI. The same holds for a set that is
 *   older than start.stale_ms (counted from the tick that took it): set a new one at least that
 *   often. A tip more than 1.147 m (2^31 - 1 nm less 1 m) from the origin along an axis is not
 *   covered, and a radius of more than 2 m counts as 2 m.
 *   A swap between two sets that both cover the tip changes the force by rounding only. The force
 *   also fades, from what it is to what it shall be, when coverage comes back, the model changes, or
 *   a set without patches follows one with.
 *   An uncovered tip keeps its state (inside, proxy) for PHANTOM_MEMORY_NS. Covered again in
 *   time, it is looked for on the straight path from where it was last covered, and found inside
 *   when that crossed the surface. After longer it counts as outside: no force until it has left
 *   the surface by itself.
 *
 * OTHER GEOMETRY
 *   A set whose level is not that of the set before, or that knows an object by another revision,
 *   has other triangles where the same surface was: face numbers mean nothing across such a change.
 *   The force goes over to the new surface within start.crossfade_ms, and follows the tip on it from
 *   the first tick on. A proxy is carried to the new surface, along its normal or, from a crease,
 *   beside it, by up to the sum of the two levels' errors, or the set's largest contact radius where
 *   the surface itself moved: so far may a surface rise from one set to the next and still be felt
 *   by a tip that touches it or is below it. One that sinks below the tip lets it go.
 *
 * MOVING OBJECTS
 *   An object with PHANTOM_OBJECT_MOVES has a frame of its own: its patches, relative to its origin_nm,
 *   and its origin_nm are in that frame. translation_nm and rotation_q30 say where the frame was in
 *   the scene at set.time_ns: a point x of it at translation + rotation x. From then on the tick lets
 *   the frame's origin go straight on by velocity_nm_s and turns the frame round it by
 *   angular_velocity_urad_s, both in the scene's axes, until the next set, for PHANTOM_MOTION_MAX_NS at
 *   most. So the frame of a turntable best has its origin on the axis: what goes round in a circle
 *   leaves a straight line by r w^2 dt^2 / 2. Where the next set says otherwise, the frame goes over
 *   to the new pose in the time between the two, PHANTOM_FADE_NS at most, and no force steps. A pose
 *   that would move the surface by more than PHANTOM_MOTION_JUMP_NM at the tip, or turn it by more
 *   than 0.2 rad, is a jump: what touched the object is forgotten and the force fades.
 *   Contact, proxy, friction and texture belong to the frame and move with it; damping and friction
 *   know the velocity against the surface. A tip that rests is found by a surface that comes over it.
 *   Contacts with several frames, and the scene that rests, add up; proxy and normal of status and
 *   records are those of the frame that pushes most, in the scene.
 *   COVERAGE goes along: radius_nm round the centre where it was in the frame at set.time_ns. A tip
 *   that leaves it, because either moves, is uncovered. Only objects in the set can get so: name each
 *   that may come near before the next set, with or without patches. A tip more than 4 m from a
 *   frame's origin along an axis is not covered.
 *   An object that gains or loses the flag is another object: the force fades over to it.
 *
 * EFFECTS
 *   What a surface feels like beyond contact, and what acts in free space. A material names the
 *   effects of its surface (PHANTOM_EFFECTS_SURFACE), a set itself those of space
 *   (PHANTOM_EFFECTS_SPACE); set.effects is the union, and the tick runs these and no others. Damping
 *   has its parameter in the material. Every other effect has a table, which is there only if the
 *   effect is named. Tables follow the materials in memory, in the order of the effects' bits,
 *   without gaps, set.effect_bytes in all:
 *     surface         its struct once for each material that names it, in the materials' order;
 *                     each phantom_height_map is followed by its samples
 *     CONSTANT, TIP   its struct
 *     VISCOSITY, GUIDE  struct phantom_effect_count, then its struct that many times
 *     FIELD           its struct, then its nodes
 *   Law, source, energy and limits of each stand in kmod/float/effects/. Surface effects act where
 *   there is contact, those of space wherever the set covers the tip, which takes no patches. All of
 *   them fade as contact does; and where a set's effects or tables are not those of the set before
 *   it, the force goes over to the new ones within PHANTOM_FADE_NS.
 *   TIP makes a ball of the tip, for contact only: tip_nm is its centre. Every material's contact
 *   radius R counts as R + radius_nm, here and wherever this header says R, but for magnet.range_nm's
 *   limit. So the force is k (R + radius - d) at a distance d of the centre: what a point feels at d
 *   the ball feels when its surface is there, as stiff. Coverage must reach that much farther; the
 *   tip counts as inside when the ball's centre is. Two places of a hollow that is narrower than the
 *   ball are contacts of their own, added as the model adds them.
 *
 * POLL
 *   POLLIN    a record can be read, or the end of a run has not yet been read.
 *   POLLPRI   a set is wanted, or a fault came. A set is wanted when the tip gets uncovered or the
 *             set stale (again every PHANTOM_REMIND_NS while that lasts, and after each new
 *             set that does not help), and once a set when a tip outside has used up half of its
 *             slack, the radius less the largest contact radius. It stays until this file
 *             answers: SUBMIT_SET and CLEAR_FAULT of the feeder and read() of anyone do.
 *   POLLHUP | POLLERR   the device was unplugged.
 *
 * UNPLUGGED
 *   The node goes; files that are open stay. A run latches PHANTOM_FAULT_UNPLUGGED, its force is
 *   zero, and it ends by itself, in state FAULT. Every call answers ENODEV, read() after the records
 *   that are left; mappings can be read on and show the last tick. Close the file: the arm plugged
 *   in again is a new device, under another number while the old one is held.
 *
 * RULES
 *   Fields are __u32, __s32, __u64 and __s64 only; sizes are multiples of 8, the same for 32
 *   and 64 bit callers; pointers are carried in __u64. Reserved fields and unknown flag
 *   bits must be zero. New behaviour comes as a new ioctl number or a new feature bit.
 *
 * CALL -> ERRORS -> WHY
 *   open          EBUSY    O_RDWR (or O_WRONLY) and there is a feeder already
 *                 ENODEV   the device is gone
 *   any ioctl     ENOTTY   unknown number
 *                 EFAULT   the argument or a pointer in it cannot be read or written
 *                 EBADF    needs O_RDWR (all but GET_INFO)
 *                 ENODEV   the device was unplugged
 *   SET_RATE      EINVAL   not within rate_min_hz ... rate_max_hz; reserved not zero
 *   SET_MODEL     EINVAL   unknown value, newton_steps > 3; reserved not zero
 *                 EOPNOTSUPP  a known value that info.features does not offer
 *   START         EBUSY    not IDLE, or the machine is about to sleep
 *                 EIO      a latched fault: CLEAR_FAULT first
 *                 EINVAL   a force above the device's, ramp_ms or crossfade_ms >
 *                          PHANTOM_RAMP_MAX_MS, unknown flag
 *                 ENODEV   there is no device
 *                 ETIMEDOUT  the device does not answer
 *                 EPERM    PHANTOM_START_LIMITS_OFF on a device that is not simulated
 *   STOP          (none)   IDLE already: nothing to do, returns 0
 *   SUBMIT_SET    EINVAL   counts over the limits, an index out of range, id 0 or not larger
 *                          than the last one since open(), unknown flag, effect or kind, effects
 *                          that are not the union of the materials', those of space and TIP, a space
 *                          effect in a material, damping without its effect, effect_bytes that
 *                          is not the length of the tables the effects call for, a parameter
 *                          beyond what its struct says,
 *                          a normal or rotation that is not of unit length to 2^-10, an object
 *                          that rests with a pose that is not the identity, a velocity or an origin,
 *                          more than PHANTOM_MOVING_MAX that move, one that turns faster than
 *                          PHANTOM_OBJECT_TURN_MAX_URAD_S, its origin beyond +-PHANTOM_OBJECT_REACH_NM or
 *                          its translation beyond PHANTOM_POSITION_MAX_NM, a face after a fan patch,
 *                          a face or fan after a rim, a fan or rim whose corners do not coincide as
 *                          its kind says, or that has a face number or neighbours, a rim of surface
 *                          0, a
 *                          neighbour that is no face or in another frame, an object number twice,
 *                          reserved not zero, radius 0 in a material, vertices or centre
 *                          beyond +-1 m of the origin, the origin beyond
 *                          PHANTOM_POSITION_MAX_NM
 *                 ENOMEM   no memory (the first sets after open, after a change of arithmetic, with
 *                          longer tables or more moving objects only; memory is reused). The set in
 *                          use stays
 *                 EAGAIN   every slot is in use: try again next tick
 *   SIM_MOVE      EOPNOTSUPP  the device is not simulated
 *                 EINVAL   beyond PHANTOM_POSITION_MAX_NM, reserved not zero
 *   CLEAR_FAULT   EAGAIN   the cause is still there (asleep counts)
 *                 (0 when no fault is latched; else the next tick clears, and ramps up)
 *   mmap          EPERM    writable or executable; EINVAL: offset not 0 or too long
 *   read          EINVAL   the buffer is smaller than one record
 *                 EFAULT   not even one record could be written
 *                 EAGAIN   O_NONBLOCK and no record
 *                 ENODEV   the device was unplugged, and no record is left
 *                 0        no record, and the tick is not running (end of recording)
 *                 Whole records, from open() on, each file at its own pace. A reader that lags by
 *                 more than some thousand loses the oldest: its records then have a gap in
 *                 phantom_tick.tick that status->missed does not account for, and status->lost
 *                 counts them
 */
#ifndef PHANTOM_ABI_H
#define PHANTOM_ABI_H

#include <linux/ioctl.h>
#include <linux/types.h>

#define PHANTOM_ABI_VERSION 1

/*
 * The first node; phantom_rt1 and so on are further devices. phantom0 belongs to the mainline driver
 * drivers/misc/phantom.c.
 */
#define PHANTOM_DEVICE_NODE "/dev/phantom_rt0"

/* ---- limits -------------------------------------------------------------- */
#define PHANTOM_PATCHES_MAX 512 /* patches in a set */
#define PHANTOM_MATERIALS_MAX 16 /* materials in a set */
#define PHANTOM_OBJECTS_MAX 16 /* objects in a set */
#define PHANTOM_MOVING_MAX 3 /* of them with PHANTOM_OBJECT_MOVES */
#define PHANTOM_RATE_MIN_HZ 1000
#define PHANTOM_RATE_MAX_HZ 10000
#define PHANTOM_NEWTON_STEPS_MAX 3
#define PHANTOM_COORDINATE_MAX_NM 1000000000 /* +-1 m round a set's origin */
#define PHANTOM_POSITION_MAX_NM 1000000000000000000LL /* absolute positions: +-1e9 m */
#define PHANTOM_RAMP_MAX_MS 10000
#define PHANTOM_FADE_NS 20000000 /* force fades to zero, or to another set, in 20 ms */
#define PHANTOM_MEMORY_NS 100000000 /* an uncovered tip keeps `inside` and proxy this long */
#define PHANTOM_REMIND_NS 4000000 /* while a set is needed, POLLPRI comes again this often */
#define PHANTOM_MOTION_MAX_NS 1000000000 /* a moving object stops that long after set.time_ns */
#define PHANTOM_MOTION_JUMP_NM 10000000 /* a pose farther off than 10 mm at the tip is a jump */
#define PHANTOM_OBJECT_REACH_NM                                                                    \
	2000000000 /* origin_nm of a moving object, in its frame, per axis */
#define PHANTOM_OBJECT_TURN_MAX_URAD_S 100000000 /* 100 rad/s, all axes together */

/* ---- unit vectors -------------------------------------------------------- */
#define PHANTOM_Q30_ONE (1 << 30)

/* ---- features (info.features) -------------------------------------------- */
#define PHANTOM_FEATURE_MODEL_PAPER (1ULL << 0)
#define PHANTOM_FEATURE_MODEL_PROJECTED (1ULL << 1)
#define PHANTOM_FEATURE_PROXY_PAPER (1ULL << 2)
#define PHANTOM_FEATURE_PROXY_CONSTRAINED (1ULL << 3)
#define PHANTOM_FEATURE_ARITH_FLOAT (1ULL << 4)
#define PHANTOM_FEATURE_ARITH_FIXED (1ULL << 5)
#define PHANTOM_FEATURE_ARITH_DOUBLE (1ULL << 6) /* user mode only */
#define PHANTOM_FEATURE_MOVING_OBJECTS (1ULL << 7) /* PHANTOM_OBJECT_MOVES */
#define PHANTOM_FEATURE_SIM_MOVE (1ULL << 8)
#define PHANTOM_FEATURE_FANS (1ULL << 9) /* patches of kind EDGE and CORNER */
#define PHANTOM_FEATURE_CROSSFADE (1ULL << 10) /* start.crossfade_ms; without it that must be 0 */
/* patches of kind RIM, and patch.surface; without it that must be 0 */
#define PHANTOM_FEATURE_RIMS (1ULL << 11)

/* ---- effects (material.effects, set.effects): EFFECTS above --------------- */
#define PHANTOM_EFFECT_DAMPING (1U << 0) /* normal damping; never pulls */
#define PHANTOM_EFFECT_MAGNET (1U << 1) /* struct phantom_magnet */
#define PHANTOM_EFFECT_FRICTION (1U << 2) /* struct phantom_friction */
#define PHANTOM_EFFECT_TEXTURE (1U << 3) /* struct phantom_texture */
#define PHANTOM_EFFECT_HEIGHT_MAP (1U << 4) /* struct phantom_height_map */
#define PHANTOM_EFFECT_IMPACT (1U << 5) /* struct phantom_impact */
#define PHANTOM_EFFECT_CONSTANT (1U << 16) /* struct phantom_constant */
#define PHANTOM_EFFECT_VISCOSITY (1U << 17) /* struct phantom_viscosity */
#define PHANTOM_EFFECT_GUIDE (1U << 18) /* struct phantom_guide */
#define PHANTOM_EFFECT_FIELD (1U << 19) /* struct phantom_field */
#define PHANTOM_EFFECT_TIP (1U << 24) /* struct phantom_tip; of the set, and nowhere a force */
#define PHANTOM_EFFECTS_SURFACE                                                                    \
	(PHANTOM_EFFECT_DAMPING | PHANTOM_EFFECT_MAGNET | PHANTOM_EFFECT_FRICTION |                \
	 PHANTOM_EFFECT_TEXTURE | PHANTOM_EFFECT_HEIGHT_MAP | PHANTOM_EFFECT_IMPACT)
#define PHANTOM_EFFECTS_SPACE                                                                      \
	(PHANTOM_EFFECT_CONSTANT | PHANTOM_EFFECT_VISCOSITY | PHANTOM_EFFECT_GUIDE |               \
	 PHANTOM_EFFECT_FIELD)
#define PHANTOM_EFFECTS_KNOWN (PHANTOM_EFFECTS_SURFACE | PHANTOM_EFFECTS_SPACE | PHANTOM_EFFECT_TIP)

#define PHANTOM_EFFECT_BYTES_MAX 131072 /* of a set's tables */
#define PHANTOM_REGIONS_MAX 8 /* in each of the tables VISCOSITY and GUIDE */
#define PHANTOM_EFFECT_FORCE_MAX_UN 100000000 /* 100 N */
#define PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM 100000 /* 100 N/mm */
#define PHANTOM_EFFECT_REACH_MAX_NM 4000000000LL /* from a set's origin to a place, per axis */
#define PHANTOM_FRICTION_MAX_PPM 4000000 /* coefficient 4 */
#define PHANTOM_FRICTION_SPEED_MAX_UM_S 1000000
#define PHANTOM_WAVE_MAX_PER_KM 100000000 /* 10 um from crest to crest, per axis */
#define PHANTOM_WAVE_SLOPE_MAX 159154943091LL /* 1e12 / (2 pi): a slope of 1 */
#define PHANTOM_VISCOSITY_MAX_MNS_M 20000 /* 20 N s/m: stable at 1 kHz from 20 g on */
#define PHANTOM_DRAG_MAX_MNS2_M2 1000000
#define PHANTOM_BORDER_MIN_NM 100000 /* 0.1 mm */
#define PHANTOM_MAP_SIZE_MIN 4 /* samples of a height map, each way */
#define PHANTOM_MAP_SIZE_MAX 64
#define PHANTOM_MAP_SPACING_MIN_NM 10000 /* 10 um from sample to sample */
#define PHANTOM_IMPACT_FREQUENCY_MIN_HZ 10
#define PHANTOM_IMPACT_FREQUENCY_MAX_HZ 1000
#define PHANTOM_IMPACT_DECAY_MIN_US 1000
#define PHANTOM_IMPACT_DECAY_MAX_US 500000
#define PHANTOM_IMPACT_GAIN_MAX_MNS_M_PER_HZ 125 /* a / (2 pi f) at most 20 g */
#define PHANTOM_FIELD_NODES_MAX 4096
#define PHANTOM_FIELD_SPACING_MIN_NM 100000 /* 0.1 mm from node to node */
#define PHANTOM_TIP_RADIUS_MAX_NM 50000000 /* 50 mm */

/* ---- model (CONTACT: contact, combination, proxy, arithmetic) ------------ */
#define PHANTOM_MODEL_OFF 0 /* the tick runs, the force is zero */
#define PHANTOM_MODEL_PAPER 1 /* Kabelac 2001, Algorithm 1 */
#define PHANTOM_MODEL_PROJECTED 2 /* signed shell projection; the default */

#define PHANTOM_COMBINE_PAPER 0 /* F = S max|s| / |S| */
#define PHANTOM_COMBINE_BOUNDED 1 /* F = S min(1, max|s| / |S|); the default */

#define PHANTOM_PROXY_OFF 0 /* shell only: the tip falls through below the surface */
#define PHANTOM_PROXY_PAPER 1
#define PHANTOM_PROXY_CONSTRAINED 2

#define PHANTOM_ARITH_FLOAT 0
#define PHANTOM_ARITH_FIXED 1
#define PHANTOM_ARITH_DOUBLE 2
#define PHANTOM_ARITHS 3

/* ---- devices ------------------------------------------------------------- */
#define PHANTOM_DEVICE_NONE 0
#define PHANTOM_DEVICE_SIM 1
#define PHANTOM_DEVICE_HID 2
#define PHANTOM_DEVICE_PCI 3

/* ---- instruction sets of the float sections (status.isa) ----------------- */
#define PHANTOM_ISA_NONE 0
#define PHANTOM_ISA_SSE2 1
#define PHANTOM_ISA_AVX2 2
#define PHANTOM_ISA_DOUBLE 3 /* user mode only */
#define PHANTOM_ISA_AVX512 4 /* user mode only */
#define PHANTOM_ISA_FIXED 5 /* no float at all: integers */

/* ---- states and faults --------------------------------------------------- */
#define PHANTOM_STATE_IDLE 0
#define PHANTOM_STATE_RUNNING 1
#define PHANTOM_STATE_FAULT 2

#define PHANTOM_FAULT_DEVICE (1U << 0) /* reading or writing the device failed */
#define PHANTOM_FAULT_OVERSPEED (1U << 1) /* the tip moved faster than start.max_speed_um_s */
/* a tick came later than start.stall_us, or for ten times that long it skipped periods or only computed */
#define PHANTOM_FAULT_STALL (1U << 2)
#define PHANTOM_FAULT_NUMERIC (1U << 3) /* a float section gave a value that is no number */
#define PHANTOM_FAULT_UNPLUGGED (1U << 4)
#define PHANTOM_FAULT_SUSPENDED (1U << 5) /* the machine went to sleep during the run */

/* GET_INFO. Written by the module. */
struct phantom_info {
	__u32 abi_version; /* PHANTOM_ABI_VERSION */
	__u32 device; /* PHANTOM_DEVICE_... */
	__u64 features; /* PHANTOM_FEATURE_... */
	__u32 patches_max;
	__u32 materials_max;
	__u32 objects_max;
	__u32 rate_min_hz;
	__u32 rate_max_hz;
	__u32 status_size; /* bytes to mmap */
	__u32 tick_size; /* bytes of one record of read() */
	__u32 effects; /* effects that this module can run */
	__s32 workspace_min_nm[3];
	__s32 workspace_max_nm[3];
	__u32 max_force_un; /* the most the device may be asked for */
	__u32 continuous_force_un; /* what it bears for long; 0 = not known */
	__u32 resolution_nm; /* of the position; 0 = not known */
	__u32 device_rate_hz; /* how often the device answers; 0 = every tick */
	__u32 reserved[6];
};

/* SET_RATE. Takes effect without a missed tick. */
struct phantom_rate {
	__u32 rate_hz;
	__u32 reserved;
};

/* SET_MODEL. Takes effect at a tick border, through a fade. */
struct phantom_model {
	__u32 model; /* PHANTOM_MODEL_... */
	__u32 newton_steps; /* projected: 0 ... 3 */
	__u32 combine; /* PHANTOM_COMBINE_... */
	__u32 proxy; /* PHANTOM_PROXY_... */
	__u32 arith; /* PHANTOM_ARITH_... */
	__u32 reserved[3];
};

/*
 * START. Zero in a field takes the module's default, which is on: a person holds the arm.
 * Defaults in brackets.
 */
#define PHANTOM_START_LIMITS_OFF                                                                   \
	(1U << 0) /* no clamp, slew, ramp, speed or stall limit; SIM only */
#define PHANTOM_START_FLAGS_KNOWN PHANTOM_START_LIMITS_OFF
struct phantom_start {
	__u32 flags;
	__u32 max_force_un; /* clamp of |F|, direction kept [the device's] */
	__u32 slew_un_per_ms; /* largest change of F [1 N per ms] */
	__u32 ramp_ms; /* of START, STOP and CLEAR_FAULT [250 ms] */
	__u32 max_speed_um_s; /* overspeed fault, of the filtered velocity [5 m/s] */
	__u32 stall_us; /* stall fault [20000 us] */
	__u32 stale_ms; /* a set older than this fades [100 ms] */
	__u32 crossfade_ms; /* to another level of detail or revision of an object [20 ms] */
};

/*
 * One triangle of a set, with what contact needs of its surroundings. Counter-clockwise seen
 * from outside.
 */
#define PHANTOM_PATCH_NONE 0xffffffffU /* no neighbour in this set */
#define PHANTOM_PATCH_FACE 0 /* a face of the mesh */
/*
 * Where neighbours disagree about the normals of what they share, their shells leave a gap. A fan
 * patch fills it: a triangle without area whose corners have different normals. In a set they
 * follow all faces; their face number and neighbours are PHANTOM_PATCH_NONE.
 */
#define PHANTOM_PATCH_EDGE 1 /* fan over an edge: two of the corners are the same point */
#define PHANTOM_PATCH_CORNER 2 /* fan over a vertex: all three are */
/*
 * Where an open surface ends: no face goes on from this edge with the same outside. No patch to
 * touch: the force of a contact is multiplied by clamp(d / R, 0, 1), d the distance of its foot (of the
 * proxy, when inside) from the nearest rim of its own surface, R its contact radius. So the force
 * fades over the last R before the rim, and a tip that slides off feels no step. In a set rims follow
 * all fans; corners a, b, b, a and b apart; face number and neighbours are PHANTOM_PATCH_NONE; the
 * normals are any.
 */
#define PHANTOM_PATCH_RIM 3
struct phantom_patch {
	__s32 vertex_nm[3][3]; /* [corner][axis], relative to the origin of set or object */
	__s32 normal_q30[3][3]; /* [corner][axis], unit */
	__u32 vertex[3]; /* vertex numbers, unique in the scene: equal = the same corner */
	__u32 face; /* face number, unique in the scene and the same in every set of a level */
	__u32 neighbour[3]; /* index in this set over edge i (corner i to i+1), or NONE */
	__u32 object; /* index into the set's objects */
	__u32 material; /* index into the set's materials */
	__u32 kind; /* PHANTOM_PATCH_... */
	__u32 surface; /* the open surface it is part of, unique in the scene; 0: no rim concerns it */
	__u32 reserved;
};

struct phantom_material {
	__u32 stiffness_mn_mm; /* k */
	__u32 radius_nm; /* R, contact radius; > 0 */
	__u32 damping_mns_m; /* PHANTOM_EFFECT_DAMPING; else 0 */
	__u32 effects; /* PHANTOM_EFFECTS_SURFACE that this material names */
	__u32 reserved[4];
};

/*
 * Tables of surface effects. PHANTOM_EFFECT_MAGNET: the contact radius is how far the magnet reaches,
 * its first range_nm pull towards the surface, with force_un at most; the rest pushes.
 */
struct phantom_magnet {
	__u32 range_nm; /* > 0, below the material's radius_nm */
	__u32 force_un; /* 0 ... PHANTOM_EFFECT_FORCE_MAX_UN */
};

/* PHANTOM_EFFECT_FRICTION */
struct phantom_friction {
	__u32 static_ppm; /* coefficient, dynamic_ppm ... PHANTOM_FRICTION_MAX_PPM */
	__u32 dynamic_ppm; /* while it slides */
	__u32 stiffness_mn_mm; /* of the spring to the stick point, 1 ... _STIFFNESS_MAX_MN_MM */
	__u32 stribeck_um_s; /* half way from static to dynamic; 0 = no Stribeck curve. Max _SPEED_MAX */
};

/*
 * PHANTOM_EFFECT_TEXTURE: two gratings, added. A grating is a wave in the scene's space, or in that of
 * the moving object, felt where the surface cuts it: amplitude_nm sin(2 pi wave . position). Each
 * amplitude_nm times the sum of its |wave_per_km|, both added up, is at most PHANTOM_WAVE_SLOPE_MAX.
 */
struct phantom_texture {
	__u32 amplitude_nm[2]; /* 0 = no such grating; its wave is then zero */
	__s32 wave_per_km[2][3]; /* crests per km along the axes: 1e6 = 1 mm apart */
};

/*
 * PHANTOM_EFFECT_HEIGHT_MAP: a tile of heights, repeated in the scene's space without end. It is laid on
 * surfaces along each of the axes, more of it the more the surface faces that way (triplanar): columns
 * run along y, x, x and rows along z, z, y where the surface faces x, y, z; sample 0 0 is at 0. Between
 * samples it is a quadratic spline, which smooths them: h is near a sample, not through it. Behind the
 * struct follow the heights, __s32 height_nm[rows][columns]. The largest step from one to the next along
 * rows and that along columns (round the tile) add up to spacing_nm at most: a slope of 1.
 */
struct phantom_height_map {
	__u32 columns; /* PHANTOM_MAP_SIZE_MIN ... _MAX, a power of two */
	__u32 rows; /* the same */
	__u32 spacing_nm; /* from sample to sample; PHANTOM_MAP_SPACING_MIN_NM at least */
	__u32 amplitude_nm; /* no height is farther from 0 */
};

/*
 * PHANTOM_EFFECT_IMPACT: where contact begins, the surface rings: at an approach speed v with
 * min(gain v, force_un) exp(-t / decay) sin(2 pi frequency t), along the normal of that moment. Where
 * contact ends it fades within 10 ms; only contact that begins after that rings again.
 */
struct phantom_impact {
	__u32 gain_mns_m; /* at most PHANTOM_IMPACT_GAIN_MAX_MNS_M_PER_HZ frequency_hz */
	__u32 force_un; /* the largest amplitude, at most PHANTOM_EFFECT_FORCE_MAX_UN */
	__u32 frequency_hz; /* PHANTOM_IMPACT_FREQUENCY_MIN_HZ ... _MAX_HZ */
	__u32 decay_us; /* PHANTOM_IMPACT_DECAY_MIN_US ... _MAX_US */
};

/* Tables of space effects. Places are absolute, and near the set's origin: _REACH_MAX_NM. */
struct phantom_effect_count {
	__u32 count; /* 1 ... PHANTOM_REGIONS_MAX */
	__u32 reserved;
};

/* PHANTOM_EFFECT_CONSTANT: gravity, wind. */
struct phantom_constant {
	__s32 force_un[3]; /* each at most PHANTOM_EFFECT_FORCE_MAX_UN */
	__u32 reserved;
};

/* PHANTOM_EFFECT_VISCOSITY: in a ball, full within radius_nm - border_nm; or everywhere. */
struct phantom_viscosity {
	__s64 centre_nm[3]; /* 0 0 0 if everywhere */
	__u32 radius_nm; /* 0 = everywhere */
	__u32 border_nm; /* PHANTOM_BORDER_MIN_NM ... radius_nm; 0 if everywhere */
	__u32 viscosity_mns_m; /* force against velocity, at most PHANTOM_VISCOSITY_MAX_MNS_M */
	__u32 drag_mns2_m2; /* force against its square, at most PHANTOM_DRAG_MAX_MNS2_M2 */
};

/* PHANTOM_EFFECT_GUIDE: a spring to a point, a line or a plane. */
#define PHANTOM_GUIDE_POINT 0
#define PHANTOM_GUIDE_LINE 1
#define PHANTOM_GUIDE_PLANE 2
struct phantom_guide {
	__s64 point_nm[3]; /* of the line, of the plane */
	__s32 direction_q30[3]; /* unit: along the line, across the plane; 0 0 0 for a point */
	__u32 kind; /* PHANTOM_GUIDE_... */
	__u32 stiffness_mn_mm; /* 1 ... PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM */
	__u32 force_un; /* the most it pulls, 1 ... PHANTOM_EFFECT_FORCE_MAX_UN */
	__u32 reach_nm; /* it lets go over the last quarter of that distance; 0 = never */
	__u32 reserved;
};

/*
 * PHANTOM_EFFECT_FIELD: forces at the nodes of a grid along the scene's axes, between them trilinear,
 * outside of it none; at its border it fades. Behind the struct follow the nodes,
 * __s32 force_un[nodes[2]][nodes[1]][nodes[0]][3], and one zero __s32 if their number is odd. Along every
 * axis force changes by PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM at most, and is PHANTOM_EFFECT_FORCE_MAX_UN at
 * most.
 */
struct phantom_field {
	__s64 corner_nm[3]; /* node 0 0 0 */
	__u32 spacing_nm[3]; /* from node to node; PHANTOM_FIELD_SPACING_MIN_NM at least */
	__u32 nodes[3]; /* 2 or more; their product is PHANTOM_FIELD_NODES_MAX at most */
	__u32 border_nm; /* full farther inside; PHANTOM_BORDER_MIN_NM ... half of the shortest side */
	__u32 reserved;
};

/* PHANTOM_EFFECT_TIP: EFFECTS above. */
struct phantom_tip {
	__u32 radius_nm; /* 1 ... PHANTOM_TIP_RADIUS_MAX_NM; with it no R is above 2^32 - 1 nm */
	__u32 reserved;
};

/*
 * Where an object is. One that rests has its patches in the scene, relative to the set's origin: rotation
 * (1,0,0,0), all else zero but number and revision.
 */
#define PHANTOM_OBJECT_MOVES (1U << 0) /* MOVING OBJECTS above */
#define PHANTOM_OBJECT_FLAGS_KNOWN PHANTOM_OBJECT_MOVES
struct phantom_object {
	__u32 object; /* number in the scene */
	__u32 revision; /* of its geometry; another number crossfades */
	__s64 translation_nm[3]; /* of the frame's origin, in the scene, at set.time_ns */
	__s32 rotation_q30[4]; /* unit quaternion w x y z, from the frame to the scene */
	__s32 velocity_nm_s[3]; /* of the frame's origin */
	__s32 angular_velocity_urad_s[3]; /* round the frame's origin, about the scene's axes */
	__u32 flags; /* PHANTOM_OBJECT_... */
	__u32 reserved;
	__s64 origin_nm[3]; /* of the patches' coordinates, in the frame */
};

/* SUBMIT_SET. */
struct phantom_set {
	__u64 id; /* > 0, larger than the one before */
	__s64 origin_nm[3];
	__s32 centre_nm[3]; /* coverage, relative to origin */
	__u32 radius_nm; /* coverage; 0 = covers nothing: fades to zero */
	__u32 patch_count;
	__u32 material_count;
	__u32 object_count;
	__u32 effects; /* union of the materials' effects, exactly, those of space, and TIP */
	__u32 level; /* of detail; 0 is the mesh itself; another one crossfades */
	__u32 level_error_nm; /* how far that level lies from the mesh */
	__u32 flags; /* 0 */
	__u32 effect_bytes; /* of the effects' tables, behind the materials */
	__u64 time_ns; /* of the poses and of the coverage, CLOCK_MONOTONIC; read if an object moves */
	__u64 patches; /* struct phantom_patch[patch_count] */
	__u64 materials; /* struct phantom_material[material_count], then the tables */
	__u64 objects; /* struct phantom_object[object_count] */
};

/* SIM_MOVE. Where the simulated device's tip is from the next tick on. */
struct phantom_sim_move {
	__s64 tip_nm[3];
	__u64 reserved;
};

/* phantom_tick.flags and phantom_status.flags */
#define PHANTOM_TICK_INSIDE (1U << 0) /* the tip is below the surface (as far as known) */
#define PHANTOM_TICK_UNCOVERED (1U << 1) /* no set covers the tip: no force is computed */
#define PHANTOM_TICK_STALE (1U << 2) /* the set is older than start.stale_ms */
#define PHANTOM_TICK_FADING (1U << 3) /* the force fades from one target to another */
#define PHANTOM_TICK_CLAMPED (1U << 4) /* max_force_un cut the force */
#define PHANTOM_TICK_SLEWED (1U << 5) /* slew_un_per_ms held the force back */
#define PHANTOM_TICK_RAMPING (1U << 6) /* START, STOP or CLEAR_FAULT is ramping */
#define PHANTOM_TICK_SATURATED (1U << 7) /* a conversion saturated */
/* What came to this tick from outside, so that it can be computed again from its record. */
#define PHANTOM_TICK_STOPPED (1U << 8) /* it took STOP: the ramp goes down from here */
#define PHANTOM_TICK_ABANDONED (1U << 9) /* it took the feeder's close or death */
#define PHANTOM_TICK_CLEARED (1U << 10) /* it took CLEAR_FAULT */
#define PHANTOM_TICK_UNREAD (1U << 11) /* the device gave no position: the tip is the last known */
#define PHANTOM_TICK_UNSENT (1U << 12) /* the device did not take the force */

/* One record of read(): one tick. */
struct phantom_tick {
	__u64 tick; /* number of its period, from 1; a gap = periods missed or records lost */
	__u64 time_ns;
	__u64 set_id; /* of the set in use, whether it covers the tip or not; 0 = none */
	__s64 tip_nm[3];
	__s64 proxy_nm[3]; /* = tip outside the surface */
	__s32 force_un[3]; /* as sent to the device */
	__u32 contacts;
	__u32 flags; /* PHANTOM_TICK_... */
	__u32 faults; /* PHANTOM_FAULT_..., latched */
	__u32 latency_ns; /* wake-up after the begin of the period that was waited for */
	__u32 duration_ns; /* of the whole tick */
	__u32 rate_hz; /* in force */
	__u32 model; /* in force: PHANTOM_TICK_MODEL() */
};

/* struct phantom_model in one word, 4 bits a field. */
#define PHANTOM_TICK_MODEL(m)                                                                      \
	((m)->model | (m)->newton_steps << 4 | (m)->combine << 8 | (m)->proxy << 12 |              \
	 (m)->arith << 16)

/*
 * A histogram of durations: bucket b < 8 counts b ns; above, 8 buckets an octave:
 *   b = 8 (e - 2) + m   counts   (8 + m) 2^(e-3) ... (9 + m) 2^(e-3) ns,
 *   e = floor(log2 ns) >= 3, m = 0 ... 7
 * Counters stop at 2^32 - 1.
 */
#define PHANTOM_HISTOGRAM_BUCKETS 240
struct phantom_histogram {
	__u32 count[PHANTOM_HISTOGRAM_BUCKETS];
	__u32 max_ns;
	__u32 reserved;
};

/*
 * The status page. sequence is odd while the module writes it: read sequence (until even), copy,
 * read sequence again, repeat if it changed. Only state ... faults are consistent with each other;
 * histograms may be a tick ahead.
 */
struct phantom_status {
	__u32 sequence;
	__u32 abi_version;
	__u32 state; /* PHANTOM_STATE_... */
	__u32 faults; /* PHANTOM_FAULT_..., latched */
	__u32 rate_hz;
	__u32 isa; /* PHANTOM_ISA_... */
	struct phantom_model model;
	__u64 tick; /* number of the last period since START, missed ones included */
	__u64 missed; /* periods skipped since START: ticks run = tick - missed */
	__u64 start_ns; /* when START came */
	__u64 time_ns; /* of this tick */
	__u64 busy_ns; /* sum of tick durations since START: idle = 1 - busy / (time - start) */
	__s64 tip_nm[3];
	__s64 proxy_nm[3];
	__s32 velocity_nm_s[3];
	__s32 normal_q30[3]; /* of the contact; zero without one */
	__s32 force_un[3];
	__u32 contacts;
	__u32 flags; /* PHANTOM_TICK_... */
	__u32 set_patches;
	__u64 set_id;
	__u64 set_time_ns; /* when the tick took the set: age = time - set_time */
	__u64 sets; /* sets taken since START */
	__u64 fades; /* fades begun since START */
	__u64 saturated; /* conversions that saturated since START */
	__u64 refused; /* patches that could not be computed, summed over sets */
	__u64 clamped; /* ticks with the force clamped */
	__u64 sections; /* float sections opened by ticks */
	__u32 set_level;
	__u32 set_level_error_nm;
	__u32 section_max_ns; /* the longest float section, those of SUBMIT_SET included */
	__u32 lost; /* records that lagging readers lost since the module was loaded, all files */
	__u32 reserved[8];
	struct phantom_histogram latency;
	struct phantom_histogram duration;
	struct phantom_histogram section;
};

#define PHANTOM_IOC_MAGIC 0xE7

#define PHANTOM_GET_INFO _IOR(PHANTOM_IOC_MAGIC, 0x00, struct phantom_info)
#define PHANTOM_SET_RATE _IOW(PHANTOM_IOC_MAGIC, 0x01, struct phantom_rate)
#define PHANTOM_SET_MODEL _IOW(PHANTOM_IOC_MAGIC, 0x02, struct phantom_model)
#define PHANTOM_START _IOW(PHANTOM_IOC_MAGIC, 0x03, struct phantom_start)
#define PHANTOM_STOP _IO(PHANTOM_IOC_MAGIC, 0x04)
#define PHANTOM_SUBMIT_SET _IOW(PHANTOM_IOC_MAGIC, 0x05, struct phantom_set)
#define PHANTOM_SIM_MOVE _IOW(PHANTOM_IOC_MAGIC, 0x06, struct phantom_sim_move)
#define PHANTOM_CLEAR_FAULT _IO(PHANTOM_IOC_MAGIC, 0x07)

#endif /* PHANTOM_ABI_H */
