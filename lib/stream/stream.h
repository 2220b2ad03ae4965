/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The termesh stream, version 1: see termesh-stream(5). One reader and one writer for
 * all filters. A stream in memory is its history and its blocks, in the order in which
 * they came; a block is a header and flat arrays. */
#ifndef TM_STREAM_STREAM_H
#define TM_STREAM_STREAM_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../base/progress.h"
#include "../text/text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

typedef enum tm_block_kind {
    TM_NODE,   /* .node    real: x y z */
    TM_ELE,    /* .ele     integer: 4 nodes */
    TM_FACE,   /* .face    integer: 3 nodes */
    TM_EDGE,   /* .edge    integer: 2 nodes */
    TM_MIX,    /* .mix     item: the nodes of each element, 4, 5, 6 or 8 */
    TM_OCTANT, /* .octant  integer: level x y z e1 e2 */
    TM_ROOT,   /* .root    real: x y z side; integer: finest level */
    TM_FACET,  /* .facet   integer: c1 c2 (TM_NONE for -1); item: nodes of each */
    TM_CELL,   /* .cell    item: the facets of each */
    TM_GROUP,  /* .group   names of markers and regions: see group.h */
    TM_UNKNOWN /* anything else: text */
} tm_block_kind;

enum { TM_BLOCK_NAME = 64 };

/* The most attributes of a row: more are taken for a damaged header. */
enum { TM_ATTRIBUTES_MAX = 1000 };

/* An index that refers to nothing. */
#define TM_NONE UINT32_MAX

/* Indices are 0-based here, whatever the stream's base. Arrays are malloc'ed and belong
 * to the block; those that the kind does not have are NULL (see tm_block_kind). */
typedef struct tm_block {
    char name[TM_BLOCK_NAME]; /* as it stands in the stream: ".ele", "surface.node" */
    tm_block_kind kind;
    size_t count;      /* rows */
    size_t attributes; /* reals per row, after what the kind has */
    bool markers;      /* the rows end with an integer marker */
    double *real;      /* [count][tm_block_reals(kind)] */
    uint32_t *integer; /* [count][tm_block_integers(kind)] */
    size_t *start;  /* [count + 1]: the list of row r is item[start[r] … start[r+1]) */
    uint32_t *item; /* [start[count]] */
    double *attribute; /* [count][attributes], or NULL where there are none */
    int32_t *marker;   /* [count], or NULL where there are none */
    tm_text text;      /* TM_UNKNOWN: the lines, to be passed on unchanged; TM_GROUP */
} tm_block;

typedef struct tm_stream {
    unsigned base;   /* the first index in the text: 0 or 1 */
    tm_text history; /* whole lines, each "# …\n" */
    size_t blocks;
    tm_block *block;
    const tm_progress *progress; /* told when it is read and written; may be NULL */
} tm_stream;

/* Fixed columns of a row: how many reals, how many integers. */
size_t tm_block_reals(tm_block_kind kind);
size_t tm_block_integers(tm_block_kind kind);

/* The nodes of row r of .ele, .face, .edge, .mix or .facet, and how many there are. */
static inline const uint32_t *tm_row_nodes(const tm_block *block, size_t r, size_t *k)
{
    if (block->start) {
        *k = block->start[r + 1] - block->start[r];
        return block->item + block->start[r];
    }
    *k = tm_block_integers(block->kind);
    return block->integer + *k * r;
}

/* The kind that a name says: by what follows its last dot. */
tm_block_kind tm_block_kind_of(const char *name);

/* An empty stream: base 1, no blocks. tm_stream_free() gives back all that it holds and
 * leaves it empty. */
void tm_stream_init(tm_stream *stream);
void tm_stream_free(tm_stream *stream);

/* Reads a whole stream from fd up to its .end and what may follow it. `name` is the
 * file's for messages. Checks every promise of the format: numbering, ranges of all
 * indices, finite numbers, that it is complete. *stream must be empty; after an error it
 * is again, and *error says file, line, block and cause: TM_ERROR_INPUT for what is
 * wrong in the text, TM_ERROR_SYSTEM for read errors and memory. Memory grows with the
 * rows that were read, not with the counts that are claimed. threads >= 1 read it, always
 * with the same result. O(bytes). */
tm_status tm_stream_read(tm_stream *stream, int fd, const char *name, unsigned threads,
                         tm_error *error);

/* Writes a stream to fd; threads >= 1 format it, always the same bytes. TM_ERROR_SYSTEM
 * where writing fails, or memory is out: a part may be written then, without .end.
 * O(bytes). */
tm_status tm_stream_write(const tm_stream *stream, int fd, unsigned threads,
                          tm_error *error);

/* Writes a block as a file of its own: its header and its rows, numbered from base. What
 * that gives for .node, .ele, .face and .edge is a TetGen file. Errors as above. */
tm_status tm_block_write(const tm_block *block, unsigned base, int fd, unsigned threads,
                         tm_error *error);

/* The block of that name, or NULL. Pointers to blocks hold until blocks are added or
 * removed. */
tm_block *tm_stream_find(const tm_stream *stream, const char *name);

/* Appends an empty block of that name, which must not be there yet; its kind is by the
 * name. NULL where memory is out. */
tm_block *tm_stream_add(tm_stream *stream, const char *name);

/* Puts a block where the one of its name is, or appends it. Its arrays are the stream's
 * then, and *made has those that were there, or none. TM_ERROR_SYSTEM where memory is
 * out: nothing has changed then. */
tm_status tm_stream_put(tm_stream *stream, tm_block *made, tm_error *error);

/* Removes a block and frees what it holds. */
void tm_stream_remove(tm_stream *stream, tm_block *block);

/* Removes all blocks that a test says, the others keep their order. O(blocks). */
typedef bool tm_block_test(const tm_block *block, const void *context);
void tm_stream_remove_if(tm_stream *stream, tm_block_test *gone, const void *context);

/* Allocates the arrays of a block for `count` rows (and `items` list items) by its kind,
 * attributes and markers; the arrays that were there are freed. Contents are zero. */
tm_status tm_block_allocate(tm_block *block, size_t count, size_t items, tm_error *error);

/* Frees the arrays; name, kind, attributes and markers stay. */
void tm_block_clear(tm_block *block);

/* Gives the rows one attribute more, value[count], after those that they have.
 * TM_ERROR_SYSTEM where memory is out: nothing has changed then. */
tm_status tm_block_add_attribute(tm_block *block, const double *value, tm_error *error);

/* Takes attribute `which` from the rows, from 0: there is one. */
void tm_block_drop_attribute(tm_block *block, size_t which);

/* Appends "# line\n" to the history, or nothing where memory is out; line breaks inside
 * become blanks. */
tm_status tm_stream_add_history(tm_stream *stream, const char *line, tm_error *error);

TM_EXTERN_C_END

#endif
