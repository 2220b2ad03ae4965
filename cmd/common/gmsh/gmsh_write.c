/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Only the child runs most of this (gmsh_child.h); it writes to memory: Gmsh does not see
 * where a disk is full. */
#include "gmsh_write.h"

#include "../../../lib/base/array.h"
#include "../../../lib/element/shape.h"
#include "../../../lib/text/file.h"
#include "gmsh_groups.h"

#include <errno.h>
#include <gmshc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <unistd.h>

/* Bits for cells of 4, 5, 6 and 8 nodes. */
enum {
    TET = 1 << TM_TET_NODES,
    PYRAMID = 1 << TM_PYRAMID_NODES,
    WEDGE = 1 << TM_WEDGE_NODES,
    HEX = 1 << TM_HEX_NODES,
    ALL = TET | PYRAMID | WEDGE | HEX
};

/* Fields of 8 characters; of 10, which Gmsh reads with a blank between; and parts whose
 * number is that of the group and a million for each dimension. */
enum { FIELD_OF_8 = 99999999, FIELD_OF_9 = 999999999, BELOW_PART = 999999 };

const gmsh_output_format gmsh_output_formats[GMSH_OUTPUTS] = {
    [GMSH_MSH4] = {"msh4", "msh41", true, true, 16, ALL, INT32_MAX, SIZE_MAX},
    [GMSH_MSH40] = {"msh40", "msh40", false, true, 16, ALL, INT32_MAX, SIZE_MAX},
    [GMSH_MSH2] = {"msh2", "msh22", true, true, 16, ALL, INT32_MAX, SIZE_MAX},
    [GMSH_MSH1] = {"msh1", "msh1", false, true, 16, ALL, INT32_MAX, SIZE_MAX},
    [GMSH_TO_MEDIT] = {"mesh", "mesh", false, false, 14, TET | HEX, INT32_MAX, SIZE_MAX},
    [GMSH_TO_INP] = {"inp", "inp", false, false, 14, TET | WEDGE | HEX, INT32_MAX,
                     SIZE_MAX},
    [GMSH_TO_BDF] = {"bdf", "bdf", false, false, 9, ALL, FIELD_OF_8, FIELD_OF_8},
    [GMSH_TO_UNV] = {"unv", "unv", false, false, 17, TET | WEDGE | HEX, FIELD_OF_9,
                     FIELD_OF_9},
    [GMSH_TO_SU2] = {"su2", "su2", false, false, 16, ALL, INT32_MAX, SIZE_MAX},
    [GMSH_TO_KEY] = {"key", "key", false, false, 12, ALL, BELOW_PART, SIZE_MAX},
    [GMSH_TO_MED] = {"med", "med", false, true, 17, ALL, INT32_MAX, SIZE_MAX},
    [GMSH_TO_CGNS] = {"cgns", "cgns", false, true, 17, ALL, INT32_MAX, SIZE_MAX},
};

gmsh_output gmsh_output_of(const char *name)
{
    static const struct {
        const char *suffix;
        gmsh_output format;
    } suffixes[] = {{"msh", GMSH_MSH4},    {"msh4", GMSH_MSH4},     {"msh41", GMSH_MSH4},
                    {"msh40", GMSH_MSH40}, {"msh2", GMSH_MSH2},     {"msh22", GMSH_MSH2},
                    {"msh1", GMSH_MSH1},   {"mesh", GMSH_TO_MEDIT}, {"inp", GMSH_TO_INP},
                    {"bdf", GMSH_TO_BDF},  {"nas", GMSH_TO_BDF},    {"unv", GMSH_TO_UNV},
                    {"su2", GMSH_TO_SU2},  {"key", GMSH_TO_KEY},    {"k", GMSH_TO_KEY},
                    {"med", GMSH_TO_MED},  {"cgns", GMSH_TO_CGNS}};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof suffixes / sizeof *suffixes; i++)
        if (strcasecmp(dot + 1, suffixes[i].suffix) == 0)
            return suffixes[i].format;
    return GMSH_OUTPUTS;
}

/* Gmsh's numbers of types, by dimension and nodes. */
static int type_of(int dimension, size_t nodes)
{
    static const int cell[] = {[TM_TET_NODES] = 4,
                               [TM_PYRAMID_NODES] = 7,
                               [TM_WEDGE_NODES] = 6,
                               [TM_HEX_NODES] = 5};
    enum { POINT = 15, LINE = 1, TRIANGLE = 2, QUADRILATERAL = 3 };
    if (dimension == GMSH_CELLS)
        return cell[nodes];
    if (dimension == GMSH_FACES)
        return nodes == 3 ? TRIANGLE : QUADRILATERAL;
    return dimension == GMSH_LINES ? LINE : POINT;
}

/* The model ------------------------------------------------------------------------ */

typedef struct writer {
    const gmsh_plan *plan;
    gmsh_output format;
    bool binary;
    const char *path;
    size_t first[GMSH_DIMENSIONS]; /* the number of each dimension's first element */
} writer;

