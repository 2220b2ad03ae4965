/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octant_mask.h"

const tm_octant_mask tm_point_octants[26] = {
    0x80, 0x40, 0x20, 0x10, 0x08, 0x04, 0x02, 0x01, 0xc0, 0x30, 0x0c, 0x03, 0xa0,
    0x50, 0x0a, 0x05, 0x88, 0x44, 0x22, 0x11, 0xaa, 0x55, 0xcc, 0x33, 0xf0, 0x0f};

const uint8_t tm_face_edge[6][4] = {{4, 6, 8, 10},  {5, 7, 9, 11}, {0, 2, 8, 9},
                                    {1, 3, 10, 11}, {0, 1, 4, 5},  {2, 3, 6, 7}};

/* The octants on the low side of each axis; their partners are that many bits higher. */
static const unsigned low_side[3] = {0x55, 0x33, 0x0f};

/* The octants across the plane of an axis. */
static unsigned mirror(unsigned mask, int axis)
{
    const unsigned step = 1u << axis;
    return (mask & low_side[axis]) << step | (mask >> step & low_side[axis]);
}

/* Whether the octants of a mask that is not empty are joined through common faces. */
static bool is_connected(unsigned mask)
{
    unsigned reached = mask & -mask;
    for (;;) {
        unsigned more = reached;
        for (int axis = 0; axis < 3; axis++)
            more |= mirror(more, axis) & mask;
        if (more == reached)
            return reached == mask;
        reached = more;
    }
}

/* Whether a boundary face looks along the axis, and whether one looks back. */
static void looks(unsigned mask, int axis, bool *along, bool *back)
{
    const unsigned across = mirror(mask, axis);
    *along = mask & ~across & low_side[axis];
    *back = ~mask & across & low_side[axis];
}

bool tm_octant_mask_is_good(tm_octant_mask mask)
{
    if (mask == 0 || mask == TM_ALL_OCTANTS)
        return true;
    for (int axis = 0; axis < 3; axis++) {
        bool along, back;
        looks(mask, axis, &along, &back);
        if (along && back)
            return false;
    }
    /* One fan: filled and empty octants are each in one piece. */
    return is_connected(mask) && is_connected(~(unsigned)mask & TM_ALL_OCTANTS);
}

bool tm_octants_are_good(const unsigned label[8], unsigned labels)
{
    for (unsigned k = 0; k < labels; k++) {
        unsigned mask = 0;
        for (unsigned o = 0; o < 8; o++)
            mask |= (unsigned)(label[o] == k) << o;
        if (mask == 0 || !tm_octant_mask_is_good((tm_octant_mask)mask))
            return false;
    }
    return true;
}

void tm_octant_mask_outward(tm_octant_mask mask, int direction[3])
{
    for (int axis = 0; axis < 3; axis++) {
        bool along, back;
        looks(mask, axis, &along, &back);
        direction[axis] = (int)along - (int)back;
    }
}
