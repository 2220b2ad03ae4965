/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "feature.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../geom/vector.h"
#include "../../surface/surface_tree.h"
#include "feature_parts.h"

#include <stdlib.h>
#include <string.h>

/* An interior boundary node that could stand for a corner. */
typedef struct {
    double distance2; /* in sides of leaves */
    uint32_t corner, node;
} candidate;

typedef struct {
    tm_path_finder path;
    tm_feature_choice choice;
    uint32_t *node_of; /* [corners]: the interior boundary node, or TM_NONE */
    size_t candidates, room;
    candidate *candidate;
    uint32_t corner; /* whose candidates are looked for */
    bool no_memory;
} finder;

static int compare_candidates(const void *a, const void *b)
{
    const candidate *ca = a;
    const candidate *cb = b;
    if (ca->distance2 != cb->distance2)
        return ca->distance2 < cb->distance2 ? -1 : 1;
    if (ca->corner != cb->corner)
        return ca->corner < cb->corner ? -1 : 1;
    return (ca->node > cb->node) - (ca->node < cb->node);
}

static void consider(void *context, uint32_t s)
{
    const double reach = 3.5; /* sides of a leaf */
    finder *find = context;
    const tm_surface *surface = find->path.surface;
    const tm_region_sets *sets = find->path.sets;
    double xyz[3];
    if (sets && sets->node[s] != sets->corner[find->corner])
        return;
    tm_boundary_node_point(find->path.boundary, s, xyz);
    const double *corner = surface->xyz[surface->corner[find->corner]];
    const double size = find->path.boundary->size[s];
    const double distance2 = tm_distance2(xyz, corner) / (size * size);
    if (distance2 > reach * reach)
        return;
    void *more = tm_grow(find->candidate, &find->room, find->candidates + 1,
                         sizeof *find->candidate);
    if (!more) {
        find->no_memory = true;
        return;
    }
    find->candidate = more;
    find->candidate[find->candidates++] = (candidate){distance2, find->corner, s};
}

/* Gives each corner a node, the closest pairs first. */
static tm_status find_corners(finder *find, tm_error *error)
{
    const tm_surface *surface = find->path.surface;
    tm_feature *feature = find->path.feature;
    find->node_of = tm_new(surface->corners, sizeof *find->node_of);
    if (!find->node_of)
        return tm_fail_memory(error);
    for (size_t c = 0; c < surface->corners; c++) {
        find->node_of[c] = TM_NONE;
        find->corner = (uint32_t)c;
        if (find->choice.corner[c])
            tm_boundary_cells_near(find->path.cells, surface->xyz[surface->corner[c]],
                                   consider, find);
    }
    if (find->no_memory)
        return tm_fail_memory(error);
    if (find->candidates > 0)
        qsort(find->candidate, find->candidates, sizeof *find->candidate,
              compare_candidates);
    for (size_t i = 0; i < find->candidates; i++) {
        const candidate *c = &find->candidate[i];
        if (find->node_of[c->corner] != TM_NONE || feature->kind[c->node] != TM_ON_PATCH)
            continue;
        find->node_of[c->corner] = c->node;
        feature->kind[c->node] = TM_ON_CORNER;
        feature->of[c->node] = c->corner;
    }
    for (size_t c = 0; c < surface->corners; c++)
        if (find->node_of[c] == TM_NONE && find->choice.corner[c]) {
            feature->corners_lost++;
            feature->lost = surface->corner[c];
        }
    return TM_OK;
}

/* Joins the patches on the two sides of a curve. */
static void join_patches(const tm_surface *surface, uint32_t *parent, uint32_t curve)
{
    const uint32_t *patch = surface->curve_patch[curve];
    if (patch[0] == TM_NONE || patch[1] == TM_NONE)
        return; /* an open edge */
    tm_set_unite(parent, patch[0], patch[1]);
}

/* The interior boundary node that stands for a corner; TM_NONE where there is no corner.
 */
static uint32_t node_at(const finder *find, uint32_t corner)
{
    return corner == TM_NONE ? TM_NONE : find->node_of[corner];
}

