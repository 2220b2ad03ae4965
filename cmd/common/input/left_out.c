/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "left_out.h"

#include "../../../lib/base/hash.h"
#include "../../../lib/mesh/cell_faces.h"
#include "../../../lib/stream/group.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a format has a place for, beside nodes and cells. */
enum {
    NODE_ATTRIBUTES = 1 << 0,
    NODE_MARKERS = 1 << 1,
    EDGES = 1 << 2,           /* with their markers */
    FACES = 1 << 3,           /* markers of .face and .facet: those above 0, and */
    FACES_BELOW_0 = 1 << 4,   /* those below */
    REGIONS = 1 << 5,         /* whole numbers from 0, */
    REGIONS_BELOW_0 = 1 << 6, /* others, and */
    OTHER_REGIONS = 1 << 7,   /* what is no whole number */
    ALL_REGIONS = REGIONS | REGIONS_BELOW_0 | OTHER_REGIONS,
    ATTRIBUTES = 1 << 8, /* of cells, but regions */
    NODE_NAMES = 1 << 9, /* in the order of tm_group_dimension */
    EDGE_NAMES = 1 << 10,
    FACE_NAMES = 1 << 11,
    REGION_NAMES = 1 << 12,
    NAMES = NODE_NAMES | EDGE_NAMES | FACE_NAMES | REGION_NAMES,
    PARTS = 1 << 13,      /* of .node, .ele, .face, .edge and .group */
    TETRAHEDRA = 1 << 14, /* .ele whatever else there is, and nothing else */
    OF_CELLS = ALL_REGIONS | ATTRIBUTES | REGION_NAMES,
    OF_MEDIT = NODE_MARKERS | EDGES | FACES | FACES_BELOW_0 | REGIONS | REGIONS_BELOW_0,
    GROUPS_OF_FACES = FACES | FACES_BELOW_0 | FACE_NAMES | OF_CELLS
};

/* One row for each exporter, of one of several formats for each of them; of one that has
 * none all is left out. OFF, STL, PLY and OBJ are of faces alone, and .oct of octants:
 * what nodes and cells have is not asked for there, but for the regions of --regions. */
static const struct {
    const char *format;
    unsigned keeps;
} formats[] = {
    {"abaqus-export",
     NODE_MARKERS | FACES | FACES_BELOW_0 | REGIONS | REGIONS_BELOW_0 | NAMES},
    {"getfem-export", FACES | REGIONS | FACE_NAMES | REGION_NAMES},
    {"gmsh-export bdf", EDGES | FACES | REGIONS},
    {"gmsh-export cgns", NODE_MARKERS | EDGES | FACES | REGIONS | NAMES},
    {"gmsh-export inp", EDGES | FACES | REGIONS | EDGE_NAMES | FACE_NAMES | REGION_NAMES},
    {"gmsh-export key", EDGES | FACES | REGIONS | EDGE_NAMES | FACE_NAMES | REGION_NAMES},
    {"gmsh-export med", NODE_MARKERS | EDGES | FACES | REGIONS | NAMES},
    {"gmsh-export mesh", EDGES | FACES | REGIONS},
    {"gmsh-export msh1", NODE_MARKERS | EDGES | FACES | REGIONS},
    {"gmsh-export msh2", NODE_MARKERS | EDGES | FACES | REGIONS | NAMES},
    {"gmsh-export msh4", NODE_MARKERS | EDGES | FACES | REGIONS | NAMES},
    {"gmsh-export msh40", NODE_MARKERS | EDGES | FACES | REGIONS | NAMES},
    {"gmsh-export su2", FACES | FACE_NAMES},
    {"gmsh-export unv", EDGES | FACES | REGIONS | EDGE_NAMES | FACE_NAMES | REGION_NAMES},
    {"m3d-export", 0},
    {"medit-export", OF_MEDIT | NAMES},
    {"medit-export --binary", OF_MEDIT},
    {"medit-export --binary --sol", OF_MEDIT | NODE_ATTRIBUTES},
    {"medit-export --sol", OF_MEDIT | NAMES | NODE_ATTRIBUTES},
    {"mesh-view", ~0u & ~(unsigned)(PARTS | TETRAHEDRA)},
    {"mvm-export", 0},
    {"obj-export", GROUPS_OF_FACES},
    {"obj-export --regions", OF_CELLS},
    {"oct-export", NODE_ATTRIBUTES | NODE_MARKERS | EDGES | ALL_REGIONS | ATTRIBUTES},
    {"off-export", OF_CELLS},
    {"off-export --regions", ATTRIBUTES},
    {"openfoam-export",
     FACES | FACES_BELOW_0 | REGIONS | REGIONS_BELOW_0 | FACE_NAMES | REGION_NAMES},
    {"ply-export", GROUPS_OF_FACES},
    {"ply-export --regions", OF_CELLS},
    {"stl-export", GROUPS_OF_FACES},
    {"stl-export --regions", OF_CELLS},
    {"stl-export --binary", OF_CELLS},
    {"stl-export --binary --regions", ATTRIBUTES},
    {"tetgen-export", NODE_ATTRIBUTES | NODE_MARKERS | EDGES | FACES | FACES_BELOW_0 |
                          ALL_REGIONS | ATTRIBUTES | NAMES | PARTS | TETRAHEDRA},
    {"visf-export", 0},
    {"vtk-export", ~0u & ~(unsigned)(PARTS | TETRAHEDRA)},
    {"vtu-export", ~0u & ~(unsigned)(PARTS | TETRAHEDRA)},
};

