/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"
#include "shared_optimise.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../element/certify.h"
#include "../../element/shape.h"
#include "../../geom/vector.h"
#include "../../optimise/optimise_surface.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

/* Half of the way so many times, then all of it. */
enum { HALVES = 5 };

/* An element below is not taken for valid: it must be so in other programs too. */
static const double least_valid = 1e-6;

/* What is asked of an element. */
typedef bool element_test(const tm_mixed_mesh *mesh, size_t e);

typedef struct {
    tm_mixed_mesh *mesh;
    element_test *passes;
    const tm_mesh_share *share; /* NULL: this is the whole mesh */
    const double (*base)[3];
    uint8_t *steps;  /* [nodes]: how often it went half of its way back */
    bool *changed;   /* [nodes]: in the last round */
    bool *to_change; /* [nodes]: in this one */
    size_t failed;   /* elements whose nodes are all on the lattice */
} retreat;

/* Whether an element's faces, each a fan of triangles, enclose a negative volume: its
 * corners may all be right then, but it is on the wrong side of a face. */
static bool is_turned(const tm_mixed_mesh *mesh, size_t e)
{
    const uint32_t *v = mesh->item + mesh->start[e];
    const size_t k = mesh->start[e + 1] - mesh->start[e];
    const tm_element_shape *shape = &tm_element_shapes[k];
    const double *origin = mesh->xyz[v[0]];
    double volume = 0;
    for (size_t i = 0; i < shape->faces; i++) {
        const uint8_t *face = shape->face[i];
        for (size_t j = 2; j < tm_mixed_face_nodes(face); j++) {
            double a[3], b[3], c[3], normal[3];
            tm_subtract(a, mesh->xyz[v[face[0]]], origin);
            tm_subtract(b, mesh->xyz[v[face[j - 1]]], origin);
            tm_subtract(c, mesh->xyz[v[face[j]]], origin);
            tm_cross(normal, a, b);
            volume += tm_dot(normal, c);
        }
    }
    return volume <= 0;
}

typedef struct {
    const tm_octree_mesh *mesh;
    bool any;
} turned_finder;

static void find_turned(void *context, size_t first, size_t past)
{
    turned_finder *t = context;
    const tm_octree_mesh *m = t->mesh;
    for (size_t f = first; f < past; f++)
        for (unsigned i = 0; i < (m->boundary.cut[f] == TM_UNCUT ? 1u : 2u); i++)
            if (is_turned(&m->assembly.mesh, m->assembly.layer[f] + i))
                tm_mark(&t->any);
}

/* The same of any element of the layer: others are not turned so far. */
static bool any_is_turned(const tm_octree_mesh *m)
{
    turned_finder t = {.mesh = m};
    tm_parallel_runs(m->assembly.mesh.threads, m->boundary.faces, TM_CHUNK, find_turned,
                     &t);
    return tm_ranks_any(t.any);
}

static bool is_valid(const tm_mixed_mesh *mesh, size_t e)
{
    return tm_mixed_jens(mesh, e) >= least_valid && !is_turned(mesh, e);
}

/* Whether the determinant is positive all over it, which the corners of a hexahedron do
 * not say. */
static bool is_positive(const tm_mixed_mesh *mesh, size_t e)
{
    return tm_certify(mesh->start[e + 1] - mesh->start[e], (const double(*)[3])mesh->xyz,
                      mesh->item + mesh->start[e]) == TM_POSITIVE;
}

static bool is_certified(const tm_mixed_mesh *mesh, size_t e)
{
    return is_valid(mesh, e) && is_positive(mesh, e);
}

typedef struct {
    const tm_mixed_mesh *mesh;
    element_test *passes;
    size_t first;
    size_t failed;
} failed_counter;

static void count_chunk(void *context, size_t first, size_t past)
{
    failed_counter *c = context;
    size_t failed = 0;
    for (size_t e = first; e < past; e++)
        failed += !c->passes(c->mesh, c->first + e);
    if (failed > 0)
        __atomic_fetch_add(&c->failed, failed, __ATOMIC_RELAXED);
}

