/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From sets to markers and regions, and from the mesh to a stream, by way of VTK's
 * grid. */
#include "../../base/array.h"
#include "../../element/shape.h"
#include "../vtk/vtk_cells.h"
#include "inp_groups.h"
#include "inp_mesh.h"
#include "inp_sets.h"

#include <stdlib.h>
#include <string.h>

/* How much a group counts: one that holds all only for what is in no other, and the names
 * that Gmsh gives to entities only for what is in none of those. */
typedef enum weight { STRONG, OF_ALL, OF_GMSH } weight;

typedef struct turn {
    weight weight;
    uint32_t same, group;
} turn;

typedef struct maker {
    tm_inp_model model;
    tm_inp_mesh mesh;
    tm_inp_groups groups;
    tm_inp_walk walk;
    turn *turn; /* [groups.groups]: in the order in which they are walked */
    tm_inp_classes nodes, elements, faces;
    tm_error *error;
    uint32_t group;  /* that is walked */
    bool only_free;  /* it is a weak one */
    uint32_t *stamp; /* of nodes, elements or faces: the last group + 1 of each */
    size_t stamp_room, stamps;
} maker;

/* Members --------------------------------------------------------------------------- */

/* Whether an item is met for the first time in the group that is counted. */
static bool is_new(maker *m, uint32_t item, bool *failed)
{
    if (item >= m->stamps) {
        uint32_t *moved =
            tm_grow(m->stamp, &m->stamp_room, (size_t)item + 1, sizeof *moved);
        *failed = !moved;
        if (!moved)
            return false;
        m->stamp = moved;
        memset(moved + m->stamps, 0, (m->stamp_room - m->stamps) * sizeof *moved);
        m->stamps = m->stamp_room;
    }
    const bool first = m->stamp[item] != m->group + 1;
    m->stamp[item] = m->group + 1;
    return first;
}

static const tm_inp_set *set_of(const maker *m)
{
    return &m->model.set[m->groups.group[m->group].set];
}

/* What a member is: an item of a dimension; of none where a surface names no face. */
static tm_status item_of(maker *m, uint32_t member, int face, uint32_t *item,
                         int *dimension)
{
    const tm_inp_set_kind kind = set_of(m)->kind;
    *item = member;
    *dimension = 0;
    if (kind == TM_INP_NODES)
        return TM_OK;
    *dimension = m->mesh.type[member].dimension;
    if (kind == TM_INP_ELEMENTS) {
        if (*dimension == 0)
            *item = TM_INP_NONE;
        if (*dimension == 2)
            *item = m->mesh.face_of[member];
        return TM_OK;
    }
    *dimension = 2;
    return tm_inp_mesh_face(&m->mesh, member, face, item);
}

/* Nodes, elements and faces are counted in groups of their kind alone: one array of
 * stamps does. Faces and elements of a set of elements are told apart. */
static tm_status count_member(void *context, uint32_t member, int face)
{
    maker *m = context;
    uint32_t item;
    int d;
    bool failed = false;
    const tm_status status = item_of(m, member, face, &item, &d);
    if (status != TM_OK)
        return status;
    if (item == TM_INP_NONE) {
        m->model.report->no_faces += set_of(m)->kind == TM_INP_FACES;
        return TM_OK;
    }
    const uint32_t stamp = set_of(m)->kind == TM_INP_ELEMENTS ? member : item;
    m->groups.group[m->group].count[d] += is_new(m, stamp, &failed);
    return failed ? tm_fail_memory(m->error) : TM_OK;
}

static tm_status put_member(void *context, uint32_t member, int face)
{
    maker *m = context;
    uint32_t item;
    int d;
    const tm_status status = item_of(m, member, face, &item, &d);
    if (status != TM_OK || item == TM_INP_NONE)
        return status;
    tm_inp_classes *classes = d == 0 ? &m->nodes : d == 2 ? &m->faces : &m->elements;
    return tm_inp_classes_put(classes, item, m->groups.group[m->group].same, m->only_free,
                              m->error);
}

static tm_status walk_group(maker *m, uint32_t group, tm_inp_member *take)
{
    const tm_inp_group *is = &m->groups.group[group];
    m->group = group;
    m->walk.take = take;
    m->walk.context = m;
    m->walk.count_missing = take == count_member;
    return tm_inp_walk_set(&m->walk, is->set, is->instance);
}

/* Weights --------------------------------------------------------------------------- */