typedef struct finder {
    const tm_stream *stream;
    tm_content content;
    unsigned keeps;
    tm_text text; /* what was found, with ", " between */
} finder;

static unsigned kept_by(const char *format)
{
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (strcmp(formats[i].format, format) == 0)
            return formats[i].keeps;
    return 0;
}

/* Whether the format has all of these: then nobody need look for them. */
static bool is_kept(const finder *find, unsigned places)
{
    return (find->keeps & places) == places;
}

/* Adds "COUNT WHAT (BLOCK)" where there are some and the format has no place for them. */
static void add(finder *find, unsigned place, size_t count, const char *what,
                const char *block)
{
    if (count > 0 && !(find->keeps & place))
        tm_text_format(&find->text, "%s%zu %s (%s)", find->text.size > 0 ? ", " : "",
                       count, what, block);
}

/* The markers of a block ------------------------------------------------------------ */

static size_t count_markers(const tm_block *block, bool below)
{
    size_t count = 0;
    for (size_t r = 0; r < block->count; r++)
        count += below ? block->marker[r] < 0 : block->marker[r] > 0;
    return count;
}

/* 1 or -1 where all markers are that or 0, else 0. */
static int32_t only_marker(const tm_block *block)
{
    int32_t only = 0;
    for (size_t r = 0; r < block->count; r++) {
        const int32_t marker = block->marker[r];
        if (marker == 0)
            continue;
        if ((marker != 1 && marker != -1) || (only != 0 && marker != only))
            return 0;
        only = marker;
    }
    return only;
}

static bool is_inside(const tm_block *block, size_t r)
{
    return block->kind == TM_FACET && block->integer[2 * r + 1] != TM_NONE;
}

/* A number of an edge that hardly another one has. */
static uint64_t edge_hash(uint32_t a, uint32_t b)
{
    return tm_hash(tm_hash(0, a < b ? a : b), a < b ? b : a);
}

/* Whether the marked faces are those of the whole boundary, as far as that is seen
 * without the cells: all that are listed for the boundary, each edge an even number of
 * times. */
static bool is_boundary(const finder *find, const tm_block *block)
{
    uint64_t odd = 0;
    for (size_t r = 0, k; r < block->count; r++) {
        if (is_inside(block, r) != (block->marker[r] == 0))
            return false;
        if (block->marker[r] == 0)
            continue;
        const uint32_t *node = tm_row_nodes(block, r, &k);
        for (size_t i = 0; i < k; i++)
            odd ^= edge_hash(node[i], node[(i + 1) % k]);
    }
    return odd == 0 || find->content == TM_CONTENT_SURFACE;
}

static void add_faces(finder *find, const char *name)
{
    const tm_block *block = tm_stream_find(find->stream, name);
    if (!block || !block->marker || is_kept(find, FACES | FACES_BELOW_0))
        return;
    if (only_marker(block) != 0 && is_boundary(find, block))
        return;
    add(find, FACES, count_markers(block, false), "markers of faces", name);
    add(find, FACES_BELOW_0, count_markers(block, true), "markers of faces below 0",
        name);
}

static void add_edges(finder *find)
{
    const tm_block *block = tm_stream_find(find->stream, ".edge");
    if (!block || !block->marker || is_kept(find, EDGES))
        return;
    const size_t marked = count_markers(block, false) + count_markers(block, true);
    if (only_marker(block) == 0 || marked < block->count)
        add(find, EDGES, marked, "marked edges", block->name);
}

/* Whether the marked nodes are those of the rows of a block at the boundary; of no rows
 * true: who knows. */
static bool marks_nodes_of(const tm_block *node, const tm_block *block)
{
    unsigned char *at_boundary = calloc(node->count + 1, 1);
    bool same = at_boundary != NULL;
    for (size_t r = 0, k; same && r < block->count; r++) {
        const uint32_t *corner = tm_row_nodes(block, r, &k);
        for (size_t i = 0; i < k && !is_inside(block, r); i++)
            at_boundary[corner[i]] = 1;
    }
    for (size_t v = 0; v < node->count && same; v++)
        same = at_boundary[v] == (node->marker[v] != 0);
    free(at_boundary);
    return same;
}

bool mesh_marks_boundary_nodes(const tm_stream *stream)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_content content = tm_content_of(stream);
    const tm_block *face =
        tm_stream_find(stream, content == TM_CONTENT_POLYHEDRA ? ".facet" : ".face");
    const bool has_faces = face && face->count > 0;
    return node && node->marker && only_marker(node) != 0 &&
           content != TM_CONTENT_POINTS && (!has_faces || marks_nodes_of(node, face));
}

/* A mesh of octree-mesh, which has the surface as a part, or what polyhedra are made of
 * it. */