/* Elements of all ranks that do not pass. */
static size_t count_failed(const tm_octree_mesh *m, element_test *passes)
{
    const tm_mixed_mesh *mesh = &m->assembly.mesh;
    failed_counter c = {
        .mesh = mesh, .passes = passes, .first = m->share ? m->share->elements.first : 0};
    const size_t past = m->share ? m->share->elements.past : mesh->elements;
    tm_parallel_runs(mesh->threads, past - c.first, TM_CHUNK, count_chunk, &c);
    tm_ranks_sum(&c.failed, 1);
    return c.failed;
}

static bool has_changed(const retreat *r, size_t e)
{
    for (size_t i = r->mesh->start[e]; i < r->mesh->start[e + 1]; i++)
        if (r->changed[r->mesh->item[i]])
            return true;
    return false;
}

/* Marks the nodes of an element that can go back; false where none can. */
static bool mark_nodes(retreat *r, size_t e)
{
    bool any = false;
    for (size_t i = r->mesh->start[e]; i < r->mesh->start[e + 1]; i++) {
        const uint32_t n = r->mesh->item[i];
        if (r->steps[n] <= HALVES) {
            r->to_change[n] = true;
            any = true;
        }
    }
    return any;
}

static void restore(retreat *r, size_t n)
{
    double *xyz = r->mesh->xyz[n];
    r->steps[n]++;
    for (int i = 0; i < 3; i++)
        xyz[i] = r->steps[n] > HALVES ? r->base[n][i] : (xyz[i] + r->base[n][i]) / 2;
}

/* One round over the elements at nodes that changed; false when all pass. */
static bool take_back(retreat *r)
{
    const tm_mixed_mesh *mesh = r->mesh;
    const size_t first = r->share ? r->share->elements.first : 0;
    const size_t past = r->share ? r->share->elements.past : mesh->elements;
    bool any = false;
    for (size_t e = first; e < past; e++) {
        if (!has_changed(r, e) || r->passes(mesh, e))
            continue;
        if (mark_nodes(r, e))
            any = true;
        else
            r->failed++;
    }
    if (r->share)
        tm_mesh_ghosts_mark(&r->share->ghosts, r->to_change);
    for (size_t n = 0; n < mesh->nodes; n++) {
        r->changed[n] = r->to_change[n];
        if (r->to_change[n])
            restore(r, n);
        r->to_change[n] = false;
    }
    return tm_ranks_any(any);
}

static void retreat_all(tm_octree_mesh *m, retreat *r)
{
    memset(r->changed, true, r->mesh->nodes);
    for (bool more = true; more;)
        more = take_back(r);
    tm_ranks_sum(&r->failed, 1);
    m->report.invalid = r->failed;
    for (size_t s = 0; s < m->boundary.nodes; s++)
        m->off_surface[s] |= r->steps[m->assembly.outer + s] > 0;
}

/* Takes nodes of elements that do not pass back to the lattice, as far as they have to.
 */
static tm_status hold_back(tm_octree_mesh *m, const tm_octree *octree,
                           element_test *passes, tm_error *error)
{
    const size_t nodes = m->assembly.mesh.nodes;
    double(*base)[3] = tm_new(nodes, sizeof *base);
    retreat r = {.mesh = &m->assembly.mesh,
                 .passes = passes,
                 .share = m->share,
                 .base = (const double(*)[3])base,
                 .steps = calloc(nodes + 1, 1),
                 .changed = malloc(nodes + 1),
                 .to_change = calloc(nodes + 1, 1)};
    tm_status status =
        base && r.steps && r.changed && r.to_change ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_lattice_points(&m->assembly, octree, m->part, m->parts, &m->boundary,
                                   base, error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK && m->share)
        tm_mesh_ghosts_fill(&m->share->ghosts, base, sizeof *base);
    if (status == TM_OK)
        retreat_all(m, &r);
    free(base);
    free(r.steps);
    free(r.changed);
    free(r.to_change);
    return status;
}