/* Takes the paths of all curves back. */
static void clear_paths(const finder *find)
{
    const tm_path_finder *p = &find->path;
    memset(p->on_path, 0, p->boundary->faces);
    memset(p->boundary->cut, TM_UNCUT, p->boundary->faces);
    for (size_t s = 0; s < p->boundary->nodes; s++) {
        if (p->feature->kind[s] != TM_ON_CURVE)
            continue;
        p->feature->kind[s] = TM_ON_PATCH;
        p->feature->of[s] = p->feature->along[s][0] = p->feature->along[s][1] = TM_NONE;
    }
}

/* Finds the paths of the chosen curves in that order, and how many are lost; lost[c] says
 * which. */
static tm_status find_paths(finder *find, const uint32_t *order, bool *lost,
                            size_t *count, tm_error *error)
{
    const tm_surface *surface = find->path.surface;
    tm_status status = TM_OK;
    *count = 0;
    for (size_t i = 0; status == TM_OK && i < surface->curves; i++) {
        const uint32_t c = order[i];
        const uint32_t *node = surface->curve_node + surface->curve_start[c];
        const uint32_t *last = surface->curve_node + surface->curve_start[c + 1] - 1;
        const uint32_t from = find->choice.corner_of[*node];
        const uint32_t to = find->choice.corner_of[*last];
        bool found = !find->choice.curve[c];
        if (!found && (from == TM_NONE || node_at(find, from) != TM_NONE) &&
            (to == TM_NONE || node_at(find, to) != TM_NONE))
            status = tm_path_along_curve(&find->path, c, node_at(find, from),
                                         node_at(find, to), &found, error);
        lost[c] = !found;
        *count += !found;
    }
    return status;
}

/* Moves the curves that are lost to the front: another one may have barred their way. */
static void put_lost_first(const bool *lost, size_t curves, const uint32_t *order,
                           uint32_t *next)
{
    size_t n = 0;
    for (int first = 1; first >= 0; first--)
        for (size_t i = 0; i < curves; i++)
            if (lost[order[i]] == first)
                next[n++] = order[i];
}

/* Tries some orders, each with what the last one lost first, and leaves the paths of the
 * best. */
static tm_status try_orders(finder *find, uint32_t *order[2], bool *lost, tm_error *error)
{
    enum { TRIES = 4 };
    size_t least, count;
    unsigned best = 0;
    tm_status status = find_paths(find, order[0], lost, &least, error);
    for (int t = 1; status == TM_OK && least > 0 && t < TRIES; t++) {
        put_lost_first(lost, find->path.surface->curves, order[best], order[1 - best]);
        clear_paths(find);
        status = find_paths(find, order[1 - best], lost, &count, error);
        if (status != TM_OK || count < least) {
            best = 1 - best;
            least = count;
            continue;
        }
        clear_paths(find);
        return find_paths(find, order[best], lost, &count, error);
    }
    return status;
}

/* Joins the patches on both sides of curves that are lost, or were not chosen. */
static tm_status join_lost(finder *find, tm_surface *surface, const bool *lost,
                           tm_error *error)
{
    tm_feature *feature = find->path.feature;
    uint32_t *parent = tm_new(surface->patches, sizeof *parent);
    if (!parent)
        return tm_fail_memory(error);
    for (size_t p = 0; p < surface->patches; p++)
        parent[p] = (uint32_t)p;
    for (uint32_t c = 0; c < surface->curves; c++) {
        if (lost[c] || !find->choice.curve[c])
            join_patches(surface, parent, c);
        if (lost[c]) {
            const size_t begin = surface->curve_start[c],
                         end = surface->curve_start[c + 1];
            feature->curves_lost++;
            feature->lost = surface->curve_node[(begin + end - 1) / 2];
        }
    }
    for (size_t t = 0; t < surface->triangles; t++)
        surface->patch[t] = tm_set_root(parent, surface->patch[t]);
    tm_surface_tree_refresh(surface);
    free(parent);
    return TM_OK;
}