/* All nodes, in their order, of one entity of the highest dimension that there is. */
static tm_status add_nodes(const gmsh_plan *plan, tm_error *error)
{
    int failed, d = GMSH_CELLS;
    while (d > GMSH_POINTS && plan->items[d] == 0)
        d--;
    const size_t count = plan->items[d] > 0 ? plan->node->count : 0;
    size_t *tag = tm_new(count, sizeof *tag);
    if (!tag)
        return tm_fail_memory(error);
    for (size_t v = 0; v < count; v++)
        tag[v] = v + 1;
    if (count > 0)
        gmshModelMeshAddNodes(d, plan->value[d][0].number, tag, count, plan->node->real,
                              3 * count, NULL, 0, &failed);
    free(tag);
    return count > 0 && failed ? gmsh_fail(TM_ERROR_SYSTEM, error) : TM_OK;
}

/* The nodes of an item, from 1, in Gmsh's order: the triangle 0 1 2 of a wedge turns the
 * other way, see shape.h. */
static void set_nodes(const gmsh_item *item, size_t count, size_t *to)
{
    const uint8_t *wedge = tm_element_shapes[TM_WEDGE_NODES].mirror;
    size_t nodes;
    if (item->block->kind == TM_NODE) {
        to[0] = item->row + 1;
        return;
    }
    const uint32_t *node = tm_row_nodes(item->block, item->row, &nodes);
    for (size_t i = 0; i < count; i++)
        to[i] = (size_t)node[count == TM_WEDGE_NODES ? wedge[i] : i] + 1;
}

static size_t count_nodes(const gmsh_item *item)
{
    size_t count = 1;
    if (item->block->kind != TM_NODE)
        tm_row_nodes(item->block, item->row, &count);
    return count;
}

/* Items that follow each other and have the same group and number of nodes. */
static tm_status add_elements(const writer *w, int d, size_t begin, size_t end,
                              tm_error *error)
{
    const gmsh_item *item = w->plan->item[d];
    const size_t nodes = count_nodes(&item[begin]), count = end - begin;
    size_t *tag = tm_new(count, sizeof *tag);
    size_t *node = tm_new(count * nodes, sizeof *node);
    int failed = 1;
    if (!tag || !node) {
        free(tag);
        free(node);
        return tm_fail_memory(error);
    }
    for (size_t i = 0; i < count; i++) {
        tag[i] = w->first[d] + item[begin + i].order;
        set_nodes(&item[begin + i], nodes, node + i * nodes);
    }
    gmshModelMeshAddElementsByType(w->plan->value[d][item[begin].group].number,
                                   type_of(d, nodes), tag, count, node, count * nodes,
                                   &failed);
    free(tag);
    free(node);
    return failed ? gmsh_fail(TM_ERROR_SYSTEM, error) : TM_OK;
}

static tm_status add_items(const writer *w, int d, tm_error *error)
{
    const gmsh_item *item = w->plan->item[d];
    tm_status status = TM_OK;
    for (size_t begin = 0, end; begin < w->plan->items[d] && status == TM_OK;
         begin = end) {
        const size_t nodes = count_nodes(&item[begin]);
        end = begin + 1;
        while (end < w->plan->items[d] && item[end].group == item[begin].group &&
               count_nodes(&item[end]) == nodes)
            end++;
        status = add_elements(w, d, begin, end, error);
    }
    return status;
}

static tm_status add_entities(const gmsh_plan *plan, int d, tm_error *error)
{
    int failed = 0;
    for (size_t i = 0; i < plan->values[d] && !failed; i++)
        gmshModelAddDiscreteEntity(d, plan->value[d][i].number, NULL, 0, &failed);
    return failed ? gmsh_fail(TM_ERROR_SYSTEM, error) : TM_OK;
}

void gmsh_change_quotes(char *name)
{
    for (char *at = name; (at = strchr(at, '"'));)
        *at = '\'';
}

/* The name of a group as Gmsh writes it: in quotes. */
static tm_status set_name(const gmsh_plan *plan, int d, int32_t value, int32_t group,
                          tm_error *error)
{
    const char *known = tm_group_find(plan->names, (tm_group_dimension)d, value);
    int failed;
    if (!known)
        return TM_OK;
    char *name = strdup(known);
    if (!name)
        return tm_fail_memory(error);
    gmsh_change_quotes(name);
    gmshModelSetPhysicalName(d, group, name, &failed);
    free(name);
    return failed ? gmsh_fail(TM_ERROR_SYSTEM, error) : TM_OK;
}

/* A group and its entity. */
typedef struct member {
    int32_t group, value;
    int entity;
} member;

static int compare_members(const void *a, const void *b)
{
    const member *p = a, *q = b;
    if (p->group != q->group)
        return p->group < q->group ? -1 : 1;
    return (p->entity > q->entity) - (p->entity < q->entity);
}

