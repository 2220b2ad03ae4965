/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "region_leaves.h"
#include "contacts.h"
#include "region_layout.h"

#include "../../base/array.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OCTANTS = 8 };

/* So many rounds look after all that is not as in the surface, so many more after masks;
 * then leaves only go to regions with smaller numbers, which ends. */
enum { STRICT_ROUNDS = 12, FREE_ROUNDS = 24 };

/* Rounds that look after all end before where so many did no good. */
enum { VAIN_ROUNDS = 2 };

/* How often a leaf may change where that does neither good nor harm. */
enum { MOST_CHANGES = 3 };

/* How many of the labels of the octants around a node have a bad mask. */
static unsigned count_bad(const uint32_t octant[OCTANTS])
{
    unsigned bad = 0, done = 0;
    for (unsigned o = 0; o < OCTANTS; o++) {
        unsigned mask = 0;
        if (done >> o & 1)
            continue;
        for (unsigned i = o; i < OCTANTS; i++)
            mask |= (unsigned)(octant[i] == octant[o]) << i;
        done |= mask;
        bad += !tm_octant_mask_is_good((tm_octant_mask)mask);
    }
    return bad;
}

static const uint8_t all_octants[OCTANTS] = {0, 1, 2, 3, 4, 5, 6, 7};

typedef struct {
    const tm_octree *octree;
    const tm_surface *surface;
    tm_interior *interior;
    tm_region_layout layout;
    unsigned finest;   /* level of the smallest leaf with surface */
    bool strict;       /* not only masks count, but what the surface does not have */
    bool *bad;         /* [nodes] */
    const bool *sharp; /* [nodes]: faces there may be flat; NULL: nowhere */
    bool *laid;        /* [leaves]: of the best layout, `fixed` */
    const bool *fixed; /* [leaves]: it keeps its label while strict */
    uint8_t *changes;  /* [leaves]: how often it was changed, at most MOST_CHANGES */
    size_t wrong;      /* what is, at the beginning of a round */
    tm_contacts contacts;
} cleaner;

static bool is_uniform(const uint32_t octant[OCTANTS])
{
    bool same = true;
    for (unsigned o = 1; o < OCTANTS; o++)
        same &= octant[o] == octant[0];
    return same;
}

/* The set of some of the octants' labels, and how many there are. */
static uint64_t set_of(const uint32_t *octant, const uint8_t *which, unsigned count,
                       unsigned *labels)
{
    uint64_t set = 0;
    *labels = 0;
    for (unsigned i = 0; i < count; i++) {
        unsigned k = 0;
        while (k < i && octant[which[k]] != octant[which[i]])
            k++;
        if (k < i)
            continue;
        set ^= tm_region_number(octant[which[i]]);
        ++*labels;
    }
    return set;
}

/* Whether some of the octants have more than two labels. */
static bool has_three(const uint32_t *octant, const uint8_t *which, unsigned count)
{
    const uint32_t first = octant[which[0]];
    unsigned i = 1;
    while (i < count && octant[which[i]] == first)
        i++;
    for (unsigned k = i + 1; k < count; k++)
        if (octant[which[k]] != first && octant[which[k]] != octant[which[i]])
            return true;
    return false;
}

/* How many of the six edges from a node, and whether the node, bring together regions
 * that the surface does not. */
static unsigned count_strange(const cleaner *c, const uint32_t octant[OCTANTS])
{
    unsigned labels, strange = 0;
    uint64_t set = set_of(octant, all_octants, OCTANTS, &labels);
    strange += !tm_walls_have(&c->layout.walls, set);
    for (int e = 0; e < 6; e++) {
        unsigned few;
        set = set_of(octant, tm_side_octants[e], 4, &few);
        strange += few > 1 && !tm_walls_have(&c->layout.walls, set);
    }
    return strange;
}

static unsigned node_badness(const cleaner *c, uint32_t node)
{
    const unsigned mask_weight = 6, strange_weight = 2; /* a flat face is 1 */
    const uint32_t *octant = c->interior->octant[node];
    if (is_uniform(octant))
        return 0;
    return mask_weight * count_bad(octant) +
           (c->strict ? strange_weight * count_strange(c, octant) : 0);
}

/* Whether walls meet at the edge of face f of a leaf that is across axis e, at its low or
 * high end. */
static bool is_edge_of_walls(const cleaner *c, size_t l, unsigned f, unsigned e,
                             unsigned high)
{
    const unsigned corner = f % 2 << f / 2 | high << e, own = 7 - corner;
    const uint32_t *octant = c->interior->octant[c->octree->node[l][corner]];
    const uint8_t which[4] = {(uint8_t)own, (uint8_t)(own ^ 1u << f / 2),
                              (uint8_t)(own ^ 1u << e),
                              (uint8_t)(own ^ 1u << f / 2 ^ 1u << e)};
    return has_three(octant, which, 4);
}