/* What each node may do while elements are improved. */
static tm_node_rule *find_rules(const tm_octree_mesh *m)
{
    static const uint8_t freedom[] = {[TM_ON_PATCH] = TM_MOVES_ON_SURFACE,
                                      [TM_ON_CURVE] = TM_MOVES_ON_CURVE,
                                      [TM_ON_CORNER] = TM_MOVES_AT_CORNER};
    const tm_assembly *a = &m->assembly;
    tm_node_rule *rule = tm_new(a->mesh.nodes, sizeof *rule);
    for (size_t n = 0; rule && n < a->mesh.nodes; n++)
        rule[n] = (tm_node_rule){.where = TM_NONE, .freedom = TM_MOVES_FREELY};
    for (size_t s = 0; rule && s < m->boundary.nodes; s++)
        rule[a->outer + s] = (tm_node_rule){.where = m->feature.of[s],
                                            .freedom = freedom[m->feature.kind[s]]};
    return rule;
}

/* Improves what is below each goal in turn: first what is bad, then what could be better,
 * with fewer measurements where that is much: a later goal makes nothing fall below it
 * that is not, and nothing worse that is. */
static tm_status improve(tm_octree_mesh *m, tm_node_rule *rule,
                         const tm_boundary *boundary, const tm_progress *progress,
                         double *worst, tm_error *error)
{
    /* What can be mended takes few measurements of elements; where the surface is
     * too fine for the leaves there would be no end. */
    static const size_t at_least[] = {1500000, 500000}, each[] = {1, 2};
    static const double goal[] = {0.2, 0.3};
    tm_status status = TM_OK;
    for (size_t g = 0; g < sizeof goal / sizeof *goal && status == TM_OK; g++) {
        const tm_optimise_options options = {
            .threshold = goal[g],
            .off_surface_threshold = goal[g],
            .effort = 1,
            .most_measured = at_least[g] + each[g] * tm_octree_mesh_elements(m),
            .progress = progress};
        tm_optimise_report report;
        status = tm_shared_optimise(m, rule, boundary, &options, &report, error);
        *worst = report.worst_after;
    }
    return status;
}

/* What lets outer nodes go: see release(). */
typedef struct {
    tm_octree_mesh *m;
    tm_node_rule *rule;
    uint8_t *ring;     /* [nodes]: how far from invalid elements, at least 1; 0 far */
    double (*base)[3]; /* [nodes]: where all elements are valid */
    double (*kept)[3]; /* [nodes] */
} releaser;

/* Fills ring[] up to so many: the nodes of invalid elements are the first one. */
static void find_rings(const releaser *r, int rings)
{
    const tm_mixed_mesh *mesh = &r->m->assembly.mesh;
    memset(r->ring, 0, mesh->nodes);
    for (int ring = 1; ring <= rings; ring++)
        for (size_t e = 0; e < mesh->elements; e++) {
            bool marks = ring == 1 && !is_valid(mesh, e);
            for (size_t i = mesh->start[e]; ring > 1 && i < mesh->start[e + 1]; i++)
                marks |= r->ring[mesh->item[i]] == ring - 1;
            for (size_t i = mesh->start[e]; marks && i < mesh->start[e + 1]; i++)
                if (r->ring[mesh->item[i]] == 0)
                    r->ring[mesh->item[i]] = (uint8_t)ring;
        }
}

/* Lets nodes in the rings go; after the first time from where they are valid, those of
 * the last ring from half of the way there. */
static void let_go(const releaser *r, int rings)
{
    const tm_octree_mesh *m = r->m;
    double(*xyz)[3] = m->assembly.mesh.xyz;
    for (size_t s = 0; s < m->boundary.nodes; s++)
        if (r->ring[m->assembly.outer + s] > 0)
            r->rule[m->assembly.outer + s].off_surface = true;
    for (size_t n = 0; rings > 1 && n < m->assembly.mesh.nodes; n++)
        for (int i = 0; r->ring[n] > 0 && i < 3; i++)
            xyz[n][i] =
                r->ring[n] < rings ? r->base[n][i] : (xyz[n][i] + r->base[n][i]) / 2;
}