static tm_status find_curves(finder *find, tm_surface *surface, tm_error *error)
{
    uint32_t *order[2] = {tm_new(surface->curves, sizeof(uint32_t)),
                          tm_new(surface->curves, sizeof(uint32_t))};
    bool *lost = calloc(surface->curves + 1, sizeof *lost);
    tm_status status = order[0] && order[1] && lost ? TM_OK : tm_fail_memory(error);
    for (size_t c = 0; order[0] && c < surface->curves; c++)
        order[0][c] = (uint32_t)c;
    if (status == TM_OK)
        status = try_orders(find, order, lost, error);
    if (status == TM_OK)
        status = join_lost(find, surface, lost, error);
    free(order[0]);
    free(order[1]);
    free(lost);
    return status;
}

/* Chooses curves by the size of the leaves near the middle of each. */
static tm_status choose(finder *find, tm_error *error)
{
    const tm_surface *surface = find->path.surface;
    double *size = tm_new(surface->curves, sizeof *size);
    if (!size)
        return tm_fail_memory(error);
    for (size_t c = 0; c < surface->curves; c++) {
        const size_t begin = surface->curve_start[c], end = surface->curve_start[c + 1];
        const uint32_t middle = surface->curve_node[(begin + end) / 2];
        double distance2;
        const uint32_t n = tm_boundary_cells_nearest(
            find->path.cells, surface->xyz[middle], (tm_boundary_filter){0}, &distance2);
        size[c] = n == TM_NONE ? find->path.boundary->side : find->path.boundary->size[n];
    }
    const tm_status status = tm_feature_choose(&find->choice, surface, size, error);
    free(size);
    return status;
}

static tm_status allocate(tm_feature *feature, size_t nodes, tm_error *error)
{
    feature->kind = calloc(nodes + 1, sizeof *feature->kind);
    feature->of = tm_new(nodes, sizeof *feature->of);
    feature->along = tm_new(nodes, sizeof *feature->along);
    if (!feature->kind || !feature->of || !feature->along)
        return tm_fail_memory(error);
    for (size_t s = 0; s < nodes; s++)
        feature->of[s] = feature->along[s][0] = feature->along[s][1] = TM_NONE;
    return TM_OK;
}

static void free_finder(finder *find)
{
    free(find->node_of);
    tm_feature_choice_free(&find->choice);
    free(find->candidate);
    free(find->path.on_path);
    free(find->path.visit);
    free(find->path.heap);
    free(find->path.length);
    free(find->path.path);
    free(find->path.cuts);
}

tm_status tm_feature_find(tm_feature *feature, tm_interior_boundary *boundary,
                          tm_surface *surface, const tm_surface_point *at,
                          tm_error *error)
{
    *feature = (tm_feature){.lost = TM_NONE};
    tm_status status = allocate(feature, boundary->nodes, error);
    if (status != TM_OK || surface->corners + surface->curves == 0)
        return status;
    tm_boundary_cells cells;
    tm_region_sets sets = {0};
    status = tm_boundary_cells_sort(&cells, boundary, error);
    if (status == TM_OK && surface->walls)
        status = tm_region_sets_find(&sets, boundary, surface, error);
    finder find = {.path = {.surface = surface,
                            .cells = &cells,
                            .boundary = boundary,
                            .sets = surface->walls ? &sets : NULL,
                            .feature = feature}};
    find.path.on_path = calloc(boundary->faces + 1, 1);
    find.path.visit = calloc(boundary->nodes + 1, sizeof *find.path.visit);
    if (status == TM_OK && !(find.path.on_path && find.path.visit))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = choose(&find, error);
    if (status == TM_OK)
        status = find_corners(&find, error);
    if (status == TM_OK)
        status = find_curves(&find, surface, error);
    if (status == TM_OK)
        status =
            tm_feature_regions(feature, boundary, surface, find.path.on_path, at, error);
    if (status == TM_OK)
        tm_feature_cut_wide(feature, boundary, surface, find.path.on_path, at);
    free_finder(&find);
    tm_region_sets_free(&sets);
    tm_boundary_cells_free(&cells);
    return status;
}

void tm_feature_free(tm_feature *feature)
{
    free(feature->kind);
    free(feature->of);
    free(feature->along);
    *feature = (tm_feature){0};
}
