// SPDX-License-Identifier: GPL-2.0-or-later
// The relief and the sets that are cut out of it.
#include <math.h>
#include <string.h>

#include "relief.h"

#define HALF_NM ((double)RELIEF_CELLS * RELIEF_CELL_NM / 2)
/* Bumps 1 mm high; their radius of curvature, some 4 mm, is larger than the contact radius. */
#define HEIGHT_NM 1e6
#define WAVES_X (2 * M_PI / 14e6)
#define WAVES_Y (2 * M_PI / 17e6)

double relief_height_nm(double x_nm, double y_nm)
{
    return HEIGHT_NM * sin(WAVES_X * x_nm) * cos(WAVES_Y * y_nm);
}

/* The corner of four cells, relative to the origin. */
static void put_corner(struct phantom_patch* patch, int corner, int column, int row,
                       const int64_t origin_nm[3])
{
    double x = column * (double)RELIEF_CELL_NM - HALF_NM;
    double y = row * (double)RELIEF_CELL_NM - HALF_NM;
    double slope_x = HEIGHT_NM * WAVES_X * cos(WAVES_X * x) * cos(WAVES_Y * y);
    double slope_y = -HEIGHT_NM * WAVES_Y * sin(WAVES_X * x) * sin(WAVES_Y * y);
    double scale = PHANTOM_Q30_ONE / sqrt(slope_x * slope_x + slope_y * slope_y + 1);

    patch->vertex_nm[corner][0] = (int32_t)(llrint(x) - origin_nm[0]);
    patch->vertex_nm[corner][1] = (int32_t)(llrint(y) - origin_nm[1]);
    patch->vertex_nm[corner][2] = (int32_t)(llrint(relief_height_nm(x, y)) - origin_nm[2]);
    patch->normal_q30[corner][0] = (int32_t)lrint(-slope_x * scale);
    patch->normal_q30[corner][1] = (int32_t)lrint(-slope_y * scale);
    patch->normal_q30[corner][2] = (int32_t)lrint(scale);
    patch->vertex[corner] = (uint32_t)(row * (RELIEF_CELLS + 1) + column);
}

/* Index in the window; upper is the triangle at the cell's far corner. */
static uint32_t index_of(int column, int row, int upper)
{
    if (column < 0 || row < 0 || column >= RELIEF_WINDOW || row >= RELIEF_WINDOW)
        return PHANTOM_PATCH_NONE;
    return (uint32_t)(2 * (row * RELIEF_WINDOW + column) + upper);
}

static void put_cell(struct relief_set* relief, int column, int row, int first_column, int first_row)
{
    struct phantom_patch* lower = &relief->patches[index_of(column, row, 0)];
    struct phantom_patch* upper = &relief->patches[index_of(column, row, 1)];
    const int64_t origin_nm[3] = {relief->set.origin_nm[0], relief->set.origin_nm[1],
                                  relief->set.origin_nm[2]};
    int c = first_column + column;
    int r = first_row + row;

    put_corner(lower, 0, c, r, origin_nm);
    put_corner(lower, 1, c + 1, r, origin_nm);
    put_corner(lower, 2, c, r + 1, origin_nm);
    lower->neighbour[0] = index_of(column, row - 1, 1);
    lower->neighbour[1] = index_of(column, row, 1);
    lower->neighbour[2] = index_of(column - 1, row, 1);
    lower->face = (uint32_t)(2 * (r * RELIEF_CELLS + c));
    put_corner(upper, 0, c, r + 1, origin_nm);
    put_corner(upper, 1, c + 1, r, origin_nm);
    put_corner(upper, 2, c + 1, r + 1, origin_nm);
    upper->neighbour[0] = index_of(column, row, 0);
    upper->neighbour[1] = index_of(column + 1, row, 0);
    upper->neighbour[2] = index_of(column, row + 1, 0);
    upper->face = lower->face + 1;
}