/* Tries with one ring more each time, while elements are invalid. */
static tm_status try_rings(releaser *r, const tm_boundary *boundary,
                           tm_optimise_options *options, tm_error *error)
{
    enum { RINGS = 4, MANY = 100 };
    tm_mixed_mesh *mesh = &r->m->assembly.mesh;
    const size_t bytes = mesh->nodes * sizeof *mesh->xyz;
    size_t before = count_failed(r->m, is_valid);
    tm_optimise_report report;
    for (int rings = 1; before > 0 && rings <= RINGS; rings++) {
        memcpy(r->kept, mesh->xyz, bytes);
        find_rings(r, rings);
        let_go(r, rings);
        const tm_status status =
            tm_mixed_optimise(mesh, r->rule, boundary, options, &report, error);
        if (status != TM_OK)
            return status;
        const size_t after = count_failed(r->m, is_valid);
        if (after > before)
            memcpy(mesh->xyz, r->kept, bytes);
        if (after > MANY && after > before / 2)
            break;
        before = after < before ? after : before;
    }
    return TM_OK;
}

/* What makes elements valid, with so many measurements. */
static tm_optimise_options to_be_valid(const tm_mixed_mesh *mesh,
                                       const tm_progress *progress)
{
    const double valid = 0.05;
    const size_t least = 500000, each = 2;
    return (tm_optimise_options){.threshold = valid,
                                 .effort = 1,
                                 .most_measured = least + each * mesh->elements,
                                 .progress = progress};
}

static tm_status release_and_return(releaser *r, const tm_octree *octree,
                                    const tm_boundary *boundary,
                                    const tm_progress *progress, tm_error *error)
{
    tm_octree_mesh *m = r->m;
    tm_optimise_options options = to_be_valid(&m->assembly.mesh, progress);
    tm_optimise_report report;
    if (!r->ring || !r->base || !r->kept)
        return tm_fail_memory(error);
    tm_status status = tm_lattice_points(&m->assembly, octree, m->part, m->parts,
                                         &m->boundary, r->base, error);
    if (status == TM_OK)
        status = try_rings(r, boundary, &options, error);
    options.off_surface_threshold = options.threshold;
    if (status == TM_OK)
        status = tm_mixed_optimise(&m->assembly.mesh, r->rule, boundary, &options,
                                   &report, error);
    return status;
}

/* Where walls meet at sharp angles: outer nodes around invalid elements leave the surface
 * until these are valid, and come back as far as they can. */
static tm_status release(tm_octree_mesh *m, const tm_octree *octree, tm_node_rule *rule,
                         const tm_boundary *boundary, const tm_progress *progress,
                         tm_error *error)
{
    const size_t nodes = m->assembly.mesh.nodes;
    releaser r = {m, rule, malloc(nodes + 1), tm_new(nodes, sizeof *r.base),
                  tm_new(nodes, sizeof *r.kept)};
    const tm_status status = release_and_return(&r, octree, boundary, progress, error);
    for (size_t s = 0; s < m->boundary.nodes; s++)
        m->off_surface[s] = rule[m->assembly.outer + s].off_surface;
    free(r.ring);
    free(r.base);
    free(r.kept);
    return status;
}

static size_t count_off_surface(const tm_octree_mesh *m)
{
    const size_t first = m->share ? m->share->outer.first : 0;
    const size_t past = m->share ? m->share->outer.past : m->boundary.nodes;
    size_t count = 0;
    for (size_t s = first; s < past; s++)
        count += m->off_surface[s];
    tm_ranks_sum(&count, 1);
    return count;
}

/* Brings outer nodes to the surface that are not there, as far as they can go, and
 * improves what is around them. */
