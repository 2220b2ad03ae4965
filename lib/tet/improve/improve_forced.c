/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "improve_forced.h"

#include "../../base/array.h"
#include "../../element/tet_quality.h"

#include <stdlib.h>

void tm_forced_free(tm_forced *forced)
{
    free(forced->sector);
    *forced = (tm_forced){0};
}

/* The sector that tetrahedra around edge ab add up to. */
typedef struct {
    const tm_tet_mesh *mesh;
    uint32_t a, b;
    double limit;
    double degrees;
    size_t tets;
    uint32_t lowest; /* of the tetrahedra */
} sector;

static void dihedrals(const tm_tet_mesh *mesh, uint32_t t, double degrees[TM_TET_EDGES])
{
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    const uint32_t *n = mesh->tet[t];
    tm_tet_dihedrals(x[n[0]], x[n[1]], x[n[2]], x[n[3]], degrees);
}

/* The angle of t at the edge of the sector. */
static double angle_at(const sector *s, uint32_t t)
{
    double degrees[TM_TET_EDGES];
    dihedrals(s->mesh, t, degrees);
    for (int e = 0; e < TM_TET_EDGES; e++) {
        uint32_t v = s->mesh->tet[t][tm_edge_corner[e][0]];
        uint32_t w = s->mesh->tet[t][tm_edge_corner[e][1]];
        if ((v == s->a && w == s->b) || (v == s->b && w == s->a))
            return degrees[e];
    }
    return 0;
}

static bool is_below(const sector *s)
{
    return s->degrees < s->limit - TM_ANGLE_TOLERANCE;
}

/* Adds what is beyond face i of t, up to a constrained face; false where there is none
 * below the limit. */
static bool walk(sector *s, uint32_t t, uint32_t i)
{
    const tm_tet_mesh *mesh = s->mesh;
    const uint32_t first = t;
    while (!(mesh->neighbour[t][i] & TM_FACE_BIT)) {
        uint32_t across = mesh->neighbour[t][i], behind = across % 4;
        t = across / 4;
        if (t == first)
            return false;
        s->degrees += angle_at(s, t);
        s->lowest = t < s->lowest ? t : s->lowest;
        s->tets++;
        if (!is_below(s))
            return false;
        /* On through the face with the edge that is not the one behind. */
        i = 0;
        while (i == behind || mesh->tet[t][i] == s->a || mesh->tet[t][i] == s->b)
            i++;
    }
    return true;
}

/* Whether t is in a sector at its edge e, with that angle, that is below the limit. */
static bool find_sector(sector *s, const tm_tet_mesh *mesh, uint32_t t, int e,
                        double degrees, double limit)
{
    const uint8_t *corner = tm_edge_corner[e];
    const uint32_t *n = mesh->tet[t];
    *s = (sector){mesh, n[corner[0]], n[corner[1]], limit, degrees, 1, t};
    return is_below(s) && walk(s, t, corner[2]) && walk(s, t, corner[3]);
}

static bool add_sector(tm_forced *forced, const sector *s)
{
    tm_forced_sector *list =
        tm_grow(forced->sector, &forced->room, forced->sectors + 1, sizeof *list);
    if (!list)
        return false;
    forced->sector = list;
    tm_forced_sector *added = &list[forced->sectors++];
    *added = (tm_forced_sector){.degrees = s->degrees, .tets = s->tets};
    for (int x = 0; x < 3; x++)
        added->midpoint[x] = (s->mesh->xyz[s->a][x] + s->mesh->xyz[s->b][x]) / 2;
    return true;
}

/* Looks at all edges of a bad tetrahedron; a sector is added by its lowest one. */
static bool look_at(tm_forced *forced, const tm_tet_mesh *mesh, uint32_t t, double limit)
{
    double degrees[TM_TET_EDGES];
    bool any = false;
    sector s;
    dihedrals(mesh, t, degrees);
    for (int e = 0; e < TM_TET_EDGES; e++) {
        if (!find_sector(&s, mesh, t, e, degrees[e], limit))
            continue;
        any = true;
        if (s.lowest == t && !add_sector(forced, &s))
            return false;
    }
    forced->tets += any;
    return true;
}

tm_status tm_forced_find_in(tm_forced *forced, const tm_tet_mesh *mesh, const bool *own,
                            double degrees, tm_error *error)
{
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    double bad = tm_bad_sine2(degrees);
    *forced = (tm_forced){0};
    for (uint32_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        if (!tm_tet_lives(mesh, t) || (own && !own[t]) ||
            tm_tet_sine2(x[n[0]], x[n[1]], x[n[2]], x[n[3]]) >= bad)
            continue;
        forced->bad++;
        if (!look_at(forced, mesh, t, degrees)) {
            tm_forced_free(forced);
            return tm_fail_memory(error);
        }
    }
    return TM_OK;
}

tm_status tm_forced_find(tm_forced *forced, const tm_tet_mesh *mesh, double degrees,
                         tm_error *error)
{
    return tm_forced_find_in(forced, mesh, NULL, degrees, error);
}

void tm_forced_json(tm_json *json, const tm_forced *forced)
{
    tm_json_open(json, "forced", '{');
    tm_json_integer(json, "bad", (int64_t)forced->bad);
    tm_json_integer(json, "tets", (int64_t)forced->tets);
    tm_json_open(json, "sectors", '[');
    for (size_t k = 0; k < forced->sectors; k++) {
        const tm_forced_sector *s = &forced->sector[k];
        tm_json_open(json, NULL, '{');
        tm_json_open(json, "midpoint", '[');
        for (int x = 0; x < 3; x++)
            tm_json_double(json, NULL, s->midpoint[x]);
        tm_json_close(json, ']');
        tm_json_double(json, "degrees", s->degrees);
        tm_json_integer(json, "tets", (int64_t)s->tets);
        tm_json_close(json, '}');
    }
    tm_json_close(json, ']');
    tm_json_close(json, '}');
}
