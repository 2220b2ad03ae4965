/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vem-poisson [--wave] [FILE]: solves Poisson's equation by virtual elements (element.h)
 * on the polyhedra of a stream, with the values of a known solution at the nodes of the
 * boundary, and prints how far it is from that solution at the nodes.
 *
 * The solution is linear, and has to be found but for rounding, on any mesh whose cells
 * are closed by plane facets: the patch test. Exit status 1 if it is not. With --wave it
 * is a smooth function that is not linear: the error is that of the method.
 *
 * Nodes that no facet has are left out. The linear equations are solved by CHOLMOD. */
#include "element.h"

#include "../../lib/base/array.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>
#include <unistd.h>

/* What rounding may do, relative to the largest value. */
static const double patch_test = 1e-9;

/* A solution u, and what the equation -Δu = f has for it. */
typedef struct {
    double (*u)(const double x[3]);
    double (*f)(const double x[3]);
} solution;

static double linear(const double x[3])
{
    const double slope[3] = {2, -3, 0.5};
    return 1 + slope[0] * x[0] + slope[1] * x[1] + slope[2] * x[2];
}

static double zero(const double x[3])
{
    (void)x;
    return 0;
}

static const double wave_number[2] = {2, 3};

static double wave(const double x[3])
{
    return sin(wave_number[0] * x[0]) * cos(wave_number[1] * x[1]) * exp(x[2]);
}

static double wave_source(const double x[3])
{
    const double *k = wave_number;
    return (k[0] * k[0] + k[1] * k[1] - 1) * wave(x);
}

/* The equations for the nodes inside. */
typedef struct {
    size_t unknowns;
    uint32_t *unknown; /* [nodes]: its number, or TM_NONE: known, or in no facet */
    double *value;     /* [nodes]: the exact solution, then the one that is found */
    double *share;     /* [nodes]: of the volume of the cells; 0: in no facet */
    cholmod_common common;
    cholmod_triplet *matrix; /* its lower half */
    cholmod_dense *right;
} problem;

static void free_problem(problem *p)
{
    free(p->unknown);
    free(p->value);
    free(p->share);
    cholmod_free_triplet(&p->matrix, &p->common);
    cholmod_free_dense(&p->right, &p->common);
    cholmod_finish(&p->common);
}

/* Numbers the nodes that facets have and the boundary has not. */
static void number_unknowns(problem *p, const vem_mesh *mesh)
{
    enum { INSIDE = 0 };
    const tm_block *facet = mesh->facet;
    for (size_t v = 0; v < mesh->nodes; v++)
        p->unknown[v] = TM_NONE;
    for (size_t k = 0; k < facet->start[facet->count]; k++)
        p->unknown[facet->item[k]] = INSIDE;
    for (size_t f = 0; f < facet->count; f++)
        for (size_t k = facet->start[f]; k < facet->start[f + 1]; k++)
            if (facet->integer[2 * f + 1] == TM_NONE)
                p->unknown[facet->item[k]] = TM_NONE;
    for (size_t v = 0; v < mesh->nodes; v++)
        if (p->unknown[v] == INSIDE)
            p->unknown[v] = (uint32_t)p->unknowns++;
}

static tm_status start_problem(problem *p, const vem_mesh *mesh, const solution *exact,
                               tm_error *error)
{
    *p = (problem){0};
    cholmod_start(&p->common);
    p->unknown = tm_new(mesh->nodes, sizeof *p->unknown);
    p->value = tm_new(mesh->nodes, sizeof *p->value);
    p->share = calloc(mesh->nodes + 1, sizeof *p->share);
    if (!p->unknown || !p->value || !p->share)
        return tm_fail_memory(error);
    number_unknowns(p, mesh);
    for (size_t v = 0; v < mesh->nodes; v++)
        p->value[v] = exact->u(mesh->xyz[v]);
    size_t n = p->unknowns;
    p->matrix = cholmod_allocate_triplet(n, n, 1, -1, CHOLMOD_REAL, &p->common);
    p->right = cholmod_zeros(n, 1, CHOLMOD_REAL, &p->common);
    return p->matrix && p->right ? TM_OK : tm_fail_memory(error);
}

/* Adds the stiffness between nodes v and w to the matrix, or, where w is known, what it
 * gives to the right side. */
static void add_entry(problem *p, uint32_t v, uint32_t w, double stiffness)
{
    uint32_t row = p->unknown[v], column = p->unknown[w];
    cholmod_triplet *m = p->matrix;
    if (row == TM_NONE)
        return;
    if (column == TM_NONE) {
        ((double *)p->right->x)[row] -= stiffness * p->value[w];
    } else if (row >= column) {
        ((int *)m->i)[m->nnz] = (int)row;
        ((int *)m->j)[m->nnz] = (int)column;
        ((double *)m->x)[m->nnz++] = stiffness;
    }
}

/* Adds a cell's equations. */
static bool add_element(problem *p, const vem_element *e, const solution *exact)
{
    size_t needed = p->matrix->nnz + e->nodes * e->nodes;
    if (needed > p->matrix->nzmax &&
        !cholmod_reallocate_triplet(2 * needed, p->matrix, &p->common))
        return false;
    double x[3];
    for (int k = 0; k < 3; k++)
        x[k] = e->origin[k] + e->centroid[k];
    double source = exact->f(x);
    for (size_t i = 0; i < e->nodes; i++) {
        uint32_t v = e->node[i];
        p->share[v] += e->volume / (double)e->nodes;
        if (p->unknown[v] != TM_NONE)
            ((double *)p->right->x)[p->unknown[v]] += source * vem_integral(e, i);
        for (size_t j = 0; j < e->nodes; j++)
            add_entry(p, v, e->node[j], vem_stiffness(e, i, j));
    }
    return true;
}

