/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is true of every stream that the library reads, however it came about. Choices are
 * those of ../unit/random.h, or of targets/bytes.h where that is included before. */
#ifndef TESTS_FUZZ_STREAM_CHECKS_H
#define TESTS_FUZZ_STREAM_CHECKS_H

#include "../../lib/examine/element_examine.h"
#include "../../lib/examine/poly/poly_examine.h"
#include "../../lib/examine/poly/poly_statistics.h"
#include "../../lib/tet/improve/improve.h"
#include "../../lib/tet/lepp/lepp.h"
#include "../unit/random.h"

#include <math.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

_Noreturn static inline void give_up(const char *what)
{
    perror(what);
    exit(EXIT_FAILURE);
}

static inline void require(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "fuzz: %s\n", what);
    abort();
}

static inline tm_status read_bytes(tm_stream *stream, const char *bytes, size_t size,
                                   tm_error *error)
{
    int fd = memfd_create("fuzz", MFD_CLOEXEC);
    if (fd < 0 || write(fd, bytes, size) != (ssize_t)size || lseek(fd, 0, SEEK_SET) != 0)
        give_up("memfd_create");
    tm_stream_init(stream);
    tm_status status = tm_stream_read(stream, fd, "case", 1, error);
    close(fd);
    return status;
}

static inline void write_bytes(const tm_stream *stream, tm_text *text)
{
    tm_error error;
    int fd = memfd_create("fuzz", MFD_CLOEXEC);
    require(tm_stream_write(stream, fd, 1, &error) == TM_OK, "a stream is not written");
    lseek(fd, 0, SEEK_SET);
    struct stat status;
    fstat(fd, &status);
    char *bytes = malloc((size_t)status.st_size + 1);
    if (!bytes || read(fd, bytes, (size_t)status.st_size) != status.st_size)
        give_up("read");
    tm_text_append(text, bytes, (size_t)status.st_size);
    free(bytes);
    close(fd);
}

/* What was read is written; that is read again, and written as the same bytes. */
static inline void check_round_trip(const tm_stream *stream)
{
    tm_text first = {0}, second = {0};
    tm_stream again;
    tm_error error;
    write_bytes(stream, &first);
    require(read_bytes(&again, first.byte, first.size, &error) == TM_OK,
            "what was written is not read");
    write_bytes(&again, &second);
    require(first.size == second.size && memcmp(first.byte, second.byte, first.size) == 0,
            "written, read and written again it is other bytes");
    tm_stream_free(&again);
    tm_text_free(&first);
    tm_text_free(&second);
}

/* Whether swap-centroid ends soon: needles it cuts into millions. */
static inline bool is_compact(const tm_tet_mesh *mesh)
{
    static const double most = 100, steps = 16;
    for (size_t v = 0; v < mesh->nodes; v++)
        for (int i = 0; i < 3; i++) {
            double x = mesh->xyz[v][i];
            if (fabs(x) > most || x * steps != floor(x * steps))
                return false;
        }
    return true;
}

/* Along paths, in one way or another. */
static inline tm_status improve_stars(tm_tet_mesh *mesh, tm_error *error)
{
    static const double factor = 1.1, angle = 30, growth = 4;
    tm_lepp_report report;
    tm_lepp_options options = {.algorithm = TM_LEPP_SELECTIVE,
                               .factor = factor,
                               .angle = angle,
                               .measure = random_below(2) ? TM_MEASURE_DIHEDRAL
                                                          : TM_MEASURE_VOLUME,
                               .path = random_below(2) ? TM_LEPP_SIMPLE : TM_LEPP_FULL,
                               .sweeps = random_below(4),
                               .stop = TM_LEPP_PASSES,
                               .passes = 2};
    if (random_below(2) && is_compact(mesh)) {
        options.sweeps = 0;
        options.max_growth = growth;
        options.algorithm = random_below(2) ? TM_LEPP_SWAP_CENTROID : TM_LEPP_DELAUNAY;
    }
    return tm_lepp_improve(mesh, &options, &report, error);
}

static inline tm_status improve_all(tm_tet_mesh *mesh, tm_error *error)
{
    static const double angle[] = {30, 45};
    tm_improve_report report;
    tm_improve_options options = {.angle = angle[random_below(2)],
                                  .measure = random_below(2) ? TM_MEASURE_DIHEDRAL
                                                             : TM_MEASURE_VOLUME,
                                  .ops = TM_IMPROVE_ALL_OPS,
                                  .max_growth = random_below(5) / 2.0};
    return tm_improve(mesh, &options, &report, error);
}

/* An improved mesh is a mesh. */
static inline void check_improvement(tm_stream *stream)
{
    tm_tet_mesh mesh;
    tm_error error;
    tm_status status = tm_tet_mesh_from_stream(&mesh, stream, 1, &error);
    if (status == TM_OK) {
        require(tm_tet_mesh_check(&mesh, &error) == TM_OK, "a mesh that is none");
        status =
            random_below(2) ? improve_stars(&mesh, &error) : improve_all(&mesh, &error);
        require(status == TM_OK, "the improvement fails");
        if (tm_tet_mesh_check(&mesh, &error) != TM_OK)
            require(false, error.what);
        require(tm_tet_mesh_to_stream(&mesh, stream, &error) == TM_OK,
                "the mesh is kept");
        check_round_trip(stream);
    } else {
        require(status == TM_ERROR_INPUT && error.what[0], "no mesh, but no reason");
        tm_tet_mesh_free(&mesh);
    }
}

/* Polyhedra that are wrong are examined and measured; what is said of them agrees. */
static inline void check_polyhedra(const tm_stream *stream)
{
    tm_examination found;
    tm_poly_statistics statistics;
    tm_error error;
    const tm_poly_arrays mesh = tm_poly_arrays_of(stream);
    require(tm_poly_examine(&found, &mesh, 1, &error) == TM_OK &&
                tm_poly_statistics_measure(&statistics, &mesh, 1, &error) == TM_OK,
            "polyhedra are not examined");
    const size_t wrong =
        found.defect[TM_UNCLOSED_EDGE].count + found.defect[TM_UNORIENTED_EDGE].count;
    require((wrong == 0) == (statistics.cause[TM_CAUSE_EDGE] == 0) &&
                statistics.swallowed == found.unused_nodes &&
                statistics.non_simple <= mesh.cells,
            "polyhedra are examined and measured differently");
}

/* Mixed elements that are wrong are examined, alike by each number of threads. */
static inline void check_mixed_elements(const tm_stream *stream)
{
    tm_examination found, again;
    const tm_mesh_view mesh = tm_mesh_view_of_mixed(stream);
    require(tm_element_examine(&found, &mesh, 1, NULL) == TM_OK &&
                tm_element_examine(&again, &mesh, 2, NULL) == TM_OK,
            "mixed elements are not examined");
    require(memcmp(found.defect, again.defect, sizeof found.defect) == 0 &&
                found.euler == again.euler && found.components <= mesh.elements &&
                found.unused_nodes <= mesh.nodes,
            "mixed elements are examined differently");
}

/* All of that of a stream, which is used up. */
static inline void check_stream(tm_stream *stream)
{
    check_round_trip(stream);
    check_polyhedra(stream);
    check_mixed_elements(stream);
    check_improvement(stream);
    tm_stream_free(stream);
}

static inline void check_bytes(const char *bytes, size_t size)
{
    tm_stream stream;
    tm_error error;
    if (read_bytes(&stream, bytes ? bytes : "", size, &error) == TM_OK)
        check_stream(&stream);
    else
        require(error.status == TM_ERROR_INPUT && error.what[0],
                "not read, but no reason");
}

#endif
