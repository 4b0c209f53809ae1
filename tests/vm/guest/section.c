// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * How long preemption is off: a bowl of triangles all round the tip, every one in contact and none behind
 * another, so that no test of the contact models can end early.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "device.h"
#include "harness.h"

#define BOWL_NM 1000000  /* distance of the triangles from the tip; R is twice that */
#define BOWL_STIFFNESS 1 /* mN/mm: 512 of them are far below the device's force */

/* 20 us of a core that does one instruction a cycle at 3 GHz. */
#define SECTION_MAX 60000

struct bowl {
    struct phantom_set set;
    struct phantom_patch patches[PHANTOM_PATCHES_MAX];
    struct phantom_material material;
    struct phantom_object object;
};

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = a[(axis + 1) % 3] * b[(axis + 2) % 3] - a[(axis + 2) % 3] * b[(axis + 1) % 3];
}

/* A small triangle at BOWL_NM in that direction, facing the tip. */
static void bowl_patch(struct phantom_patch* patch, const double out[3], double edge_nm, uint32_t number)
{
    const double helper[3] = {fabs(out[0]) < 0.5, fabs(out[0]) >= 0.5, 0};
    double u[3], v[3], length;

    cross(out, helper, u);
    length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int axis = 0; axis < 3; axis++)
        u[axis] /= length;
    cross(out, u, v);
    for (int corner = 0; corner < 3; corner++) {
        /* clockwise round `out`, so counter-clockwise as seen from the tip */
        double angle = -2 * M_PI * corner / 3;

        for (int axis = 0; axis < 3; axis++) {
            double side = cos(angle) * u[axis] + sin(angle) * v[axis];

            patch->vertex_nm[corner][axis] = (int32_t)lround(BOWL_NM * out[axis] + edge_nm * side);
            patch->normal_q30[corner][axis] = (int32_t)lround(-out[axis] * PHANTOM_Q30_ONE);
        }
        patch->vertex[corner] = 3 * number + (uint32_t)corner;
        patch->neighbour[corner] = PHANTOM_PATCH_NONE;
    }
    patch->face = number;
}

/* That many directions, evenly spread (a Fibonacci lattice). */
static void bowl_make(struct bowl* bowl, uint32_t count)
{
    const double golden = M_PI * (3 - sqrt(5));

    memset(bowl, 0, sizeof(*bowl));
    for (uint32_t i = 0; i < count; i++) {
        double z = 1 - (2 * i + 1.0) / count, r = sqrt(1 - z * z);
        const double out[3] = {r * cos(golden * i), r * sin(golden * i), z};

        bowl_patch(&bowl->patches[i], out, 0.5 * BOWL_NM / sqrt(count), i);
    }
    bowl->material.stiffness_mn_mm = BOWL_STIFFNESS;
    bowl->material.radius_nm = 2 * BOWL_NM;
    bowl->object.rotation_q30[0] = PHANTOM_Q30_ONE;
    bowl->set.id = 1;
    bowl->set.radius_nm = 500000000;
    bowl->set.patch_count = count;
    bowl->set.material_count = 1;
    bowl->set.object_count = 1;
    bowl->set.patches = (uintptr_t)bowl->patches;
    bowl->set.materials = (uintptr_t)&bowl->material;
    bowl->set.objects = (uintptr_t)&bowl->object;
}

static void longest_section(uint32_t model_number, uint32_t count)
{
    static struct bowl bowl;
    const struct phantom_model model = {
        .model = model_number,
        .newton_steps = PHANTOM_NEWTON_STEPS_MAX,
        .combine = PHANTOM_COMBINE_BOUNDED,
        .proxy = PHANTOM_PROXY_PAPER,
    };
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    bowl_make(&bowl, count);
    vm_expect(fd, PHANTOM_SET_MODEL, &model, 0, "SET_MODEL");
    vm_move(fd, 0, 0, 0);
    vm_expect(fd, PHANTOM_SUBMIT_SET, &bowl.set, 0, "SUBMIT_SET");
    vm_start(fd);
    vm_wait_ticks(page, 20);
    vm_status(page, &status);
    CHECK(status.section_max_ns <= SECTION_MAX, "%u instructions without preemption", status.section_max_ns);
    CHECK(status.contacts == count, "%u contacts of %u", status.contacts, count);
    CHECK(status.faults == 0, "faults %#x", status.faults);
    vm_figure("%u patches, all in contact: longest section of a tick %u instructions", count,
              status.section_max_ns);
}

VM_TEST(section, paper_64, 10)
{
    longest_section(PHANTOM_MODEL_PAPER, 64);
}
VM_TEST(section, paper_192, 10)
{
    longest_section(PHANTOM_MODEL_PAPER, 192);
}
/*
 * Overlap removal asks every contact of every other: with 512 of them a tick takes millions of instructions,
 * more than its period. The sections stay short, and the servo gives up before it starves the machine.
 */
VM_TEST(section, paper_512_is_an_overload, 10)
{
    static struct bowl bowl;
    const struct phantom_model model = {.model = PHANTOM_MODEL_PAPER, .proxy = PHANTOM_PROXY_PAPER};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    bowl_make(&bowl, 512);
    vm_expect(fd, PHANTOM_SET_MODEL, &model, 0, "SET_MODEL");
    vm_move(fd, 0, 0, 0);
    vm_expect(fd, PHANTOM_SUBMIT_SET, &bowl.set, 0, "SUBMIT_SET");
    vm_start(fd);
    vm_sleep_ns(600000000);
    vm_status(page, &status);
    CHECK(status.section_max_ns <= SECTION_MAX, "%u instructions without preemption", status.section_max_ns);
    CHECK(status.faults == PHANTOM_FAULT_STALL, "faults %#x, %llu ticks, %llu missed", status.faults,
          (unsigned long long)status.tick, (unsigned long long)status.missed);
    CHECK(status.contacts == 0, "%u contacts", status.contacts);
    vm_figure("512 patches of paper, all in contact: longest section %u instructions, %llu periods missed",
              status.section_max_ns, (unsigned long long)status.missed);
}
VM_TEST(section, projected_64, 10)
{
    longest_section(PHANTOM_MODEL_PROJECTED, 64);
}
VM_TEST(section, projected_512, 10)
{
    longest_section(PHANTOM_MODEL_PROJECTED, 512);
}