static tm_status assemble(problem *p, const vem_mesh *mesh, const solution *exact,
                          tm_error *error)
{
    vem_element element;
    tm_status status = vem_element_start(&element, mesh, error);
    for (size_t c = 0; c < mesh->cell->count && status == TM_OK; c++) {
        status = vem_element_set(&element, mesh, c, error);
        if (status == TM_OK && !add_element(p, &element, exact))
            status = tm_fail_memory(error);
    }
    vem_element_free(&element);
    return status;
}

/* Solves the equations; the nodes inside have their values then. */
static tm_status solve(problem *p, size_t nodes, tm_error *error)
{
    cholmod_common *common = &p->common;
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(p->matrix, 0, common);
    cholmod_factor *factor = matrix ? cholmod_analyze(matrix, common) : NULL;
    cholmod_dense *found = NULL;
    if (factor && cholmod_factorize(matrix, factor, common) &&
        common->status == CHOLMOD_OK)
        found = cholmod_solve(CHOLMOD_A, factor, p->right, common);
    for (size_t v = 0; v < nodes && found; v++)
        if (p->unknown[v] != TM_NONE)
            p->value[v] = ((double *)found->x)[p->unknown[v]];
    tm_status status = TM_OK;
    if (!found)
        status = tm_fail(error, TM_ERROR_SYSTEM, "CHOLMOD: status %d%s", common->status,
                         common->status == CHOLMOD_NOT_POSDEF
                             ? ", the matrix is not positive definite"
                             : "");
    cholmod_free_dense(&found, common);
    cholmod_free_factor(&factor, common);
    cholmod_free_sparse(&matrix, common);
    return status;
}

/* Prints the errors, relative to the solution. Returns the largest. */
static double report(const problem *p, const vem_mesh *mesh, const solution *exact)
{
    double largest = 0, largest_u = 0, sum = 0, sum_u = 0;
    for (size_t v = 0; v < mesh->nodes; v++) {
        if (!(p->share[v] > 0))
            continue;
        double u = exact->u(mesh->xyz[v]), off = fabs(p->value[v] - u);
        largest = fmax(largest, isnan(off) ? INFINITY : off);
        largest_u = fmax(largest_u, fabs(u));
        sum += p->share[v] * off * off;
        sum_u += p->share[v] * u * u;
    }
    largest = largest > 0 ? largest / largest_u : 0;
    printf("%zu unknowns, %zu cells, %zu facets: largest error %.2e, mean square %.2e\n",
           p->unknowns, mesh->cell->count, mesh->facet->count, largest,
           sum > 0 ? sqrt(sum / sum_u) : 0);
    return largest;
}

static tm_status run(const tm_stream *stream, const solution *exact, double *largest,
                     tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    vem_mesh mesh = {.facet = tm_stream_find(stream, ".facet"),
                     .cell = tm_stream_find(stream, ".cell")};
    if (!node || !mesh.facet || !mesh.cell)
        return tm_fail(error, TM_ERROR_INPUT, "no polyhedra (polylla3d makes them)");
    mesh.nodes = node->count;
    mesh.xyz = (const double(*)[3])node->real;
    problem p;
    tm_status status = start_problem(&p, &mesh, exact, error);
    if (status == TM_OK)
        status = assemble(&p, &mesh, exact, error);
    if (status == TM_OK && p.unknowns > 0)
        status = solve(&p, mesh.nodes, error);
    if (status == TM_OK)
        *largest = report(&p, &mesh, exact);
    free_problem(&p);
    return status;
}

static tm_status read_and_run(const char *file, const solution *exact, double *largest,
                              tm_error *error)
{
    tm_stream stream;
    tm_stream_init(&stream);
    int fd = file ? open(file, O_RDONLY) : STDIN_FILENO;
    if (fd < 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "%s cannot be opened", file);
    tm_status status = tm_stream_read(&stream, fd, file ? file : "<stdin>", error);
    if (file)
        close(fd);
    if (status == TM_OK)
        status = run(&stream, exact, largest, error);
    tm_stream_free(&stream);
    return status;
}

int main(int argc, char **argv)
{
    static const solution flat = {linear, zero}, curved = {wave, wave_source};
    int operand = 1;
    bool waves = argc > 1 && strcmp(argv[1], "--wave") == 0;
    operand += waves;
    if (argc > operand + 1 || (argc > operand && argv[operand][0] == '-')) {
        fputs("usage: vem-poisson [--wave] [FILE]\n", stderr);
        return 2;
    }
    tm_error error;
    double largest = 0;
    tm_status status =
        read_and_run(argv[operand], waves ? &curved : &flat, &largest, &error);
    if (status != TM_OK) {
        fprintf(stderr, "vem-poisson: %s%s%s\n", error.file, *error.file ? ": " : "",
                error.what);
        return (int)status;
    }
    if (waves || largest <= patch_test)
        return EXIT_SUCCESS;
    fprintf(stderr, "vem-poisson: the error is above %g\n", patch_test);
    return EXIT_FAILURE;
}
