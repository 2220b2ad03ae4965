/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poisson [--dg] [--wave] [FILE]: solves Poisson's equation on the polyhedra of a stream
 * by virtual elements (vem.h), with --dg by a discontinuous Galerkin method (dg.h), both
 * of lowest order, and prints how many unknowns that took and how far it is from the
 * known solution (solution.h).
 *
 * That is linear, and has to be found but for rounding, on any mesh whose cells are
 * closed by plane facets: the patch test. Exit status 1 if it is not. With --wave it is a
 * smooth function that is not linear: the error is that of the method.
 *
 * Nodes that no facet has are left out. Tetrahedra are polyhedra by polylla3d
 * --max-tets 1. */
#include "dg.h"
#include "vem.h"

#include "../../lib/base/array.h"

#include <fcntl.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* What rounding may do to the values; it does more to gradients in flat cells. */
static const double patch_test = 1e-10, patch_test_gradient = 1e-9;

typedef tm_status solve(solve_cell *found, size_t *unknowns, const solve_mesh *mesh,
                        const solution *exact, tm_error *error);

static tm_status run(const tm_stream *stream, solve *method, const solution *exact,
                     solve_errors *errors, tm_error *error)
{
    solve_mesh mesh;
    size_t unknowns = 0;
    tm_status status = solve_mesh_start(&mesh, stream, error);
    solve_cell *found = tm_new(mesh.of.cells, sizeof *found);
    if (status == TM_OK && !found)
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = method(found, &unknowns, &mesh, exact, error);
    if (status == TM_OK)
        status = solution_errors(errors, exact, &mesh, found, error);
    if (status == TM_OK)
        printf("%zu unknowns, %zu cells, %zu facets: L2 error %.3e, H1 error %.3e\n",
               unknowns, mesh.of.cells, mesh.of.facets, errors->l2, errors->h1);
    free(found);
    solve_mesh_free(&mesh);
    return status;
}

static tm_status read_and_run(const char *file, solve *method, const solution *exact,
                              solve_errors *errors, tm_error *error)
{
    tm_stream stream;
    tm_stream_init(&stream);
    int fd = file ? open(file, O_RDONLY) : STDIN_FILENO;
    if (fd < 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "%s cannot be opened", file);
    tm_status status = tm_stream_read(&stream, fd, file ? file : "<stdin>", 1, error);
    if (file)
        close(fd);
    if (status == TM_OK)
        status = run(&stream, method, exact, errors, error);
    tm_stream_free(&stream);
    return status;
}

int main(int argc, char **argv)
{
    static const struct option options[] = {
        {"dg", no_argument, NULL, 'd'}, {"wave", no_argument, NULL, 'w'}, {0}};
    solve *method = vem_solve;
    const solution *exact = &solution_linear;
    int c;
    while ((c = getopt_long(argc, argv, "", options, NULL)) != -1 && c != '?')
        if (c == 'd')
            method = dg_solve;
        else
            exact = &solution_wave;
    if (c == '?' || argc > optind + 1) {
        fputs("usage: poisson [--dg] [--wave] [FILE]\n", stderr);
        return 2;
    }
    tm_error error;
    solve_errors errors = {0};
    const tm_status status = read_and_run(argv[optind], method, exact, &errors, &error);
    if (status != TM_OK) {
        fprintf(stderr, "poisson: %s%s%s\n", error.file, *error.file ? ": " : "",
                error.what);
        return (int)status;
    }
    const bool found = errors.l2 <= patch_test && errors.h1 <= patch_test_gradient;
    if (exact == &solution_wave || found)
        return EXIT_SUCCESS;
    fprintf(stderr, "poisson: not but for rounding, which is %g and %g at most\n",
            patch_test, patch_test_gradient);
    return EXIT_FAILURE;
}
