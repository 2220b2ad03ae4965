/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --against SURFACE: how far a mesh's surface is from another. */
#ifndef CMD_COMMON_AGAINST_H
#define CMD_COMMON_AGAINST_H

#include "../../../lib/surface/measure/surface_distance.h"
#include "../app/filter.h"

enum { AGAINST = FILTER_OWN + 64, AGAINST_FEATURE_ANGLE };

/* Rows of a filter's table of options, and lines of its --help. */
/* clang-format off */
#define AGAINST_OPTIONS \
    {"against", required_argument, NULL, AGAINST}, \
    {"feature-angle", required_argument, NULL, AGAINST_FEATURE_ANGLE}
/* clang-format on */
#define AGAINST_SYNOPSIS "[--against SURFACE] [--feature-angle DEG]"
#define AGAINST_HELP                                                                     \
    "      --against SURFACE\n"                                                          \
    "                      how far the mesh's surface is from this one, both ways, "     \
    "and\n"                                                                              \
    "                      so its sharp edges and corners; any surface file, or a "      \
    "mesh\n"                                                                             \
    "      --feature-angle DEG\n"                                                        \
    "                      with it: an edge is sharp where the normals beside it "       \
    "differ\n"                                                                           \
    "                      by more (40)\n"

typedef struct against {
    const char *file; /* NULL: the option is not given */
    double feature_angle;
    bool angle_given;
    tm_surface_comparison found;
} against;

/* {0} with the default angle. */
against against_start(void);

/* Takes one of the two options. */
void against_option(const filter *f, against *a, int option);

/* After all options: --feature-angle needs --against, and SURFACE is a file. */
void against_check(const filter *f, const against *a);

/* Reads SURFACE and measures, if the option is given; exits on failure. The surface of a
 * mesh: faces on the boundary, between tetrahedra (or mixed elements) of different
 * regions, and others that have a row with a marker; faces with more corners than three
 * are fans of triangles. */
void against_measure(const filter *f, against *a, const tm_stream *mesh);

/* Where the option is given: an object "against", and lines of a table. */
void against_json(tm_json *json, const against *a);
void against_text(tm_text *text, const against *a, int label_width);

/* The largest distance: of surfaces, curves and corners, both ways. */
double against_most(const against *a);

#endif
