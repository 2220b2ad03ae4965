/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../../text/report.h"
#include "lepp.h"

#define ROW(key, member)   TM_REPORT_ROW(key, NULL, NULL, tm_lepp_report, member)
#define SWEEP(key, member) TM_REPORT_ROW(key, NULL, NULL, tm_lepp_sweep_report, member)

static const tm_report_row head[] = {ROW("passes", passes),
                                     ROW("targets", targets),
                                     TM_REPORT_OPEN_ROW("operations"),
                                     ROW("edge_removals", swaps),
                                     ROW("centroids", centroids),
                                     ROW("midpoints", midpoints),
                                     ROW("boundary_midpoints", open_midpoints),
                                     TM_REPORT_CLOSE_ROW,
                                     TM_REPORT_OPEN_ROW("stars"),
                                     ROW("closed", closed),
                                     ROW("open", open),
                                     TM_REPORT_OPEN_ROW("refused"),
                                     ROW("closed", refused_closed),
                                     ROW("open", refused_open),
                                     ROW("locked", locked),
                                     ROW("above_max_star", above_max),
                                     ROW("above_max_growth", no_room),
                                     ROW("for_extreme_angles", angle_kept),
                                     TM_REPORT_CLOSE_ROW,
                                     TM_REPORT_OPEN_ROW("invalid_centroids"),
                                     ROW("outside", outside),
                                     ROW("tangled", tangled),
                                     TM_REPORT_CLOSE_ROW,
                                     {0}};
static const tm_report_row invalid_swaps[] = {ROW("invalid_swaps", no_swap), {0}};
static const tm_report_row sizes[] = {ROW("closed", closed_size),
                                      ROW("open", open_size),
                                      ROW("swapped", swap_size),
                                      ROW("inserted", insertion_size),
                                      ROW("inserted_open", open_insertion_size),
                                      {0}};
static const tm_report_row refused_sizes[] = {
    ROW("refused", closed_size), ROW("refused_open", open_size), {0}};
static const tm_report_row visits[] = {ROW("too_large_to_swap", too_large),
                                       ROW("visited", visited),
                                       ROW("visits", visits),
                                       ROW("most_visited", most_visited),
                                       {0}};
static const tm_report_row branches[] = {ROW("branches", branches), {0}};
static const tm_report_row paths[] = {
    ROW("longest_path", longest), ROW("abandoned", abandoned), {0}};

static const tm_report_row delaunay[] = {TM_REPORT_OPEN_ROW("delaunay"),
                                         ROW("wrong_faces_before", not_delaunay_before),
                                         ROW("wrong_faces_after", not_delaunay_after),
                                         ROW("cavities", delaunay.insertions),
                                         ROW("tets_removed", delaunay.removed),
                                         ROW("facet_flips", delaunay.flipped),
                                         ROW("stopped_at_faces", delaunay.stopped),
                                         ROW("refused", delaunay.refused),
                                         ROW("cut_back", delaunay.cut_back),
                                         TM_REPORT_CLOSE_ROW,
                                         {0}};

static const tm_report_row larger[] = {TM_REPORT_OPEN_ROW("larger"),
                                       ROW("before", larger_before),
                                       ROW("after", larger_after),
                                       TM_REPORT_CLOSE_ROW,
                                       {0}};

static const tm_report_row sweep[] = {
    SWEEP("sweeps", sweeps), SWEEP("tried", tried), SWEEP("invalid", invalid), {0}};
static const tm_report_row by_sweep[] = {SWEEP("by_sweep", done), {0}};

static void sizes_json(tm_json *json, const tm_lepp_report *r)
{
    tm_lepp_report refused = *r;
    for (int i = 0; i < TM_LEPP_SIZES; i++) {
        refused.closed_size[i] -= r->swap_size[i] + r->insertion_size[i];
        refused.open_size[i] -= r->open_insertion_size[i];
    }
    tm_json_open(json, "sizes", '{');
    tm_report_json(json, sizes, r);
    tm_report_json(json, refused_sizes, &refused);
    tm_json_close(json, '}');
}

static void sweep_json(tm_json *json, const char *key, const tm_lepp_sweep_report *r,
                       const char *done, const char *on_surface)
{
    tm_json_open(json, key, '{');
    tm_report_json(json, sweep, r);
    tm_json_integer(json, done, (int64_t)tm_lepp_swept(r));
    tm_json_integer(json, on_surface, (int64_t)r->on_surface);
    tm_report_json(json, by_sweep, r);
    tm_json_close(json, '}');
}

void tm_lepp_report_json(tm_json *json, const tm_lepp_options *options,
                         const tm_lepp_report *report)
{
    tm_report_json(json, head, report);
    if (options->count_invalid_swaps)
        tm_report_json(json, invalid_swaps, report);
    sizes_json(json, report);
    tm_report_json(json, visits, report);
    if (options->path == TM_LEPP_FULL)
        tm_report_json(json, branches, report);
    tm_report_json(json, paths, report);
    tm_json_close(json, '}'); /* stars */
    if (options->sweeps & TM_SWEEP_SMOOTH)
        sweep_json(json, "smoothing", &report->smooth, "moved", "moved_on_surface");
    if (options->sweeps & TM_SWEEP_SWAP)
        sweep_json(json, "face_swaps", &report->swap, "swapped", "swapped_2_2");
    if (options->algorithm == TM_LEPP_DELAUNAY)
        tm_report_json(json, delaunay, report);
    if (options->sizes.longest > 0 || options->sizes.attribute > 0)
        tm_report_json(json, larger, report);
}
