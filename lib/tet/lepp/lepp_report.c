/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lepp.h"

static void histogram(tm_json *json, const char *key, const size_t *count, size_t bins)
{
    tm_json_open(json, key, '[');
    for (size_t i = 0; i < bins; i++)
        tm_json_integer(json, NULL, (int64_t)count[i]);
    tm_json_close(json, ']');
}

static void operations_json(tm_json *json, const tm_lepp_report *r)
{
    tm_json_open(json, "operations", '{');
    tm_json_integer(json, "edge_removals", (int64_t)r->swaps);
    tm_json_integer(json, "centroids", (int64_t)r->centroids);
    tm_json_integer(json, "midpoints", (int64_t)r->midpoints);
    tm_json_integer(json, "boundary_midpoints", (int64_t)r->open_midpoints);
    tm_json_close(json, '}');
}

static void refused_json(tm_json *json, const tm_lepp_report *r)
{
    tm_json_open(json, "refused", '{');
    tm_json_integer(json, "closed", (int64_t)r->refused_closed);
    tm_json_integer(json, "open", (int64_t)r->refused_open);
    tm_json_integer(json, "locked", (int64_t)r->locked);
    tm_json_integer(json, "above_max_star", (int64_t)r->above_max);
    tm_json_integer(json, "above_max_growth", (int64_t)r->no_room);
    tm_json_integer(json, "for_extreme_angles", (int64_t)r->angle_kept);
    tm_json_close(json, '}');
}

static void sizes_json(tm_json *json, const tm_lepp_report *r)
{
    size_t refused_closed[TM_LEPP_SIZES], refused_open[TM_LEPP_SIZES];
    for (int i = 0; i < TM_LEPP_SIZES; i++) {
        refused_closed[i] = r->closed_size[i] - r->swap_size[i] - r->insertion_size[i];
        refused_open[i] = r->open_size[i] - r->open_insertion_size[i];
    }
    tm_json_open(json, "sizes", '{');
    histogram(json, "closed", r->closed_size, TM_LEPP_SIZES);
    histogram(json, "open", r->open_size, TM_LEPP_SIZES);
    histogram(json, "swapped", r->swap_size, TM_LEPP_SIZES);
    histogram(json, "inserted", r->insertion_size, TM_LEPP_SIZES);
    histogram(json, "inserted_open", r->open_insertion_size, TM_LEPP_SIZES);
    histogram(json, "refused", refused_closed, TM_LEPP_SIZES);
    histogram(json, "refused_open", refused_open, TM_LEPP_SIZES);
    tm_json_close(json, '}');
}

static void stars_json(tm_json *json, const tm_lepp_options *o, const tm_lepp_report *r)
{
    tm_json_open(json, "stars", '{');
    tm_json_integer(json, "closed", (int64_t)r->closed);
    tm_json_integer(json, "open", (int64_t)r->open);
    refused_json(json, r);
    tm_json_open(json, "invalid_centroids", '{');
    tm_json_integer(json, "outside", (int64_t)r->outside);
    tm_json_integer(json, "tangled", (int64_t)r->tangled);
    tm_json_close(json, '}');
    if (o->count_invalid_swaps)
        tm_json_integer(json, "invalid_swaps", (int64_t)r->no_swap);
    sizes_json(json, r);
    tm_json_integer(json, "too_large_to_swap", (int64_t)r->too_large);
    histogram(json, "visited", r->visited, TM_LEPP_VISITS);
    tm_json_integer(json, "visits", (int64_t)r->visits);
    tm_json_integer(json, "most_visited", (int64_t)r->most_visited);
    if (o->path == TM_LEPP_FULL)
        histogram(json, "branches", r->branches, TM_LEPP_VISITS);
    tm_json_integer(json, "longest_path", (int64_t)r->longest);
    tm_json_integer(json, "abandoned", (int64_t)r->abandoned);
    tm_json_close(json, '}');
}

static void sweep_json(tm_json *json, const char *key, const tm_lepp_sweep_report *r,
                       const char *done, const char *on_surface)
{
    tm_json_open(json, key, '{');
    tm_json_integer(json, "sweeps", (int64_t)r->sweeps);
    tm_json_integer(json, "tried", (int64_t)r->tried);
    tm_json_integer(json, "invalid", (int64_t)r->invalid);
    tm_json_integer(json, done, (int64_t)tm_lepp_swept(r));
    tm_json_integer(json, on_surface, (int64_t)r->on_surface);
    histogram(json, "by_sweep", r->done, TM_LEPP_SWEEPS);
    tm_json_close(json, '}');
}

static void delaunay_json(tm_json *json, const tm_lepp_report *r)
{
    tm_json_open(json, "delaunay", '{');
    tm_json_integer(json, "wrong_faces_before", (int64_t)r->not_delaunay_before);
    tm_json_integer(json, "wrong_faces_after", (int64_t)r->not_delaunay_after);
    tm_json_integer(json, "cavities", (int64_t)r->delaunay.insertions);
    tm_json_integer(json, "tets_removed", (int64_t)r->delaunay.removed);
    tm_json_integer(json, "facet_flips", (int64_t)r->delaunay.flipped);
    tm_json_integer(json, "stopped_at_faces", (int64_t)r->delaunay.stopped);
    tm_json_integer(json, "refused", (int64_t)r->delaunay.refused);
    tm_json_integer(json, "cut_back", (int64_t)r->delaunay.cut_back);
    tm_json_close(json, '}');
}

void tm_lepp_report_json(tm_json *json, const tm_lepp_options *options,
                         const tm_lepp_report *report)
{
    tm_json_integer(json, "passes", (int64_t)report->passes);
    tm_json_integer(json, "targets", (int64_t)report->targets);
    operations_json(json, report);
    stars_json(json, options, report);
    if (options->sweeps & TM_SWEEP_SMOOTH)
        sweep_json(json, "smoothing", &report->smooth, "moved", "moved_on_surface");
    if (options->sweeps & TM_SWEEP_SWAP)
        sweep_json(json, "face_swaps", &report->swap, "swapped", "swapped_2_2");
    if (options->algorithm == TM_LEPP_DELAUNAY)
        delaunay_json(json, report);
}