/* Volume1, Surface12, Line3: what Gmsh calls entities. */
static bool is_of_gmsh(tm_word name)
{
    static const char *const entity[] = {"Volume", "Surface", "Line", "Point"};
    for (size_t i = 0; i < sizeof entity / sizeof *entity; i++) {
        const size_t size = strlen(entity[i]);
        if (name.size > size && memcmp(name.begin, entity[i], size) == 0 &&
            strspn(name.begin + size, "0123456789") >= name.size - size)
            return true;
    }
    return false;
}

/* How many items of each dimension there are. */
static void count_all(const maker *m, size_t all[TM_GROUP_DIMENSIONS])
{
    memset(all, 0, TM_GROUP_DIMENSIONS * sizeof *all);
    all[TM_GROUP_NODES] = m->mesh.nodes;
    for (size_t e = 0; e < m->mesh.elements; e++)
        if (m->mesh.type[e].dimension % 2 == 1)
            all[m->mesh.type[e].dimension]++;
    all[TM_GROUP_FACES] = m->mesh.faces.count;
}

/* Whether a group has all of each dimension that it has any of. */
static bool has_all(const tm_inp_group *group, const size_t all[TM_GROUP_DIMENSIONS])
{
    bool any = false;
    for (int d = 0; d < TM_GROUP_DIMENSIONS; d++) {
        if (group->count[d] > 0 && group->count[d] < all[d])
            return false;
        any |= group->count[d] > 0;
    }
    return any;
}

static int compare_turns(const void *a, const void *b)
{
    const turn *p = a, *q = b;
    if (p->weight != q->weight)
        return p->weight < q->weight ? -1 : 1;
    if (p->same != q->same)
        return p->same < q->same ? -1 : 1;
    return (p->group > q->group) - (p->group < q->group);
}

static tm_status find_turns(maker *m)
{
    size_t all[TM_GROUP_DIMENSIONS];
    const size_t count = m->groups.groups;
    m->turn = tm_new(count, sizeof *m->turn);
    if (!m->turn)
        return tm_fail_memory(m->error);
    count_all(m, all);
    for (uint32_t g = 0; g < count; g++) {
        const tm_inp_group *group = &m->groups.group[g];
        const tm_inp_set *set = &m->model.set[group->set];
        m->turn[g] = (turn){STRONG, group->same, g};
        const bool is_said = set->dimension >= 0 && m->groups.joined.count > 0;
        const bool is_material = set->is_of_section && !tm_inp_says_nothing(set);
        if (set->kind != TM_INP_FACES && has_all(group, all) && !is_said && !is_material)
            m->turn[g].weight = OF_ALL;
        if (set->kind == TM_INP_ELEMENTS && is_of_gmsh(set->name))
            m->turn[g].weight = OF_GMSH;
    }
    qsort(m->turn, count, sizeof *m->turn, compare_turns);
    return TM_OK;
}

/* Values ---------------------------------------------------------------------------- */

static tm_status count_members(maker *m)
{
    tm_status status = tm_inp_groups_find(&m->groups, &m->model);
    if (status == TM_OK)
        status = tm_inp_walk_new(&m->walk, &m->model);
    for (uint32_t g = 0; g < m->groups.groups && status == TM_OK; g++)
        status = walk_group(m, g, count_member);
    return status;
}

static tm_status put_members(maker *m)
{
    tm_status status = find_turns(m);
    if (status == TM_OK)
        status = tm_inp_classes_new(&m->nodes, m->mesh.nodes, m->error);
    if (status == TM_OK)
        status = tm_inp_classes_new(&m->elements, m->mesh.elements, m->error);
    if (status == TM_OK)
        status = tm_inp_classes_new(&m->faces, m->mesh.faces.count, m->error);
    for (size_t t = 0; t < m->groups.groups && status == TM_OK; t++) {
        m->only_free = m->turn[t].weight != STRONG;
        status = walk_group(m, m->turn[t].group, put_member);
    }
    return status;
}

static void mark_used(maker *m)
{
    for (size_t v = 0; v < m->mesh.nodes; v++)
        m->nodes.class[m->nodes.of[v]].is_used[TM_GROUP_NODES] = true;
    for (size_t e = 0; e < m->mesh.elements; e++)
        m->elements.class[m->elements.of[e]].is_used[m->mesh.type[e].dimension] = true;
    for (size_t f = 0; f < m->mesh.faces.count; f++)
        m->faces.class[m->faces.of[f]].is_used[TM_GROUP_FACES] = true;
}

