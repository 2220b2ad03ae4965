/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's memory, and what it knows of each tetrahedron and node. */
#include "improve_engine.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

/* Of a rough surface normals side by side may differ by so much: degrees. */
static const double rough_bend = 80;

/* How much a very bad tetrahedron costs beside 1 for a bad one. */
static const double cost_weight = 3;

/* What replaces tetrahedra may be worse than the worst of them by this factor of the
 * measure, if it costs less in all. */
static const double looseness = 0.5, kick_looseness = 0.25;

/* Or, of the last ones, has to be better by this factor. */
static const double strictness = 1.01;

/* So many tetrahedra are copied in the time of a unit of work; they are measured, too,
 * when they are restored. */
static const size_t tets_kept = 512;

bool tm_improve_no_memory(tm_improver *m)
{
    m->status = tm_fail_memory(m->error);
    return false;
}

/* Grows one array to hold `needed` items; *room is left alone. */
static bool grow(void *array, size_t room, size_t needed, size_t size)
{
    void *old, *moved;
    memcpy(&old, array, sizeof old);
    moved = tm_grow(old, &room, needed, size);
    if (moved)
        memcpy(array, &moved, sizeof moved);
    return moved != NULL;
}

static bool reserve_nodes(tm_improver *m, size_t needed)
{
    size_t room = needed + needed / 2;
    uint32_t **list[] = {&m->tet_at, &m->changed, &m->smoothed, &m->contracted};
    if (!tm_features_reserve(&m->features, needed, m->mesh->face_room))
        return false;
    if (needed <= m->node_room)
        return true;
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        if (!grow(list[k], m->node_room, room, sizeof **list[k]))
            return false;
        memset(*list[k] + m->node_room, 0, (room - m->node_room) * sizeof **list[k]);
    }
    m->node_room = room;
    return true;
}

static bool reserve_tets(tm_improver *m, size_t needed)
{
    size_t room = needed + needed / 2;
    if (needed <= m->tet_room)
        return true;
    if (!grow(&m->quality, m->tet_room, room, sizeof *m->quality) ||
        !grow(&m->tried, m->tet_room, room, sizeof *m->tried) ||
        !grow(&m->stubborn, m->tet_room, room, sizeof *m->stubborn))
        return false;
    memset(m->stubborn + m->tet_room, 0, (room - m->tet_room) * sizeof *m->stubborn);
    m->tet_room = room;
    return true;
}

static bool reserve_made(tm_improver *m, size_t needed)
{
    if (needed <= m->made_room)
        return true;
    if (!grow(&m->node, m->made_room, needed, sizeof *m->node) ||
        !grow(&m->created, m->made_room, needed, sizeof *m->created) ||
        !grow(&m->swallowed, m->made_room, 4 * needed, sizeof *m->swallowed))
        return false;
    m->made_room = needed;
    return true;
}

bool tm_improve_reserve(tm_improver *m, size_t tets, size_t nodes)
{
    size_t faces = nodes > 0 ? tets : 0; /* of an edge that is split */
    m->status = tm_tet_mesh_reserve(m->mesh, nodes, tets, faces, 0, m->error);
    if (m->status != TM_OK)
        return false;
    if (!reserve_nodes(m, m->mesh->nodes + nodes) ||
        !reserve_tets(m, m->mesh->slots + tets) || !reserve_made(m, tets))
        return tm_improve_no_memory(m);
    return true;
}

