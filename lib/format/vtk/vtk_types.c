/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_cells.h"

#include "../../element/shape.h"

/* A type of cell: nodes 0: any number from the corners on; corners 0: all nodes are. */
typedef struct cell_type {
    int8_t dimension;
    uint8_t nodes, corners;
    uint8_t is; /* the type that its corners are */
} cell_type;

/* The corners come first in all of them (vtkCellType.h, and the classes' documentation).
 */
static const cell_type types[TM_VTK_TYPES] = {
    [TM_VTK_VERTEX] = {0, 1, 1, TM_VTK_VERTEX},
    [TM_VTK_POLY_VERTEX] = {0, 0, 0, TM_VTK_POLY_VERTEX},
    [TM_VTK_LINE] = {1, 2, 2, TM_VTK_LINE},
    [TM_VTK_POLY_LINE] = {1, 0, 0, TM_VTK_POLY_LINE},
    [TM_VTK_TRIANGLE] = {2, 3, 3, TM_VTK_TRIANGLE},
    [TM_VTK_STRIP] = {2, 0, 0, TM_VTK_STRIP},
    [TM_VTK_POLYGON] = {2, 0, 0, TM_VTK_POLYGON},
    [TM_VTK_PIXEL] = {2, 4, 4, TM_VTK_QUADRILATERAL},
    [TM_VTK_QUADRILATERAL] = {2, 4, 4, TM_VTK_QUADRILATERAL},
    [TM_VTK_TETRA] = {3, 4, 4, TM_VTK_TETRA},
    [TM_VTK_VOXEL] = {3, 8, 8, TM_VTK_HEXAHEDRON},
    [TM_VTK_HEXAHEDRON] = {3, 8, 8, TM_VTK_HEXAHEDRON},
    [TM_VTK_WEDGE] = {3, 6, 6, TM_VTK_WEDGE},
    [TM_VTK_PYRAMID] = {3, 5, 5, TM_VTK_PYRAMID},
    [TM_VTK_PENTAGONAL_PRISM] = {3, 10, 10, TM_VTK_PENTAGONAL_PRISM},
    [TM_VTK_HEXAGONAL_PRISM] = {3, 12, 12, TM_VTK_HEXAGONAL_PRISM},
    [21] = {1, 3, 2, TM_VTK_LINE}, /* of second order */
    [22] = {2, 6, 3, TM_VTK_TRIANGLE},
    [23] = {2, 8, 4, TM_VTK_QUADRILATERAL},
    [24] = {3, 10, 4, TM_VTK_TETRA},
    [25] = {3, 20, 8, TM_VTK_HEXAHEDRON},
    [26] = {3, 15, 6, TM_VTK_WEDGE},
    [27] = {3, 13, 5, TM_VTK_PYRAMID},
    [28] = {2, 9, 4, TM_VTK_QUADRILATERAL},
    [29] = {3, 27, 8, TM_VTK_HEXAHEDRON},
    [30] = {2, 6, 4, TM_VTK_QUADRILATERAL},
    [31] = {3, 12, 6, TM_VTK_WEDGE},
    [32] = {3, 18, 6, TM_VTK_WEDGE},
    [33] = {3, 24, 8, TM_VTK_HEXAHEDRON},
    [34] = {2, 7, 3, TM_VTK_TRIANGLE},
    [35] = {1, 4, 2, TM_VTK_LINE}, /* of third */
    [37] = {3, 19, 5, TM_VTK_PYRAMID},
    [TM_VTK_POLYHEDRON] = {3, 0, 0, TM_VTK_POLYHEDRON},
    [68] = {1, 0, 2, TM_VTK_LINE}, /* of any: by Lagrange, */
    [69] = {2, 0, 3, TM_VTK_TRIANGLE},
    [70] = {2, 0, 4, TM_VTK_QUADRILATERAL},
    [71] = {3, 0, 4, TM_VTK_TETRA},
    [72] = {3, 0, 8, TM_VTK_HEXAHEDRON},
    [73] = {3, 0, 6, TM_VTK_WEDGE},
    [74] = {3, 0, 5, TM_VTK_PYRAMID},
    [75] = {1, 0, 2, TM_VTK_LINE}, /* by Bezier */
    [76] = {2, 0, 3, TM_VTK_TRIANGLE},
    [77] = {2, 0, 4, TM_VTK_QUADRILATERAL},
    [78] = {3, 0, 4, TM_VTK_TETRA},
    [79] = {3, 0, 8, TM_VTK_HEXAHEDRON},
    [80] = {3, 0, 6, TM_VTK_WEDGE},
    [81] = {3, 0, 5, TM_VTK_PYRAMID},
};

