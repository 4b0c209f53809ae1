// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * relief.h - a curved scene to touch: the surface z = h(x, y) of bumps, 60 mm wide, in 1152 triangles with
 * analytic normals, and sets cut out of it round a tip, as a feeder does.
 */
#ifndef VM_RELIEF_H
#define VM_RELIEF_H

#include <stdint.h>

#include "phantom_abi.h"

#define RELIEF_CELLS 24
#define RELIEF_CELL_NM 2500000
#define RELIEF_WINDOW 5 /* cells of a set, each way */
#define RELIEF_PATCHES (2 * RELIEF_WINDOW * RELIEF_WINDOW)
/* Smaller than the distance from the middle cell to the window's rim. */
#define RELIEF_COVERAGE_NM (2 * RELIEF_CELL_NM)
#define RELIEF_RADIUS_NM 1500000
#define RELIEF_MAP 4 /* samples of a height map, each way */

struct relief_set {
    struct phantom_set set;
    struct phantom_patch patches[RELIEF_PATCHES];
    struct phantom_material material;
    /* Of effects, where they are looked for: behind the materials. relief_feel() names them. */
    struct relief_tables {
        struct phantom_magnet magnet;
        struct phantom_friction friction;
        struct phantom_texture texture;
        struct phantom_height_map height_map;
        __s32 height_nm[RELIEF_MAP][RELIEF_MAP];
        struct phantom_impact impact;
        struct phantom_constant constant;
        struct phantom_effect_count viscosities;
        struct phantom_viscosity viscosity;
        struct phantom_effect_count guides;
        struct phantom_guide guide;
        struct phantom_field field;
        __s32 node_un[2][2][2][3];
        struct phantom_tip tip;
    } tables;
    struct phantom_object object;
};

/* Height of the surface above z = 0, nm. */
double relief_height_nm(double x_nm, double y_nm);
/* The set round that tip, which must lie above or below the surface and at least three cells inside its rim.
 */
void relief_cut(struct relief_set* relief, uint64_t id, const int64_t tip_nm[3]);
/* Gives it every effect that there is. */
void relief_feel(struct relief_set* relief);
/*
 * Lets the surface move, by some 0.2 mm: up and down, and round the scene's z. What it does at that time is
 * the same for every set.
 */
void relief_move(struct relief_set* relief, uint64_t time_ns);

#endif /* VM_RELIEF_H */