static bool is_of_octree(const tm_stream *stream)
{
    return tm_stream_find(stream, ".octant") ||
           (tm_stream_find(stream, ".cell") && tm_stream_find(stream, "surface.face"));
}

static void add_nodes(finder *find)
{
    const tm_block *node = tm_stream_find(find->stream, ".node");
    if (!node)
        return;
    const size_t octree_mesh = is_of_octree(find->stream) ? 1 : 0;
    if (node->count > 0 && node->attributes > octree_mesh)
        add(find, NODE_ATTRIBUTES, node->attributes - octree_mesh, "attributes of nodes",
            node->name);
    if (!node->marker || is_kept(find, NODE_MARKERS))
        return;
    if (mesh_marks_boundary_nodes(find->stream))
        return;
    add(find, NODE_MARKERS, count_markers(node, false) + count_markers(node, true),
        "markers of nodes", node->name);
}

/* Cells ------------------------------------------------------------------------------ */

/* A region 1 of all cells is as good as none. */
static void add_regions(finder *find, const tm_block *cell)
{
    const size_t at = tm_group_region_attribute(cell);
    size_t whole = 0, below = 0, others = 0, ones = 0;
    for (size_t c = 0; c < cell->count; c++) {
        const double region = cell->attribute[c * cell->attributes + at];
        const bool is_whole = region == floor(region);
        whole += is_whole && region > 0;
        below += is_whole && region < 0;
        others += !is_whole;
        ones += region == 1;
    }
    if (ones == cell->count)
        return;
    add(find, REGIONS, whole, "regions of cells", cell->name);
    add(find, REGIONS_BELOW_0, below, "regions of cells below 0", cell->name);
    add(find, OTHER_REGIONS, others, "regions of cells that are no whole numbers",
        cell->name);
}

static void add_attributes(finder *find, const tm_block *cell)
{
    const size_t at = tm_group_region_attribute(cell);
    if (at >= cell->attributes)
        return;
    if (!is_kept(find, ALL_REGIONS))
        add_regions(find, cell);
    add(find, ATTRIBUTES, cell->attributes - at - 1, "other attributes of cells",
        cell->name);
}

/* The block whose cells the format takes, and the others that have some. */
static void add_cells(finder *find)
{
    static const char *const name[] = {".ele", ".mix", ".cell"};
    const tm_block *taken = find->keeps & TETRAHEDRA
                                ? tm_stream_find(find->stream, ".ele")
                                : tm_content_block(find->stream, find->content);
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        const tm_block *block = tm_stream_find(find->stream, name[i]);
        if (block && block == taken)
            add_attributes(find, block);
        else if (block)
            add(find, 0, block->count, "cells", block->name);
    }
}

/* Names, and whole blocks -------------------------------------------------------------
 */

static void add_names(finder *find)
{
    static const char *const of[] = {"names of nodes", "names of edges", "names of faces",
                                     "names of regions"};
    const tm_block *group = tm_stream_find(find->stream, ".group");
    size_t count[TM_GROUP_DIMENSIONS] = {0};
    for (size_t g = 0; group && g < group->count; g++)
        count[tm_group_dimension_of(group, g)]++;
    for (unsigned d = 0; d < TM_GROUP_DIMENSIONS; d++)
        add(find, (unsigned)NODE_NAMES << d, count[d], of[d], ".group");
}

static bool is_left_out(const finder *find, const tm_block *block)
{
    static const char surface[] = "surface.";
    if (block->name[0] == '.')
        return block->kind == TM_UNKNOWN;
    if (find->keeps & PARTS && (block->kind <= TM_EDGE || block->kind == TM_GROUP))
        return false;
    return !is_of_octree(find->stream) ||
           strncmp(block->name, surface, sizeof surface - 1) != 0;
}

/* "2 blocks (surface.node, .notes)" */
static void add_blocks(finder *find)
{
    tm_text names = {0};
    size_t count = 0;
    for (size_t b = 0; b < find->stream->blocks; b++) {
        const tm_block *block = &find->stream->block[b];
        if (is_left_out(find, block))
            tm_text_format(&names, count++ > 0 ? ", %s" : "%s", block->name);
    }
    if (count > 0 && names.byte)
        add(find, 0, count, count > 1 ? "blocks" : "block", names.byte);
    tm_text_free(&names);
}

/* ------------------------------------------------------------------------------------ */

void mesh_leave_out(const filter *f, const tm_stream *stream)
{
    mesh_leave_out_of(f, stream, f->name);
}

void mesh_leave_out_of(const filter *f, const tm_stream *stream, const char *format)
{
    finder find = {
        .stream = stream, .content = tm_content_of(stream), .keeps = kept_by(format)};
    add_nodes(&find);
    add_cells(&find);
    add_faces(&find, ".face");
    add_faces(&find, ".facet");
    add_edges(&find);
    add_names(&find);
    add_blocks(&find);
    if (find.text.failed)
        filter_fail_memory(f);
    if (find.text.size > 0)
        filter_leave_out(f, "%s", find.text.byte);
    tm_text_free(&find.text);
}