static const cell_type *type_of(uint8_t type)
{
    return type < TM_VTK_TYPES && types[type].is != TM_VTK_EMPTY ? &types[type] : NULL;
}

int tm_vtk_dimension(uint8_t type)
{
    const cell_type *t = type_of(type);
    return t ? t->dimension : -1;
}

static tm_status check(const tm_vtk_mesh *cells, size_t c, tm_error *error)
{
    static const uint8_t least_of_dimension[] = {1, 2, 3, 0};
    const cell_type *t = type_of(cells->type[c]);
    const size_t nodes = cells->nodes.start[c + 1] - cells->nodes.start[c];
    if (!t)
        return tm_fail_at(error, TM_ERROR_INPUT, cells->name, 0, NULL,
                          "cell %zu is of VTK's type %u, which a stream cannot hold", c,
                          cells->type[c]);
    const size_t least = t->nodes     ? t->nodes
                         : t->corners ? t->corners
                                      : least_of_dimension[t->dimension];
    if (nodes < least || (t->nodes && nodes != least))
        return tm_fail_at(
            error, TM_ERROR_INPUT, cells->name, 0, NULL,
            "cell %zu, of VTK's type %u, has %zu nodes (%zu would be right)", c,
            cells->type[c], nodes, least);
    return TM_OK;
}

static void exchange(uint32_t *node, size_t i)
{
    const uint32_t swapped = node[i];
    node[i] = node[i + 1];
    node[i + 1] = swapped;
}

/* In pixels and voxels x runs fastest, then y. */
static void reorder(uint8_t type, uint32_t *node)
{
    enum { SECOND_ROW = 2, ABOVE = 4 };
    if (type == TM_VTK_PIXEL || type == TM_VTK_VOXEL)
        exchange(node, SECOND_ROW);
    if (type == TM_VTK_VOXEL)
        exchange(node, ABOVE + SECOND_ROW);
}

/* Those that are the middle of a cell, but the corner of another one, are none. */
static void take_back_corners(const tm_vtk_mesh *cells, bool *middle)
{
    for (size_t i = 0; i < cells->nodes.start[cells->cells]; i++)
        middle[cells->nodes.item[i]] = false;
    for (size_t c = 0; c < cells->cells; c++)
        for (size_t i = cells->faces.start[c]; i < cells->faces.start[c + 1];) {
            const size_t k = cells->faces.item[i];
            for (size_t j = 1; j <= k; j++)
                middle[cells->faces.item[i + j]] = false;
            i += 1 + k;
        }
}

tm_status tm_vtk_take_corners(tm_vtk_mesh *cells, bool *middle, size_t *higher_order,
                              tm_error *error)
{
    size_t to = 0, begin = 0;
    *higher_order = 0;
    for (size_t c = 0; c < cells->cells; c++) {
        const size_t end = cells->nodes.start[c + 1];
        cells->nodes.start[c] = begin;
        const tm_status status =
            cells->type[c] == TM_VTK_EMPTY ? TM_OK : check(cells, c, error);
        if (status != TM_OK)
            return status;
        const cell_type *t = &types[cells->type[c]];
        const size_t corners = t->corners ? t->corners : end - begin;
        for (size_t i = begin + corners; i < end; i++)
            middle[cells->nodes.item[i]] = true;
        *higher_order += corners < end - begin;
        reorder(cells->type[c], cells->nodes.item + begin);
        for (size_t i = 0; i < corners; i++)
            cells->nodes.item[to + i] = cells->nodes.item[begin + i];
        cells->type[c] = t->is;
        cells->nodes.start[c] = to;
        to += corners;
        begin = end;
    }
    cells->nodes.start[cells->cells] = to;
    take_back_corners(cells, middle);
    return TM_OK;
}
