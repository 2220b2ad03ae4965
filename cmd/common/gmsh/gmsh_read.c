/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file by Gmsh's library into records (gmsh_model.h). Only the child runs this, which
 * ends soon: what Gmsh allocates is given back where it is large. */
#include "gmsh_model.h"

#include "../../../lib/text/file.h"

#include <gmshc.h>
#include <stdlib.h>
#include <string.h>

/* Contents of a record, in one piece or two. */
typedef struct piece {
    const void *bytes;
    size_t size;
} piece;

static tm_status write_record(int fd, gmsh_record record, piece first, piece second,
                              tm_error *error)
{
    static const char zero[sizeof(double)] = "";
    const size_t size = first.size + second.size;
    const size_t padding = -size % sizeof zero;
    record.size = sizeof record + size + padding;
    tm_status status = tm_write_all(fd, (const char *)&record, sizeof record, error);
    if (status == TM_OK && first.size > 0)
        status = tm_write_all(fd, first.bytes, first.size, error);
    if (status == TM_OK && second.size > 0)
        status = tm_write_all(fd, second.bytes, second.size, error);
    return status == TM_OK ? tm_write_all(fd, zero, padding, error) : status;
}

static tm_status write_name(int fd, gmsh_record record, const char *name, tm_error *error)
{
    record.count = strlen(name);
    return write_record(fd, record, (piece){name, record.count}, (piece){0}, error);
}

static tm_status write_nodes(int fd, tm_error *error)
{
    size_t *tag = NULL, tags = 0, reals = 0, parameters = 0;
    double *xyz = NULL, *parameter = NULL;
    int failed;
    gmshModelMeshGetNodes(&tag, &tags, &xyz, &reals, &parameter, &parameters, -1, -1, 0,
                          0, &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_INPUT, error);
    const gmsh_record record = {.kind = GMSH_NODES, .count = tags};
    const tm_status status = write_record(fd, record, (piece){tag, tags * sizeof *tag},
                                          (piece){xyz, 3 * tags * sizeof *xyz}, error);
    gmshFree(tag);
    gmshFree(xyz);
    gmshFree(parameter);
    return status;
}

/* Elements ------------------------------------------------------------------------- */

/* The corners of the elements that a stream has, by the first word of what Gmsh calls
 * them; 0 of others. */
static int corners_of(const char *name)
{
    static const struct {
        const char *name;
        int corners;
    } kinds[] = {{"Point", 1},  {"Line ", 2},    {"Triangle ", 3}, {"Quadrilateral ", 4},
                 {"Tetrah", 4}, {"Pyramid ", 5}, {"Prism ", 6},    {"Hexahedron ", 8}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strncmp(name, kinds[i].name, strlen(kinds[i].name)) == 0)
            return kinds[i].corners;
    return 0;
}

/* One type of the elements of an entity. */
static tm_status write_run(int fd, int type, gmsh_record record, const size_t *tag,
                           const size_t *node, size_t nodes, tm_error *error)
{
    char *name = NULL;
    int failed, dimension = 0, order = 0, each = 0, primary = 0;
    double *local = NULL;
    size_t locals = 0;
    gmshModelMeshGetElementProperties(type, &name, &dimension, &order, &each, &local,
                                      &locals, &primary, &failed);
    if (failed && !gmsh_says_why())
        return gmsh_fail(TM_ERROR_SYSTEM, error);
    const int corners = failed ? 0 : corners_of(name);
    tm_status status = TM_OK;
    if (corners > 0 && corners <= each && record.count * (size_t)each == nodes) {
        record.nodes = each;
        record.corners = corners;
        status = write_record(fd, record, (piece){tag, record.count * sizeof *tag},
                              (piece){node, nodes * sizeof *node}, error);
    } else {
        record.kind = GMSH_OTHER;
        record.tag = (int)record.count;
        status = write_name(fd, record,
                            failed ? "elements of a kind without a name" : name, error);
    }
    gmshFree(name);
    gmshFree(local);
    return status;
}