/* Whether walls meet at the node that is corner i of face f of a leaf. */
static bool is_node_of_walls(const cleaner *c, size_t l, unsigned f, unsigned i)
{
    const unsigned corner =
        f % 2 << f / 2 | (i & 1) << (f / 2 + 1) % 3 | i >> 1 << (f / 2 + 2) % 3;
    return has_three(c->interior->octant[c->octree->node[l][corner]], all_octants,
                     OCTANTS);
}

/* The faces of a leaf, as parts of walls, that would be flat or folded: walls meet along
 * three edges of them, or at corners that no such edge joins. */
static unsigned count_flat(const cleaner *c, size_t l)
{
    unsigned flat = 0;
    for (unsigned i = 0; c->sharp && i < 8; i++)
        if (c->sharp[c->octree->node[l][i]])
            return 0;
    for (unsigned f = 0; f < 6; f++) {
        const unsigned corner = f % 2 << f / 2, own = 7 - corner;
        const uint32_t *octant = c->interior->octant[c->octree->node[l][corner]];
        unsigned edges = 0, corners = 0;
        if (octant[own] == octant[own ^ 1u << f / 2])
            continue;
        for (unsigned i = 1; i < 3; i++)
            for (unsigned high = 0; high < 2; high++)
                edges += is_edge_of_walls(c, l, f, (f / 2 + i) % 3, high);
        for (unsigned i = 0; i < 4; i++)
            corners += is_node_of_walls(c, l, f, i);
        flat += edges > 2 || (edges < 2 && corners > edges + 1);
    }
    return flat;
}

/* What is wrong at a leaf's nodes, and at the leaves around these. */
static unsigned badness(const cleaner *c, size_t l)
{
    enum { MOST = TM_LEAF_NODES * OCTANTS };
    uint32_t met[MOST];
    unsigned count = 0, bad = 0;
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = c->octree->node[l][p];
        if (node == TM_NONE)
            continue;
        bad += node_badness(c, node);
        for (unsigned o = 0; c->strict && o < OCTANTS; o++) {
            const uint32_t leaf = c->layout.lattice.leaf[node][o];
            unsigned k = 0;
            while (k < count && met[k] != leaf)
                k++;
            if (leaf == TM_NONE || k < count)
                continue;
            met[count++] = leaf;
            bad += count_flat(c, leaf);
        }
    }
    return bad;
}

/* Lists the leaves at bad nodes, node by node. */
static tm_status find_contacts(cleaner *c, tm_error *error)
{
    c->wrong = 0;
    for (uint32_t n = 0; n < c->octree->nodes; n++) {
        const unsigned bad = node_badness(c, n);
        c->bad[n] = bad > 0;
        c->wrong += bad;
    }
    for (size_t l = 0; c->strict && l < c->octree->leaves; l++) {
        const unsigned flat = c->octree->leaf[l].crossed ? count_flat(c, l) : 0;
        for (int p = 0; flat > 0 && p < TM_LEAF_EDGE; p++)
            c->bad[c->octree->node[l][p]] = true;
        c->wrong += flat;
    }
    return tm_contacts_find(&c->contacts, c->octree, c->bad, error);
}

/* How bad it would be if a leaf had that label. */
static unsigned badness_with(const cleaner *c, size_t l, uint32_t label)
{
    const uint32_t now = c->interior->label[l];
    tm_interior_set_label(c->interior, c->octree, l, label);
    const unsigned bad = badness(c, l);
    tm_interior_set_label(c->interior, c->octree, l, now);
    return bad;
}

/* The labels of the octants around a node, each once. */
typedef struct {
    unsigned count;
    uint32_t label[OCTANTS];
} label_list;

static label_list labels_around(const uint32_t octant[OCTANTS])
{
    label_list list = {0};
    for (unsigned o = 0; o < OCTANTS; o++) {
        unsigned k = 0;
        while (k < list.count && list.label[k] != octant[o])
            k++;
        if (k == list.count)
            list.label[list.count++] = octant[o];
    }
    return list;
}

/* A leaf that gets another label, and how much worse it is then; a fault less is worth a
 * side of a leaf. */
typedef struct {
    size_t leaf; /* TM_NONE: none */
    uint32_t label;
    int more;
    double cost;
} change;