static double measure(const tm_improver *m, uint32_t t)
{
    const uint32_t *n = m->mesh->tet[t];
    const double(*x)[3] = (const double(*)[3])m->mesh->xyz;
    return tm_tet_measure_of(m->cost.measure, x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
}

/* Measures a tetrahedron that the last change made. */
static void note(tm_improver *m, uint32_t t)
{
    m->quality[t] = measure(m, t);
    m->tried[t] = 0;
    for (int i = 0; i < 4; i++) {
        m->tet_at[m->mesh->tet[t][i]] = t;
        m->changed[m->mesh->tet[t][i]] = m->change;
    }
}

void tm_improve_note(tm_improver *m, const uint32_t *created, size_t count)
{
    m->change++;
    for (size_t k = 0; k < count; k++) {
        note(m, created[k]);
        if (m->recording && !tm_mesh_part_add(&m->changes, m->mesh, created[k]))
            tm_improve_no_memory(m);
    }
}

double tm_improve_old_cost(const tm_improver *m, const uint32_t *old, size_t count,
                           double *least)
{
    double worst = m->cost.target, sum = 0;
    for (size_t i = 0; i < count; i++) {
        double quality = m->quality[old[i]];
        sum += tm_cost_of(&m->cost, quality);
        worst = quality < worst ? quality : worst;
    }
    *least = worst * (m->last ? strictness : m->price < 0 ? kick_looseness : looseness);
    return sum;
}

void tm_improve_set_price(tm_improver *m, double price)
{
    m->price = price;
    memset(m->tried, 0, m->mesh->slots * sizeof *m->tried);
    memset(m->contracted, 0, m->mesh->nodes * sizeof *m->contracted);
}

double tm_improve_target(const tm_improver *m, double degrees)
{
    const double volume_quality_per_degree = 0.01;
    return m->cost.measure == TM_MEASURE_DIHEDRAL ? tm_bad_sine2(degrees)
                                                  : degrees * volume_quality_per_degree;
}

void tm_improve_set_target(tm_improver *m, double degrees)
{
    m->degrees = degrees;
    m->cost.target = tm_improve_target(m, degrees);
    memset(m->smoothed, 0, m->mesh->nodes * sizeof *m->smoothed);
    tm_improve_set_price(m, 0);
}

/* Measures the whole mesh; nothing of it has been tried. */
static void note_all(tm_improver *m)
{
    const tm_tet_mesh *mesh = m->mesh;
    m->change++;
    for (size_t v = 0; v < mesh->nodes; v++)
        m->tet_at[v] = TM_NONE;
    for (uint32_t t = 0; t < mesh->slots; t++)
        if (tm_tet_lives(mesh, t))
            note(m, t);
}

void tm_improve_snapshot(tm_improver *m, tm_improve_state *state, size_t bad,
                         double badness)
{
    if (m->status != TM_OK)
        return;
    state->bad = bad;
    m->work += m->mesh->slots / tets_kept;
    state->badness = badness;
    state->done = m->report->done;
    m->status = tm_tet_mesh_copy(&state->mesh, m->mesh, m->error);
    if (m->status == TM_OK && !tm_features_copy(&state->features, &m->features))
        tm_improve_no_memory(m);
}

void tm_improve_keep(tm_improver *m, tm_improve_state *state)
{
    size_t bad = tm_improve_count_bad(m);
    tm_improve_snapshot(m, state, bad, tm_improve_badness(m, m->mesh->tets, bad));
}

void tm_improve_restore(tm_improver *m, const tm_improve_state *state)
{
    if (m->status != TM_OK)
        return;
    m->report->done = state->done;
    m->work += 2 * (m->mesh->slots / tets_kept);
    m->status = tm_tet_mesh_copy(m->mesh, &state->mesh, m->error);
    if (m->status == TM_OK && !tm_features_copy(&m->features, &state->features))
        tm_improve_no_memory(m);
    if (m->status == TM_OK)
        note_all(m);
}

void tm_improve_forbid(tm_improver *m, double degrees)
{
    tm_angle_limits_narrow(&m->cost.limits, degrees);
}

tm_angle_limits tm_improve_angles(const tm_improver *m)
{
    const double(*x)[3] = (const double(*)[3])m->mesh->xyz;
    tm_angle_limits angles = tm_angle_limits_none();
    for (uint32_t t = 0; t < m->mesh->slots; t++) {
        const uint32_t *n = m->mesh->tet[t];
        if (tm_tet_lives(m->mesh, t))
            tm_angle_limits_include(&angles, x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
    }
    return angles;
}

/* No angle may be bad and more extreme than those of the mesh. */
static void find_limits(tm_improver *m)
{
    m->cost.limits = tm_improve_angles(m);
    tm_angle_limits_widen(&m->cost.limits, m->options->angle);
}

tm_status tm_improve_start(tm_improver *m, tm_tet_mesh *mesh,
                           const tm_improve_options *options, tm_improve_report *report,
                           tm_error *error)
{
    *m =
        (tm_improver){.mesh = mesh, .options = options, .report = report, .error = error};
    m->at.what = "improving";
    tm_progress_tell(options->progress, &m->at);
    *report = (tm_improve_report){.tets_before = mesh->tets};
    m->work_most = SIZE_MAX;
    m->most_tets = tm_tet_mesh_most(mesh, options->max_growth);
    m->full_size = mesh->tets < m->most_tets ? mesh->tets : m->most_tets;
    m->cost.measure = m->options->measure;
    m->cost.weight = cost_weight;
    m->status =
        tm_features_find(&m->features, mesh, &options->surface, &m->marks, m->error);
    if (m->status != TM_OK)
        return m->status;
    if (!reserve_nodes(m, mesh->nodes + 1) || !reserve_tets(m, mesh->slots + 1)) {
        tm_improve_no_memory(m);
        return m->status;
    }
    m->space = tm_space_around((const double(*)[3])mesh->xyz, mesh->nodes);
    note_all(m);
    find_limits(m);
    for (size_t v = 0; v < mesh->nodes; v++)
        m->report->nodes_free[m->features.dimension[v]] += m->tet_at[v] != TM_NONE;
    if (m->features.may_move) {
        const tm_surface *reference = m->features.envelope.reference;
        double most = options->surface.feature_angle;
        m->least_cosine =
            cos(degree * (reference->rough ? fmax(most, rough_bend) : most));
        report->tolerance = m->features.envelope.tolerance;
        report->patches = reference->patches;
        report->curves = reference->curves;
        report->corners = reference->corners;
    }
    tm_improve_set_target(m, options->angle);
    return TM_OK;
}

void tm_improve_finish(tm_improver *m)
{
    uint32_t *list[] = {m->tet_at,  m->changed, m->smoothed, m->contracted, m->swallowed,
                        m->created, m->target,  m->tried,    m->stubborn,   m->cluster};
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++)
        free(list[k]);
    free(m->quality);
    free(m->node);
    tm_improve_state *state[] = {&m->best,  &m->earlier, &m->reached,
                                 &m->input, &m->whole,   &m->kept};
    for (size_t k = 0; k < sizeof state / sizeof state[0]; k++) {
        tm_tet_mesh_free(&state[k]->mesh);
        tm_features_free(&state[k]->features);
    }
    tm_mesh_part_free(&m->changes);
    tm_features_free(&m->features);
    tm_tet_marks_free(&m->marks);
    tm_tet_marks_free(&m->seen);
    tm_tet_marks_free(&m->linked);
    tm_star_free(&m->star);
    tm_star_free(&m->around);
    tm_ball_free(&m->ball);
    tm_ball_free(&m->other_ball);
    tm_cavity_free(&m->cavity);
    tm_replacement_table_free(&m->table);
}