static void count_used(maker *m, const tm_inp_classes *classes)
{
    for (size_t c = 1; c < classes->classes; c++)
        for (int d = 0; d < TM_GROUP_DIMENSIONS; d++)
            for (size_t p = c; p != 0 && classes->class[c].is_used[d];
                 p = classes->class[p].parent)
                m->groups.group[classes->class[p].group].count[d] = 1;
}

/* A group that no item has alone, nor with others, has no name. */
static void drop_unused(maker *m)
{
    for (size_t g = 0; g < m->groups.groups; g++)
        memset(m->groups.group[g].count, 0, sizeof m->groups.group[g].count);
    count_used(m, &m->nodes);
    count_used(m, &m->elements);
    count_used(m, &m->faces);
}

static tm_status find_values(maker *m)
{
    size_t *several = &m->model.report->several;
    tm_status status = count_members(m);
    if (status == TM_OK)
        status = put_members(m);
    if (status != TM_OK)
        return status;
    mark_used(m);
    drop_unused(m);
    status = tm_inp_groups_name(&m->groups);
    if (status == TM_OK)
        status = tm_inp_classes_name(&m->nodes, &m->groups, several);
    if (status == TM_OK)
        status = tm_inp_classes_name(&m->elements, &m->groups, several);
    if (status == TM_OK)
        status = tm_inp_classes_name(&m->faces, &m->groups, several);
    return status;
}

/* The grid -------------------------------------------------------------------------- */

static int32_t value_of(const tm_inp_classes *classes, size_t item, int dimension)
{
    return classes->class[classes->of[item]].value[dimension];
}

static bool has_values(const tm_inp_classes *classes, int dimension)
{
    for (size_t c = 1; c < classes->classes; c++)
        if (classes->class[c].is_used[dimension])
            return true;
    return false;
}

static tm_status add_cell(tm_vtk_mesh *grid, const uint32_t *node, size_t k, uint8_t type,
                          tm_error *error)
{
    uint32_t *to = tm_lists_room(&grid->nodes, k);
    if (!to)
        return tm_fail_memory(error);
    memcpy(to, node, k * sizeof *to);
    grid->open = k;
    return tm_vtk_end_cell(grid, type, error);
}

/* Elements, faces that surfaces name, and lines. *cells[c] is the item of cell c. */
static tm_status add_cells(maker *m, tm_vtk_mesh *grid)
{
    enum { TRIANGLE = 3 };
    const tm_inp_mesh *mesh = &m->mesh;
    size_t shells = 0;
    tm_status status = TM_OK;
    for (size_t e = 0; e < mesh->elements && status == TM_OK; e++) {
        const size_t begin = mesh->of.start[e];
        shells += mesh->type[e].dimension == 2 && mesh->face_of[e] >= shells;
        if (mesh->type[e].dimension > 0)
            status = add_cell(grid, mesh->of.item + begin, mesh->of.start[e + 1] - begin,
                              mesh->type[e].vtk, m->error);
    }
    for (size_t f = shells; f < mesh->faces.count && status == TM_OK; f++) {
        const size_t begin = mesh->faces.start[f], k = mesh->faces.start[f + 1] - begin;
        status =
            add_cell(grid, mesh->faces.item + begin, k,
                     k == TRIANGLE ? TM_VTK_TRIANGLE : TM_VTK_QUADRILATERAL, m->error);
    }
    return status;
}

/* The values of cells of dimension 3, or of the others. */
static void set_values(const maker *m, const tm_vtk_mesh *grid, bool regions,
                       double *value)
{
    const tm_inp_mesh *mesh = &m->mesh;
    size_t c = 0, shells = 0;
    for (size_t e = 0; e < mesh->elements; e++) {
        const int d = mesh->type[e].dimension;
        if (d == 0)
            continue;
        value[c] = 0;
        if (d == 3 && regions)
            value[c] = value_of(&m->elements, e, d);
        if (d == 1 && !regions)
            value[c] = value_of(&m->elements, e, d);
        if (d == 2) {
            shells += mesh->face_of[e] >= shells;
            value[c] = regions ? 0 : value_of(&m->faces, mesh->face_of[e], d);
        }
        c++;
    }
    for (size_t f = shells; c < grid->cells; f++, c++)
        value[c] = regions ? 0 : value_of(&m->faces, f, TM_GROUP_FACES);
}