static tm_status write_elements(int fd, int dimension, int entity, tm_error *error)
{
    int *type = NULL, failed;
    size_t types = 0, **tag = NULL, *tags = NULL, tag_lists = 0;
    size_t **node = NULL, *nodes = NULL, node_lists = 0;
    gmshModelMeshGetElements(&type, &types, &tag, &tags, &tag_lists, &node, &nodes,
                             &node_lists, dimension, entity, &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_INPUT, error);
    tm_status status = TM_OK;
    for (size_t i = 0; i < types; i++) {
        const gmsh_record record = {
            .kind = GMSH_RUN, .dimension = dimension, .tag = entity, .count = tags[i]};
        if (status == TM_OK)
            status = write_run(fd, type[i], record, tag[i], node[i], nodes[i], error);
        gmshFree(tag[i]);
        gmshFree(node[i]);
    }
    gmshFree(type);
    gmshFree(tag);
    gmshFree(tags);
    gmshFree(node);
    gmshFree(nodes);
    return status;
}

/* Entities and names --------------------------------------------------------------- */

static tm_status write_entity(int fd, int dimension, int tag, tm_error *error)
{
    gmsh_record record = {.kind = GMSH_ENTITY, .dimension = dimension, .tag = tag};
    int *group = NULL, failed;
    gmshModelGetPhysicalGroupsForEntity(dimension, tag, &group, &record.count, &failed);
    if (!failed)
        gmshModelGetParent(dimension, tag, &record.parent_dimension, &record.parent,
                           &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_INPUT, error);
    tm_status status = write_record(
        fd, record, (piece){group, record.count * sizeof *group}, (piece){0}, error);
    char *name = NULL;
    gmshModelGetEntityName(dimension, tag, &name, &failed);
    record = (gmsh_record){.kind = GMSH_NAME, .dimension = dimension, .tag = tag};
    if (status == TM_OK && !failed && name && *name)
        status = write_name(fd, record, name, error);
    gmshFree(group);
    gmshFree(name);
    return status;
}

static tm_status write_entities(int fd, tm_error *error)
{
    int *pair = NULL, failed;
    size_t numbers = 0;
    gmshModelGetEntities(&pair, &numbers, -1, &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_INPUT, error);
    tm_status status = TM_OK;
    for (size_t i = 0; i + 1 < numbers && status == TM_OK; i += 2) {
        status = write_entity(fd, pair[i], pair[i + 1], error);
        if (status == TM_OK)
            status = write_elements(fd, pair[i], pair[i + 1], error);
    }
    gmshFree(pair);
    return status;
}

static tm_status write_groups(int fd, tm_error *error)
{
    int *pair = NULL, failed;
    size_t numbers = 0;
    gmshModelGetPhysicalGroups(&pair, &numbers, -1, &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_INPUT, error);
    tm_status status = TM_OK;
    for (size_t i = 0; i + 1 < numbers && status == TM_OK; i += 2) {
        char *name = NULL;
        gmshModelGetPhysicalName(pair[i], pair[i + 1], &name, &failed);
        const gmsh_record record = {
            .kind = GMSH_GROUP, .dimension = pair[i], .tag = pair[i + 1]};
        if (!failed && name && *name)
            status = write_name(fd, record, name, error);
        gmshFree(name);
    }
    gmshFree(pair);
    return status;
}

static tm_status write_warnings(int fd, tm_error *error)
{
    static const char level[] = "Warning: ";
    char **line = NULL;
    size_t lines = 0;
    int failed;
    gmshLoggerGet(&line, &lines, &failed);
    tm_status status = TM_OK;
    for (size_t i = 0; !failed && i < lines && status == TM_OK; i++)
        if (strncmp(line[i], level, sizeof level - 1) == 0)
            status = write_name(fd, (gmsh_record){.kind = GMSH_WARNING},
                                line[i] + sizeof level - 1, error);
    return status;
}

tm_status gmsh_read_records(void *context, tm_error *error)
{
    const gmsh_reading *reading = context;
    int failed;
    gmshOptionSetNumber("Mesh.SwitchElementTags", reading->source->swap_tags, &failed);
    if (!failed)
        gmshOptionSetNumber("Mesh.MedSingleModel", 1, &failed);
    if (!failed)
        gmshMerge(reading->path, &failed);
    if (failed)
        return gmsh_fail(TM_ERROR_INPUT, error);
    tm_status status = write_nodes(reading->fd, error);
    if (status == TM_OK)
        status = write_entities(reading->fd, error);
    if (status == TM_OK)
        status = write_groups(reading->fd, error);
    return status == TM_OK ? write_warnings(reading->fd, error) : status;
}
