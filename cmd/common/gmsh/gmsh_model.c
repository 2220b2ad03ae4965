/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_model.h"

#include "../../../lib/base/array.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static tm_status read_named(const gmsh_source *source, int records, tm_error *error)
{
    gmsh_link link;
    tm_status status = gmsh_link_make(&link, source->fd, source->suffix, error);
    if (status != TM_OK)
        return status;
    gmsh_reading reading = {source, link.path, records};
    status = gmsh_child_run(gmsh_read_records, &reading, &source->limits, error);
    if (status != TM_OK)
        gmsh_link_hide(&link, error->what, strlen(error->what) + 1);
    gmsh_link_remove(&link);
    return status;
}

static bool add_name(gmsh_name **list, size_t *count, const gmsh_record *record)
{
    gmsh_name *moved = realloc(*list, (*count + 1) * sizeof *moved);
    if (!moved)
        return false;
    *list = moved;
    moved[(*count)++] = (gmsh_name){record->dimension, record->tag, record->count,
                                    (const char *)(record + 1)};
    return true;
}

static bool add_run(gmsh_model *model, const gmsh_record *record)
{
    gmsh_run *moved = realloc(model->run, (model->runs + 1) * sizeof *moved);
    if (!moved)
        return false;
    const size_t *tag = (const size_t *)(record + 1);
    model->run = moved;
    moved[model->runs++] =
        (gmsh_run){record->dimension,       model->entities - 1, (size_t)record->nodes,
                   (size_t)record->corners, record->count,       tag,
                   tag + record->count};
    return true;
}

static bool add_entity(gmsh_model *model, const gmsh_record *record)
{
    gmsh_entity *moved = realloc(model->entity, (model->entities + 1) * sizeof *moved);
    if (!moved)
        return false;
    model->entity = moved;
    moved[model->entities++] =
        (gmsh_entity){record->dimension, record->tag,   record->parent_dimension,
                      record->parent,    record->count, (const int *)(record + 1)};
    return true;
}

static bool add_record(gmsh_model *model, const gmsh_record *record)
{
    switch (record->kind) {
    case GMSH_NODES:
        model->nodes = record->count;
        model->node_tag = (const size_t *)(record + 1);
        model->xyz = (const void *)(model->node_tag + record->count);
        return true;
    case GMSH_RUN:
        return add_run(model, record);
    case GMSH_ENTITY:
        return add_entity(model, record);
    case GMSH_GROUP:
        return add_name(&model->group, &model->groups, record);
    case GMSH_NAME:
        return add_name(&model->name, &model->names, record);
    case GMSH_WARNING:
        return add_name(&model->warning, &model->warnings, record);
    default:
        return add_name(&model->other, &model->others, record);
    }
}

/* Whether elements of a dimension can have so many corners. */
static bool has_corners(int dimension, int corners)
{
    static const unsigned char least[] = {1, 2, 3, 4}, most[] = {1, 2, 4, 8};
    return corners >= least[dimension] && corners <= most[dimension] && corners != 7;
}

/* How many bytes the contents of a record are, SIZE_MAX where its numbers are wrong. A
 * damaged file may have overwritten anything in the child. */
static size_t contents(const gmsh_record *record)
{
    enum { MOST = 1 << 20 };
    size_t each = 1;
    if (record->kind < GMSH_NODES || record->kind > GMSH_OTHER)
        return SIZE_MAX;
    if (record->dimension < 0 || record->dimension >= GMSH_DIMENSIONS)
        return SIZE_MAX;
    if (record->kind == GMSH_NODES)
        each = sizeof(size_t) + 3 * sizeof(double);
    else if (record->kind == GMSH_ENTITY)
        each = sizeof(int);
    else if (record->kind == GMSH_RUN && record->nodes > 0 && record->nodes < MOST &&
             record->corners <= record->nodes &&
             has_corners(record->dimension, record->corners))
        each = sizeof(size_t) * (1 + (size_t)record->nodes);
    else if (record->kind == GMSH_RUN)
        return SIZE_MAX;
    return record->count > SIZE_MAX / 2 / each ? SIZE_MAX : record->count * each;
}

static tm_status take_records(gmsh_model *model, tm_error *error)
{
    const char *at = model->map, *end = at + model->size;
    while (at < end) {
        const gmsh_record *record = (const gmsh_record *)(const void *)at;
        const size_t left = (size_t)(end - at);
        if (left < sizeof *record || record->size > left ||
            record->size < sizeof *record || record->size % sizeof(double) != 0 ||
            contents(record) > record->size - sizeof *record ||
            (record->kind == GMSH_RUN && model->entities == 0))
            return tm_fail(error, TM_ERROR_INPUT,
                           "Gmsh gives nonsense (the file may be damaged)");
        if (!add_record(model, record))
            return tm_fail_memory(error);
        at += record->size;
    }
    return TM_OK;
}

static tm_status map_records(gmsh_model *model, int fd, tm_error *error)
{
    struct stat file;
    if (fstat(fd, &file) != 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot hold the mesh: %s",
                       strerror(errno));
    model->size = (size_t)file.st_size;
    if (model->size == 0)
        return TM_OK;
    model->map = mmap(NULL, model->size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, fd, 0);
    if (model->map != MAP_FAILED)
        return take_records(model, error);
    model->map = NULL;
    return tm_fail_memory(error);
}

tm_status gmsh_model_read(gmsh_model *model, const gmsh_source *source, tm_error *error)
{
    *model = (gmsh_model){0};
    const int fd = memfd_create("mesh", MFD_CLOEXEC);
    if (fd < 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot hold the mesh: %s",
                       strerror(errno));
    tm_status status = read_named(source, fd, error);
    if (status == TM_OK)
        status = map_records(model, fd, error);
    close(fd);
    return status;
}

void gmsh_model_free(gmsh_model *model)
{
    free(model->run);
    free(model->entity);
    free(model->group);
    free(model->name);
    free(model->warning);
    free(model->other);
    if (model->map)
        munmap(model->map, model->size);
    *model = (gmsh_model){0};
}