/* An array of `count` numbers; NULL where memory is out. */
static double *add_data(tm_vtk_mesh *grid, tm_vtk_data_list *list, const char *name,
                        size_t count)
{
    tm_vtk_data *data = tm_vtk_data_named(grid, list, name, true);
    if (!data)
        return NULL;
    data->components = 1;
    data->whole = true;
    data->value = tm_new(count, sizeof *data->value);
    return data->value;
}

static tm_status add_values(maker *m, tm_vtk_mesh *grid)
{
    const bool has_markers =
        has_values(&m->faces, TM_GROUP_FACES) || has_values(&m->elements, TM_GROUP_EDGES);
    for (int regions = 0; regions < 2; regions++) {
        if (regions ? !has_values(&m->elements, TM_GROUP_REGIONS) : !has_markers)
            continue;
        double *value =
            add_data(grid, &grid->cell_data, regions ? "region" : "marker", grid->cells);
        if (!value)
            return tm_fail_memory(m->error);
        set_values(m, grid, regions, value);
    }
    if (!has_values(&m->nodes, TM_GROUP_NODES))
        return TM_OK;
    double *value = add_data(grid, &grid->point_data, "marker", grid->points);
    if (!value)
        return tm_fail_memory(m->error);
    for (size_t v = 0; v < grid->points; v++)
        value[v] = value_of(&m->nodes, v, TM_GROUP_NODES);
    return TM_OK;
}

static tm_status make_grid(maker *m, tm_vtk_mesh *grid)
{
    tm_status status = tm_vtk_mesh_new(grid, m->model.text.name, m->error);
    if (status != TM_OK)
        return status;
    grid->xyz = m->mesh.xyz;
    grid->points = m->mesh.nodes;
    m->mesh.xyz = NULL;
    status = add_cells(m, grid);
    return status == TM_OK ? add_values(m, grid) : status;
}

/* ------------------------------------------------------------------------------------ */

static void take_report(tm_abaqus_report *report, const tm_vtk_read_report *grid)
{
    report->turned = grid->turned;
    report->cut = grid->cut;
    report->higher_order = grid->higher_order;
    report->middle_nodes = grid->middle_nodes;
    report->loose = grid->loose;
}

static tm_status make_stream(maker *m, tm_stream *stream)
{
    static const tm_vtk_read_options options = {.threads = 1};
    tm_vtk_read_report report = {0};
    tm_vtk_mesh grid = {0};
    tm_status status = make_grid(m, &grid);
    if (status == TM_OK)
        status = tm_vtk_mesh_to_stream(&grid, stream, &options, &report, m->error);
    tm_vtk_mesh_free(&grid);
    take_report(m->model.report, &report);
    tm_vtk_read_report_free(&report);
    if (status == TM_OK)
        status = tm_group_to_stream(&m->groups.named, stream, ".group", m->error);
    if (status != TM_OK)
        tm_stream_free(stream);
    stream->base = 1;
    return status;
}

static void free_maker(maker *m)
{
    tm_inp_classes_free(&m->nodes);
    tm_inp_classes_free(&m->elements);
    tm_inp_classes_free(&m->faces);
    tm_inp_walk_free(&m->walk);
    tm_inp_groups_free(&m->groups);
    tm_inp_mesh_free(&m->mesh);
    tm_inp_model_free(&m->model);
    free(m->turn);
    free(m->stamp);
}

void tm_abaqus_report_free(tm_abaqus_report *report)
{
    tm_text_free(&report->types);
}

tm_status tm_abaqus_read(tm_stream *stream, const char *bytes, size_t size,
                         const char *name, tm_abaqus_report *report, tm_error *error)
{
    maker m = {.error = error};
    *report = (tm_abaqus_report){0};
    tm_status status = tm_inp_model_new(&m.model, report, error);
    if (status == TM_OK)
        status = tm_inp_read(&m.model, bytes, size, name);
    if (status == TM_OK) {
        report->instances = m.model.instances - 1;
        tm_inp_mark_surfaces(&m.model);
        status = tm_inp_mesh_make(&m.mesh, &m.model);
    }
    if (status == TM_OK)
        status = find_values(&m);
    if (status == TM_OK)
        status = make_stream(&m, stream);
    if (status == TM_OK && report->types.failed)
        status = tm_fail_memory(error);
    free_maker(&m);
    return status;
}