/* Whether a leaf is of one region all over, and larger than the smallest with surface. */
static bool is_large(const cleaner *c, size_t l)
{
    const tm_leaf *leaf = &c->octree->leaf[l];
    return !leaf->crossed && leaf->level < c->finest;
}

/* The best change of one of the leaves contact[0 … count) around a node that makes it
 * worse by no more than `most`: what does most good, and of that the leaf closest to the
 * surface. */
static change find_change(const cleaner *c, const tm_contact *around, size_t count,
                          const label_list *to, int most, bool only_smaller)
{
    const double fixed_cost = 4; /* one that was laid out is the last to change */
    change best = {.leaf = TM_NONE, .cost = INFINITY};
    for (size_t i = 0; i < count; i++) {
        const size_t l = around[i].leaf;
        if (c->strict && (c->fixed[l] || is_large(c, l)))
            continue;
        const double depth =
            tm_leaf_depth(c->octree, c->surface, l) + (c->fixed[l] ? fixed_cost : 0);
        const int before = (int)badness(c, l);
        const uint32_t now = c->interior->label[l];
        for (unsigned k = 0; k < to->count; k++) {
            const uint32_t label = to->label[k];
            if (label == now || (only_smaller && label > now))
                continue;
            const int more = (int)badness_with(c, l, label) - before;
            const bool idle = more == 0 && most == 0;
            if (more <= most && depth + more < best.cost &&
                !(idle && c->changes[l] == MOST_CHANGES))
                best = (change){l, label, more, depth + more};
        }
    }
    return best;
}

static void make_change(cleaner *c, const change *made)
{
    if (made->label == 0)
        c->interior->removed++;
    else
        c->interior->filled++;
    if (c->changes[made->leaf] < MOST_CHANGES)
        c->changes[made->leaf]++;
    tm_interior_set_label(c->interior, c->octree, made->leaf, made->label);
}

/* Gives one of the leaves around a node one of the other labels there. Where all masks
 * are good that must do no harm. */
static bool mend(cleaner *c, const tm_contact *around, size_t count, bool only_smaller)
{
    const uint32_t *octant = c->interior->octant[around->node];
    const bool must = count_bad(octant) > 0;
    const label_list to = labels_around(octant);
    const change best =
        find_change(c, around, count, &to, must ? INT_MAX : 0, only_smaller);
    if (best.leaf != TM_NONE)
        make_change(c, &best);
    return best.leaf != TM_NONE;
}

/* Whether something is wrong at a node still: also with the leaves around it. */
static bool is_bad(const cleaner *c, const tm_contact *around, size_t count)
{
    if (node_badness(c, around->node) > 0)
        return true;
    for (size_t i = 0; c->strict && i < count; i++)
        if (count_flat(c, around[i].leaf) > 0)
            return true;
    return false;
}

/* A round: false in *any where nothing was changed. */
static tm_status clean_once(cleaner *c, bool only_smaller, bool *any, tm_error *error)
{
    const tm_status status = find_contacts(c, error);
    *any = false;
    if (status != TM_OK)
        return status;
    for (size_t i = 0, next; i < c->contacts.count; i = next) {
        const tm_contact *around = &c->contacts.contact[i];
        next = tm_contacts_next(&c->contacts, i);
        if (is_bad(c, around, next - i))
            *any |= mend(c, around, next - i, only_smaller);
    }
    return TM_OK;
}

/* Looks after all that is not as in the surface. */
static tm_status clean_all(cleaner *c, tm_error *error)
{
    size_t least = SIZE_MAX;
    bool any = true;
    c->strict = true;
    memset(c->changes, 0, c->octree->leaves);
    for (int round = 0, vain = 0; any && round < STRICT_ROUNDS && vain < VAIN_ROUNDS;
         round++) {
        const tm_status status = clean_once(c, false, &any, error);
        if (status != TM_OK)
            return status;
        vain = c->wrong < least ? 0 : vain + 1;
        least = c->wrong < least ? c->wrong : least;
    }
    return TM_OK;
}

/* Looks after masks, until all are good. */
static tm_status clean_masks(cleaner *c, tm_error *error)
{
    bool any = true;
    c->strict = false;
    for (int round = 0; any; round++) {
        const tm_status status = clean_once(c, round >= FREE_ROUNDS, &any, error);
        if (status != TM_OK)
            return status;
    }
    return TM_OK;
}