/* The pairs of a group and an entity of one dimension, by group; malloc'ed. */
static member *find_members(const gmsh_plan *plan, int d, size_t *members)
{
    *members = 0;
    for (size_t i = 0; i < plan->values[d]; i++)
        *members += plan->value[d][i].groups;
    member *list = tm_new(*members, sizeof *list);
    size_t m = 0;
    for (size_t i = 0; list && i < plan->values[d]; i++) {
        const gmsh_value *value = &plan->value[d][i];
        for (size_t g = 0; g < value->groups; g++)
            list[m++] = (member){value->group[g],
                                 value->groups > 1 ? value->group[g] : value->value,
                                 value->number};
    }
    if (list && m > 0)
        qsort(list, m, sizeof *list, compare_members);
    return list;
}

static tm_status add_groups(const gmsh_plan *plan, int d, tm_error *error)
{
    size_t members;
    member *list = find_members(plan, d, &members);
    int *entity = tm_new(members, sizeof *entity), failed;
    tm_status status = list && entity ? TM_OK : tm_fail_memory(error);
    for (size_t i = 0, end; status == TM_OK && i < members; i = end) {
        for (end = i; end < members && list[end].group == list[i].group; end++)
            entity[end - i] = list[end].entity;
        gmshModelAddPhysicalGroup(d, entity, end - i, list[i].group, &failed);
        status = failed ? gmsh_fail(TM_ERROR_SYSTEM, error)
                        : set_name(plan, d, list[i].value, list[i].group, error);
    }
    free(list);
    free(entity);
    return status;
}

static tm_status make_model(writer *w, tm_error *error)
{
    const gmsh_plan *plan = w->plan;
    tm_status status = TM_OK;
    size_t number = 1;
    for (int d = 0; d < GMSH_DIMENSIONS && status == TM_OK; d++) {
        w->first[d] = number;
        number += plan->items[d];
        status = add_entities(plan, d, error);
    }
    if (status == TM_OK)
        status = add_nodes(plan, error);
    for (int d = 0; d < GMSH_DIMENSIONS && status == TM_OK; d++)
        status = add_items(w, d, error);
    for (int d = 0; d < GMSH_DIMENSIONS && status == TM_OK; d++)
        status = add_groups(plan, d, error);
    return status;
}

/* The file ------------------------------------------------------------------------- */

/* Options that are not what is wanted, or may be others in another version. Of .msh 4
 * nodes have numbers of their own, and can be given to the entities that they are on;
 * other formats number them as they come. */
static void set_options(const writer *w, int *failed)
{
    const struct {
        const char *name;
        double value;
    } options[] = {
        {"Mesh.Binary", w->binary},
        {"Mesh.SaveAll", 0},
        {"Mesh.SaveElementTagType", 2}, /* the physical group */
        {"Mesh.SaveGroupsOfElements", 1},
        {"Mesh.SaveGroupsOfNodes", w->format == GMSH_TO_INP || w->format == GMSH_TO_KEY},
        {"Mesh.BdfFieldFormat", 2}}; /* the longest */
    *failed = 0;
    for (size_t i = 0; i < sizeof options / sizeof *options && !*failed; i++)
        gmshOptionSetNumber(options[i].name, options[i].value, failed);
    if (!*failed && (w->format == GMSH_MSH4 || w->format == GMSH_MSH40))
        gmshModelMeshReclassifyNodes(failed);
}

static tm_status write_file(void *context, tm_error *error)
{
    writer *w = context;
    int failed;
    gmshModelAdd("termesh", &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_SYSTEM, error);
    const tm_status status = make_model(w, error);
    if (status != TM_OK)
        return status;
    set_options(w, &failed);
    if (!failed)
        gmshWrite(w->path, &failed);
    return failed ? gmsh_fail(TM_ERROR_SYSTEM, error) : TM_OK;
}

/* What Gmsh has written to the file in memory; near its begin its path may stand. */
static tm_status read_back(tm_text *text, int fd, const gmsh_link *link, tm_error *error)
{
    enum { HEAD = 4096 };
    if (lseek(fd, 0, SEEK_SET) != 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot read the output: %s",
                       strerror(errno));
    tm_status status = tm_read_all(fd, "output", text, error);
    if (status != TM_OK)
        return status;
    if (text->size == 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "Gmsh wrote nothing");
    const size_t head = text->size < HEAD ? text->size : HEAD;
    const size_t less = head - gmsh_link_hide(link, text->byte, head);
    memmove(text->byte + head - less, text->byte + head, text->size - head);
    text->size -= less;
    return TM_OK;
}

tm_status gmsh_write(tm_text *text, const gmsh_plan *plan, gmsh_output format,
                     bool binary, tm_error *error)
{
    writer w = {.plan = plan, .format = format, .binary = binary};
    const int fd = memfd_create("output", MFD_CLOEXEC);
    if (fd < 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot hold the output: %s",
                       strerror(errno));
    gmsh_link link;
    const gmsh_limits limits = {0};
    tm_status status =
        gmsh_link_make(&link, fd, gmsh_output_formats[format].suffix, error);
    if (status != TM_OK) {
        close(fd);
        return status;
    }
    w.path = link.path;
    status = gmsh_child_run(write_file, &w, &limits, error);
    if (status == TM_OK)
        status = read_back(text, fd, &link, error);
    else
        gmsh_link_hide(&link, error->what, strlen(error->what) + 1);
    gmsh_link_remove(&link);
    close(fd);
    return status;
}