static tm_status bring_back(tm_octree_mesh *m, const tm_octree *octree,
                            tm_node_rule *rule, const tm_boundary *boundary,
                            const tm_progress *progress, tm_error *error)
{
    tm_mixed_mesh *mesh = &m->assembly.mesh;
    tm_optimise_options options = to_be_valid(mesh, progress);
    tm_optimise_report report;
    double worst;
    for (size_t s = 0; s < m->boundary.nodes; s++)
        rule[m->assembly.outer + s].off_surface = m->off_surface[s];
    options.off_surface_threshold = options.threshold;
    tm_status status = tm_mixed_optimise(mesh, rule, boundary, &options, &report, error);
    if (status == TM_OK)
        status = improve(m, rule, boundary, progress, &worst, error);
    for (size_t s = 0; s < m->boundary.nodes; s++)
        m->off_surface[s] = rule[m->assembly.outer + s].off_surface;
    if (status == TM_OK && count_failed(m, is_valid) > 0)
        status = hold_back(m, octree, is_valid, error);
    return status;
}

/* The same; but all is as before where an element is not valid then, or no fewer nodes
 * are off the surface. */
static tm_status try_to_bring_back(tm_octree_mesh *m, const tm_octree *octree,
                                   tm_node_rule *rule, const tm_boundary *boundary,
                                   const tm_progress *progress, tm_error *error)
{
    tm_mixed_mesh *mesh = &m->assembly.mesh;
    const size_t bytes = mesh->nodes * sizeof *mesh->xyz;
    const size_t before = count_off_surface(m);
    double(*kept)[3] = tm_new(mesh->nodes, sizeof *kept);
    bool *off_surface = tm_new(m->boundary.nodes, sizeof *off_surface);
    if (!kept || !off_surface) {
        free(kept);
        free(off_surface);
        return tm_fail_memory(error);
    }
    memcpy(kept, mesh->xyz, bytes);
    memcpy(off_surface, m->off_surface, m->boundary.nodes * sizeof *off_surface);
    const tm_status status = bring_back(m, octree, rule, boundary, progress, error);
    if (status == TM_OK && (m->report.invalid > 0 || count_off_surface(m) >= before)) {
        memcpy(mesh->xyz, kept, bytes);
        memcpy(m->off_surface, off_surface, m->boundary.nodes * sizeof *off_surface);
        m->report.invalid = 0;
    }
    free(kept);
    free(off_surface);
    return status;
}

/* Nodes of elements that are not positive inside go back towards the lattice, too; not
 * where walls meet: much goes back there where one node does. */
static tm_status certify(tm_octree_mesh *m, const tm_octree *octree,
                         const tm_surface *surface, tm_error *error)
{
    const size_t failed = count_failed(m, is_positive), invalid = m->report.invalid;
    if (surface->walls)
        m->report.not_positive = failed > invalid ? failed - invalid : 0;
    if (surface->walls || failed == 0)
        return TM_OK;
    return hold_back(m, octree, is_certified, error);
}

tm_status tm_untangle_layer(tm_octree_mesh *mesh, const tm_octree *octree,
                            const tm_surface *surface, const tm_progress *progress,
                            tm_error *error)
{
    const tm_boundary boundary = tm_boundary_of_surface(surface);
    tm_node_rule *rule = find_rules(mesh);
    double worst = 1;
    tm_status status = tm_ranks_enough(rule, error);
    if (status != TM_OK)
        return status;
    status = improve(mesh, rule, &boundary, progress, &worst, error);
    bool valid = status != TM_OK || (worst >= least_valid && !any_is_turned(mesh));
    if (!valid && surface->walls) {
        status = release(mesh, octree, rule, &boundary, progress, error);
        valid = status != TM_OK || count_failed(mesh, is_valid) == 0;
        if (status == TM_OK && valid) {
            status = improve(mesh, rule, &boundary, progress, &worst, error);
            valid = status != TM_OK || count_failed(mesh, is_valid) == 0;
        }
    }
    if (!valid)
        status = hold_back(mesh, octree, is_valid, error);
    if (status == TM_OK && surface->walls && mesh->report.invalid == 0 &&
        count_off_surface(mesh) > 0)
        status = try_to_bring_back(mesh, octree, rule, &boundary, progress, error);
    if (status == TM_OK)
        status = certify(mesh, octree, surface, error);
    free(rule);
    mesh->report.off_surface = count_off_surface(mesh);
    return status;
}
