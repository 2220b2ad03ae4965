/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh as Gmsh has it: nodes and elements with their numbers (tags), by geometric
 * entity; entities with their physical groups; names. */
#ifndef CMD_COMMON_GMSH_MODEL_H
#define CMD_COMMON_GMSH_MODEL_H

#include "gmsh_child.h"

#include <stdbool.h>
#include <stddef.h>

/* Dimensions, as tm_group_dimension has them. */
enum { GMSH_POINTS, GMSH_LINES, GMSH_FACES, GMSH_CELLS, GMSH_DIMENSIONS };

/* Elements of one type of one entity. Element i has the nodes node[nodes i …], of which
 * the first `corners` are corners. */
typedef struct gmsh_run {
    int dimension;
    size_t entity; /* in the model's list */
    size_t nodes, corners;
    size_t count;
    const size_t *tag;  /* [count] */
    const size_t *node; /* [count][nodes] */
} gmsh_run;

typedef struct gmsh_entity {
    int dimension, tag;
    int parent_dimension, parent; /* of a part of an entity; -1: it is none */
    size_t groups;
    const int *group; /* its physical groups; below 0: turned about */
} gmsh_entity;

static inline bool gmsh_entity_is_part(const gmsh_entity *entity)
{
    return entity->parent >= 0 && entity->parent_dimension == entity->dimension;
}

/* The number of an entity, of a part that of the whole. */
static inline int gmsh_entity_whole(const gmsh_entity *entity)
{
    return gmsh_entity_is_part(entity) ? entity->parent : entity->tag;
}

/* Of a physical group, or of an entity. */
typedef struct gmsh_name {
    int dimension, tag;
    size_t size;
    const char *name; /* of `size` bytes, no NUL behind them */
} gmsh_name;

typedef struct gmsh_model {
    size_t nodes;
    const size_t *node_tag;
    const double *xyz; /* [nodes][3] */
    size_t runs, entities, groups, names, warnings, others;
    gmsh_run *run;
    gmsh_entity *entity;
    gmsh_name *group;
    gmsh_name *name;    /* of entities */
    gmsh_name *warning; /* what Gmsh said; dimension and tag are 0 */
    gmsh_name *other;   /* kinds of elements that a stream does not have, tag: how many */
    void *map;          /* what all but the lists is in */
    size_t size;
} gmsh_model;

/* How a file is read. */
typedef struct gmsh_source {
    int fd;             /* open for reading */
    const char *suffix; /* as which format: "msh", … */
    bool swap_tags;     /* of .msh before 4: entity and physical group are exchanged */
    gmsh_limits limits;
} gmsh_source;

/* Lets Gmsh read a file. TM_ERROR_INPUT with what Gmsh says where it cannot, or as
 * gmsh_child_run(). *model is {0} and to be freed, after an error too. */
tm_status gmsh_model_read(gmsh_model *model, const gmsh_source *source, tm_error *error);
void gmsh_model_free(gmsh_model *model);

/* For gmsh_model.c and gmsh_read.c. ---------------------------------------------------
 */

/* A model as a file is a list of records, each with its contents behind it, padded to 8
 * bytes. */
typedef enum gmsh_record_kind {
    GMSH_NODES, /* count tags, 3 count doubles */
    GMSH_RUN,   /* count tags, count times `nodes` tags of nodes */
    GMSH_ENTITY,
    GMSH_GROUP, /* a name */
    GMSH_NAME,
    GMSH_WARNING,
    GMSH_OTHER
} gmsh_record_kind;

typedef struct gmsh_record {
    int kind, dimension, tag;
    int parent_dimension, parent;
    int nodes, corners;
    int unused;
    size_t count; /* of what follows: elements, groups, bytes */
    size_t size;  /* bytes up to the next record */
} gmsh_record;

/* gmsh_read.c, in the child: reads the file `path` and writes its records to fd. */
typedef struct gmsh_reading {
    const gmsh_source *source;
    const char *path;
    int fd;
} gmsh_reading;
gmsh_work gmsh_read_records;

#endif
