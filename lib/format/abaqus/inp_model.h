/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an input file says, before names and ids are looked up. Words are in the file's
 * bytes, which have to stay. */
#ifndef TM_FORMAT_ABAQUS_INP_MODEL_H
#define TM_FORMAT_ABAQUS_INP_MODEL_H

#include "../../base/hash.h"
#include "../../mesh/polyhedra.h"
#include "../../stream/group.h"
#include "abaqus.h"
#include "inp_text.h"
#include "inp_types.h"

/* Ids in a part: which row has one. Rank r is the row with the r-th id. */
typedef struct tm_inp_ids {
    size_t count, room;
    int32_t *id;     /* [count], by row */
    uint32_t *order; /* [count]: the row of a rank; NULL: ids ascend, ranks are rows */
    uint32_t *rank;  /* [count]: the rank of a row; or NULL */
} tm_inp_ids;

/* Nodes and elements whose ids are a world of their own: a part, an instance with a mesh
 * of its own, or, the first scope, what is outside of those. */
typedef struct tm_inp_scope {
    tm_word name;
    tm_inp_ids nodes, elements;
    double (*xyz)[3];  /* [nodes.count] */
    tm_inp_type *type; /* [elements.count] */
    tm_lists of;       /* the ids of nodes of each element, in VTK's order */
    size_t xyz_room, type_room;
} tm_inp_scope;

/* A scope in its place. The first instance is the first scope. */
typedef struct tm_inp_instance {
    tm_word name;
    size_t scope, line;
    tm_word part;
    bool is_moved, is_turned;
    double move[3];
    double axis[2][3], degrees;
    size_t first_node, first_element; /* of the whole */
} tm_inp_instance;

typedef enum tm_inp_members {
    TM_INP_IDS,   /* of a surface: pairs, of an id and a face */
    TM_INP_ROWS,  /* rows of nodes or elements of the scope */
    TM_INP_RANGE, /* three numbers of id[]: first, last, step */
    TM_INP_LINE,  /* a line in which there are names */
    TM_INP_OF     /* the nodes of the elements of a set of that name */
} tm_inp_members;

#define TM_INP_NONE UINT32_MAX

/* Some members of a set. */
typedef struct tm_inp_chunk {
    tm_inp_members kind;
    uint32_t next;     /* chunk of the set; TM_INP_NONE */
    uint32_t instance; /* word of the name of one; TM_INP_NONE */
    uint32_t line;
    union {
        struct {
            size_t first, count; /* in id[], or rows */
        } range;
        tm_word row;
    } is;
} tm_inp_chunk;

typedef enum tm_inp_set_kind {
    TM_INP_NODES,
    TM_INP_ELEMENTS,
    TM_INP_FACES
} tm_inp_set_kind;

typedef struct tm_inp_set {
    tm_inp_set_kind kind;
    uint32_t scope;
    tm_word name;
    bool is_internal;   /* only others need it */
    bool is_of_surface; /* a surface names it */
    bool is_of_section; /* a section of a material does */
    int dimension;      /* that abaqus-export says, -1: none */
    int32_t value;      /* likewise */
    uint32_t first, last;
} tm_inp_set;

typedef struct tm_inp_model {
    tm_inp_text text;
    tm_abaqus_report *report;
    tm_error *error;
    tm_status status; /* of what returned NULL last */
    size_t scopes, scope_room;
    tm_inp_scope *scope;
    size_t instances, instance_room;
    tm_inp_instance *instance;
    size_t sets, set_room;
    tm_inp_set *set;
    tm_hash_table by_name; /* of sets, for hash_room of them */
    size_t hash_room;
    size_t chunks, chunk_room;
    tm_inp_chunk *chunk;
    size_t ids, id_room;
    int32_t *id;
    size_t words, word_room;
    tm_word *word;
    size_t sections, section_room;
    tm_word *section; /* names of sets, of the scope before each */
    uint32_t *section_scope;
    size_t section_scope_room;
    tm_block group; /* what comments of abaqus-export say */
} tm_inp_model;

/* A model with the first scope and its instance. */
tm_status tm_inp_model_new(tm_inp_model *model, tm_abaqus_report *report,
                           tm_error *error);
void tm_inp_model_free(tm_inp_model *model);

/* Adds what has no members yet; the set of that name may be there before. NULL where
 * memory is out, which the error says. */
tm_inp_scope *tm_inp_add_scope(tm_inp_model *model, tm_word name);
tm_inp_instance *tm_inp_add_instance(tm_inp_model *model, tm_word name);
tm_inp_set *tm_inp_add_set(tm_inp_model *model, tm_inp_set_kind kind, size_t scope,
                           tm_word name);

/* The set of that name, in capitals or not, or NULL. Expected O(size of the name). */
tm_inp_set *tm_inp_find_set(const tm_inp_model *model, tm_inp_set_kind kind, size_t scope,
                            tm_word name);

/* Adds a chunk to a set; NULL where memory is out. */
tm_inp_chunk *tm_inp_add_chunk(tm_inp_model *model, tm_inp_set *set, tm_inp_members kind);

bool tm_inp_same_name(tm_word a, tm_word b);

/* Adds an id; sorts them, which says which is there twice: `what` is "node". */
bool tm_inp_ids_add(tm_inp_ids *ids, int32_t id);
tm_status tm_inp_ids_sort(tm_inp_ids *ids, const tm_inp_model *model, const char *what);

/* The rank of an id; TM_INP_NONE where it is not there. O(1) where ids are without gaps,
 * else O(log n). The first rank whose id is not below. */
uint32_t tm_inp_ids_find(const tm_inp_ids *ids, int32_t id);
size_t tm_inp_ids_from(const tm_inp_ids *ids, int32_t id);

static inline uint32_t tm_inp_row(const tm_inp_ids *ids, size_t rank)
{
    return ids->order ? ids->order[rank] : (uint32_t)rank;
}

static inline uint32_t tm_inp_rank(const tm_inp_ids *ids, size_t row)
{
    return ids->rank ? ids->rank[row] : (uint32_t)row;
}

/* inp_read.c: reads the whole text. */
tm_status tm_inp_read(tm_inp_model *model, const char *bytes, size_t size,
                      const char *name);

#endif