void relief_cut(struct relief_set* relief, uint64_t id, const int64_t tip_nm[3])
{
    int first_column = (int)floor(((double)tip_nm[0] + HALF_NM) / RELIEF_CELL_NM) - RELIEF_WINDOW / 2;
    int first_row = (int)floor(((double)tip_nm[1] + HALF_NM) / RELIEF_CELL_NM) - RELIEF_WINDOW / 2;

    memset(relief, 0, sizeof(*relief));
    relief->set.id = id;
    for (int axis = 0; axis < 3; axis++)
        relief->set.origin_nm[axis] = tip_nm[axis];
    relief->set.radius_nm = RELIEF_COVERAGE_NM;
    relief->set.patch_count = RELIEF_PATCHES;
    relief->set.material_count = 1;
    relief->set.object_count = 1;
    relief->set.patches = (uintptr_t)relief->patches;
    relief->set.materials = (uintptr_t)&relief->material;
    relief->set.objects = (uintptr_t)&relief->object;
    relief->material.stiffness_mn_mm = 800;
    relief->material.radius_nm = RELIEF_RADIUS_NM;
    relief->object.rotation_q30[0] = PHANTOM_Q30_ONE;
    for (int row = 0; row < RELIEF_WINDOW; row++)
        for (int column = 0; column < RELIEF_WINDOW; column++)
            put_cell(relief, column, row, first_column, first_row);
}

void relief_feel(struct relief_set* relief)
{
    relief->material.damping_mns_m = 800;
    relief->material.effects = PHANTOM_EFFECTS_SURFACE;
    relief->set.effects = PHANTOM_EFFECTS_KNOWN;
    relief->set.effect_bytes = sizeof(relief->tables);
    relief->tables = (struct relief_tables){
        .magnet = {.range_nm = 200000, .force_un = 150000},
        .friction = {.static_ppm = 500000,
                     .dynamic_ppm = 300000,
                     .stiffness_mn_mm = 600,
                     .stribeck_um_s = 30000},
        .texture = {.amplitude_nm = {30000, 0}, .wave_per_km = {{400000, 300000, 0}, {0, 0, 0}}},
        .height_map = {.columns = RELIEF_MAP,
                       .rows = RELIEF_MAP,
                       .spacing_nm = 500000,
                       .amplitude_nm = 40000},
        .height_nm = {{40000, 0, -40000, 0}, {0, 20000, 0, -20000}},
        .impact = {.gain_mns_m = 2000, .force_un = 500000, .frequency_hz = 120, .decay_us = 20000},
        .constant = {.force_un = {20000, -10000, -50000}},
        .viscosities = {.count = 1},
        .viscosity = {.radius_nm = 12000000,
                      .border_nm = 4000000,
                      .viscosity_mns_m = 1500,
                      .drag_mns2_m2 = 2000},
        .guides = {.count = 1},
        .guide = {.direction_q30 = {0, PHANTOM_Q30_ONE, 0},
                  .kind = PHANTOM_GUIDE_PLANE,
                  .stiffness_mn_mm = 20,
                  .force_un = 200000,
                  .reach_nm = 12000000},
        .field = {.corner_nm = {-10000000, -10000000, -10000000},
                  .spacing_nm = {20000000, 20000000, 20000000},
                  .nodes = {2, 2, 2},
                  .border_nm = 5000000},
        .node_un = {{{{100000, 0, 0}, {0, 50000, 0}}}, {{{0, 0, -80000}}}},
        .tip = {.radius_nm = 500000},
    };
}

void relief_move(struct relief_set* relief, uint64_t time_ns)
{
    double rate = 2 * M_PI * 3, phase = fmod(rate * (double)time_ns * 1e-9, 2 * M_PI);
    double up_nm = 1e5, round_rad = 3e-3; /* 0.09 mm at the rim */
    struct phantom_object* object = &relief->object;

    relief->set.time_ns = time_ns;
    /* the window was cut where the surface is at rest */
    relief->set.radius_nm -= 200000;
    object->flags = PHANTOM_OBJECT_MOVES;
    object->translation_nm[2] = llrint(up_nm * sin(phase));
    object->velocity_nm_s[2] = (int32_t)lrint(up_nm * rate * cos(phase));
    object->rotation_q30[0] = (int32_t)lrint(PHANTOM_Q30_ONE * cos(round_rad * cos(phase) / 2));
    object->rotation_q30[3] = (int32_t)lrint(PHANTOM_Q30_ONE * sin(round_rad * cos(phase) / 2));
    object->angular_velocity_urad_s[2] = (int32_t)lrint(-1e6 * round_rad * rate * sin(phase));
    for (int axis = 0; axis < 3; axis++)
        object->origin_nm[axis] = relief->set.origin_nm[axis];
}