static void label_leaves(cleaner *c)
{
    const tm_octree *octree = c->octree;
    for (size_t l = 0; l < octree->leaves; l++) {
        const tm_leaf *leaf = &octree->leaf[l];
        if (leaf->crossed && leaf->level > c->finest)
            c->finest = leaf->level;
        double centre[3];
        uint32_t label = l > 0 ? c->interior->label[l - 1] : 0;
        tm_leaf_centre(octree, leaf, centre);
        if (l == 0 || !tm_leaf_is_as_before(octree, l))
            label = tm_surface_region_at(c->surface, centre);
        tm_interior_set_label(c->interior, octree, l, label);
    }
}

/* Counts what is wrong at nodes, faces aside, and makes it cost more to go by there. */
static size_t remember(const cleaner *c)
{
    const tm_node_lattice *lattice = &c->layout.lattice;
    float *history = c->layout.history;
    size_t wrong = 0;
    for (uint32_t n = 0; n < c->octree->nodes; n++) {
        if (node_badness(c, n) == 0)
            continue;
        wrong++;
        history[n] += 1;
        for (int side = 0; side < 6; side++)
            if (lattice->next[n][side] != TM_NONE)
                history[lattice->next[n][side]] += 1;
    }
    return wrong;
}

static void put_all(cleaner *c, const uint32_t *label)
{
    for (size_t l = 0; l < c->octree->leaves; l++)
        if (c->interior->label[l] != label[l])
            tm_interior_set_label(c->interior, c->octree, l, label[l]);
}

/* Lays out corners and curves and cleans what is around them; *wrong is what is left. */
static tm_status lay_out_once(cleaner *c, size_t *wrong, tm_error *error)
{
    const size_t lost_weight = 10;
    tm_status status = tm_region_lay_out(&c->layout, error);
    c->fixed = c->layout.fixed;
    c->sharp = c->layout.sharp;
    if (status == TM_OK)
        status = clean_all(c, error);
    if (status == TM_OK)
        *wrong = remember(c) + lost_weight * c->layout.lost;
    c->fixed = c->laid;
    c->sharp = NULL;
    return status;
}

/* The same again and again while something is wrong then: elsewhere, with what was learnt
 * (L. McMurchie and C. Ebeling, PathFinder, 1995). Leaves the best that was found. */
static tm_status lay_out_best(cleaner *c, tm_error *error)
{
    enum { TRIES = 6 };
    const size_t leaves = c->octree->leaves, bytes = leaves * sizeof(uint32_t);
    uint32_t *start = tm_new(leaves, sizeof *start);
    uint32_t *best = tm_new(leaves, sizeof *best);
    tm_status status = TM_OK;
    size_t least = SIZE_MAX, wrong = 0;
    int vain = 0;
    if (!start || !best) {
        free(start);
        free(best);
        return tm_fail_memory(error);
    }
    memcpy(start, c->interior->label, bytes);
    memcpy(best, start, bytes);
    for (int i = 0; status == TM_OK && least > 0 && vain < VAIN_ROUNDS && i < TRIES;
         i++) {
        put_all(c, start);
        status = lay_out_once(c, &wrong, error);
        vain++;
        if (status == TM_OK && wrong < least) {
            vain = 0;
            memcpy(best, c->interior->label, bytes);
            memcpy(c->laid, c->layout.fixed, leaves * sizeof *c->laid);
            least = wrong;
        }
    }
    put_all(c, best);
    free(start);
    free(best);
    return status;
}

tm_status tm_interior_label(tm_interior *interior, const tm_octree *octree,
                            const tm_surface *surface, bool lay_out, tm_error *error)
{
    interior->label = tm_new(octree->leaves, sizeof *interior->label);
    interior->octant = calloc(octree->nodes + 1, sizeof *interior->octant);
    cleaner c = {.octree = octree,
                 .surface = surface,
                 .interior = interior,
                 .strict = true,
                 .laid = calloc(octree->leaves + 1, 1),
                 .bad = malloc(octree->nodes + 1),
                 .changes = calloc(octree->leaves + 1, 1)};
    const bool ok = interior->label && interior->octant && c.laid && c.bad && c.changes;
    tm_status status = tm_region_layout_make(&c.layout, octree, surface, interior, error);
    if (status == TM_OK && !ok)
        status = tm_fail_memory(error);
    if (ok && status == TM_OK) {
        label_leaves(&c);
        c.fixed = c.laid;
        status = lay_out ? lay_out_best(&c, error) : clean_all(&c, error);
        if (status == TM_OK)
            status = clean_masks(&c, error);
    }
    for (size_t l = 0; l < octree->leaves && ok && status == TM_OK; l++)
        interior->chosen[l] = interior->label[l] != 0;
    tm_region_layout_free(&c.layout);
    free(c.laid);
    free(c.bad);
    free(c.changes);
    free(c.contacts.contact);
    return status;
}
