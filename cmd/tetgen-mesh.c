/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tetgen-mesh: tetrahedra of a surface or of points, made by TetGen. */
#include "common/input/mesh_input.h"
#include "common/input/surface_input.h"
#include "common/process/tetgen.h"

#include "../lib/stream/coordinates.h"
#include "../lib/surface/surface_defects.h"
#include "../lib/format/tetgen.h"

#include <float.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_SWITCHES = FILTER_OWN, OPTION_TETGEN };

static const struct option options[] = {
    {"quality", optional_argument, NULL, 'q'},
    {"max-volume", required_argument, NULL, 'a'},
    {"keep-surface", no_argument, NULL, 'Y'},
    {"switches", required_argument, NULL, OPTION_SWITCHES},
    {"tetgen", required_argument, NULL, OPTION_TETGEN},
    FILTER_OPTIONS,
};

static filter f = {
    .name = "tetgen-mesh",
    .synopsis = "[-q[RATIO]] [-a VOLUME] [-Y] [--switches S] [--tetgen PROG] [SURFACE]",
    .purpose = "Fill a surface with tetrahedra, or join points to tetrahedra, by TetGen.",
    .help = "  -q, --quality[=RATIO]     bound the radius-edge ratio (TetGen's own "
            "bound: 2)\n"
            "  -a, --max-volume VOLUME   bound the volume of each tetrahedron\n"
            "  -Y, --keep-surface        put no new nodes on the surface\n"
            "      --switches S          more switches for TetGen\n"
            "      --tetgen PROG         the program to run\n",
    .options = options,
    .letters = "q::a:Y" FILTER_LETTERS,
    .q_is_own = true,
};

/* Options -------------------------------------------------------------------------- */

static void number_switch(char *to, char letter, double value)
{
    *to++ = '-';
    *to++ = letter;
    *tm_write_double(to, value) = '\0';
}

/* The same without an exponent, which TetGen does not read in a ratio. */
static void ratio_switch(char *to, double value)
{
    double read = 0;
    for (int decimals = 0; decimals < DBL_DIG + 2 && read != value; decimals++) {
        snprintf(to, TETGEN_SWITCH, "-q%.*f", decimals, value);
        tm_read_double(to + 2, to + strlen(to), &read);
    }
}

/* What TetGen 1.5 has switches for: those that change the mesh, each with what of a
 * number it reads behind it; those that need files that it is not given, or that write
 * others than are read; those that change nothing here. */
static const struct {
    char letter;
    const char *number;
} taken[] = {{'A', ""},
             {'a', "0123456789.eE+-"},
             {'c', ""},
             {'C', ""},
             {'D', "0123456789"},
             {'e', ""},
             {'f', ""},
             {'J', ""},
             {'M', "0123456789/"},
             {'O', "0123456789/"},
             {'q', "0123456789./"},
             {'S', "0123456789"},
             {'T', "0123456789.eE+-"},
             {'V', ""},
             {'Y', "0123456789/"}};
static const char refused[] = "dhiImNEFloRrtw", idle[] = "BgGkKnpQvxXz";

/* Behind the switch that a text begins with; exits where that is none that is taken. */
static const char *skip_switch(const char *at)
{
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
        if (*at == taken[i].letter)
            return at + 1 + strspn(at + 1, taken[i].number);
    if (strchr(refused, *at))
        filter_usage_error(&f, "--switches: '%c' is not possible here (nor any of %s)",
                           *at, refused);
    if (strchr(idle, *at))
        filter_usage_error(&f, "--switches: '%c' would do nothing here (nor any of %s)",
                           *at, idle);
    filter_usage_error(&f, "--switches: '%c' is no switch of TetGen here", *at);
}

static void take_switches(tetgen_request *r, tm_text *more, const char *switches)
{
    if (*switches == '-')
        switches++;
    if (!*switches)
        filter_usage_error(&f, "--switches: there are none");
    for (const char *at = switches; *at;)
        at = skip_switch(at);
    tm_text_string(more, "-");
    tm_text_string(more, switches);
    r->more = more->byte;
}

static void read_options(tetgen_request *r, tm_text *more)
{
    static const double ratio_min = 1, ratio_max = 1000;
    int c;
    while ((c = filter_option(&f)) != -1) {
        switch (c) {
        case 'q':
            strcpy(r->quality, "-q");
            if (optarg)
                ratio_switch(r->quality,
                             filter_number(&f, "-q", optarg, ratio_min, ratio_max));
            break;
        case 'a':
            number_switch(r->volume, 'a',
                          filter_number(&f, "-a", optarg, DBL_MIN, DBL_MAX));
            break;
        case 'Y':
            r->keep_surface = true;
            break;
        case OPTION_SWITCHES:
            take_switches(r, more, optarg);
            break;
        case OPTION_TETGEN:
            r->program = optarg;
            break;
        default:
            filter_usage_error(&f, "option -%c is unknown", c);
        }
    }
    filter_operands(&f);
}

/* What the input lacks ------------------------------------------------------------- */

_Noreturn static void fail_input(const char *format, ...)
    __attribute__((format(printf, 1, 2)));

_Noreturn static void fail_input(const char *format, ...)
{
    tm_error error = {.status = TM_ERROR_INPUT};
    snprintf(error.file, sizeof error.file, "%s", filter_input_name(&f));
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error.what, sizeof error.what, format, arguments);
    va_end(arguments);
    filter_fail(&f, &error);
}

/* "edges of one face only: 3, such as that from (0, 0, 1) to (1, 0, 1)" */
static void describe_open_edges(const tm_polygon_surface *surface,
                                const tm_surface_defects *defects, tm_text *text)
{
    tm_text_format(text, "edges of one face only: %zu, such as that",
                   defects->open_edges);
    for (int i = 0; i < 2; i++) {
        const double *xyz = surface->xyz[defects->open_edge[i]];
        tm_text_string(text, i == 0 ? " from (" : " to (");
        for (int k = 0; k < 3; k++) {
            tm_text_string(text, k == 0 ? "" : ", ");
            tm_text_double(text, xyz[k]);
        }
        tm_text_string(text, ")");
    }
}

/* Facets of .poly and .smesh files may meet along parts of edges: there an open edge is
 * no sign of a gap. */
static bool edges_must_match(tm_format format)
{
    return format != TM_FORMAT_POLY && format != TM_FORMAT_SMESH;
}

static void check_surface(const tm_polygon_surface *surface,
                          const tm_surface_defects *defects, tm_format format,
                          const tetgen_request *r)
{
    enum { POINTS_MIN = 4 };
    size_t points = surface->nodes - defects->duplicate_nodes;
    if (points < POINTS_MIN)
        fail_input("%zu different points are too few for a tetrahedron (4)", points);
    if (defects->flat)
        fail_input("all points are in one plane (tetrahedra need a volume)");
    if (surface->facets == 0) {
        if (format != TM_FORMAT_NODE && format != TM_FORMAT_STREAM)
            filter_note(&f, "%s: there are no faces: it is taken for points",
                        filter_input_name(&f));
        if (*r->quality || *r->volume || r->keep_surface)
            filter_usage_error(&f, "-q, -a and -Y need a surface, but the input has "
                                   "points alone");
        return;
    }
    if (defects->duplicate_nodes > 0)
        filter_note(&f, "nodes in the place of an earlier one, which TetGen joins: %zu",
                    defects->duplicate_nodes);
    if (defects->repeated_corners > 0)
        filter_note(&f, "faces with two corners in the same place: %zu",
                    defects->repeated_corners);
    filter_verbose(&f, "edges of more than two faces: %zu; unused nodes: %zu",
                   defects->crowded_edges, defects->unused_nodes);
    if (defects->open_edges > 0 && edges_must_match(format)) {
        tm_text text = {0};
        describe_open_edges(surface, defects, &text);
        filter_note(&f, "the surface is not closed: %s", text.byte);
        tm_text_free(&text);
    }
}

_Noreturn static void fail_empty(const tm_polygon_surface *surface,
                                 const tm_surface_defects *defects)
{
    tm_text text = {0};
    if (defects->open_edges > 0)
        describe_open_edges(surface, defects, &text);
    else
        tm_text_string(&text, "perhaps its holes (part 3 of .poly) leave nothing");
    fail_input("TetGen made no tetrahedra: the surface encloses no volume (%s)",
               text.byte);
}

/* The result ----------------------------------------------------------------------- */

/* Moves the blocks of parts (the surface that came in) and the history behind the new
 * mesh; other blocks belong to a mesh that is no longer there. */
static tm_status keep_parts(tm_stream *from, tm_stream *mesh, tm_error *error)
{
    for (size_t b = 0; b < from->blocks; b++) {
        tm_block *old = &from->block[b];
        if (old->kind == TM_GROUP && old->name[0] == '.') {
            if (tm_stream_find(from, "surface.group"))
                filter_leave_out(&f, "%zu names of another mesh (.group)", old->count);
            continue; /* the surface has its names */
        }
        if (old->name[0] == '.') {
            filter_leave_out(&f, "%zu rows of another mesh (%s)", old->count, old->name);
            continue;
        }
        tm_block *moved = tm_stream_add(mesh, old->name);
        if (!moved)
            return tm_fail_memory(error);
        *moved = *old;
        *old = (tm_block){.kind = TM_UNKNOWN};
    }
    mesh->history = from->history;
    from->history = (tm_text){0};
    return TM_OK;
}

int main(int argc, char **argv)
{
    tetgen_request request = {.program = "tetgen"};
    tm_text more = {0};
    filter_start(&f, argc, argv);
    read_options(&request, &more);
    tm_polygon_surface surface;
    tm_stream input, mesh;
    tm_format format = surface_input_read(&f, &surface, &input);
    tm_surface_defects defects;
    size_t dropped;
    tm_error error;
    if (tm_coordinates_check((const double(*)[3])surface.xyz, surface.nodes, surface.base,
                             &error) != TM_OK)
        mesh_input_fail(&f, &error);
    if (tm_surface_drop_duplicates(&surface, &dropped, &error) != TM_OK ||
        tm_surface_find_defects(&surface, &defects, &error) != TM_OK)
        filter_fail(&f, &error);
    if (dropped > 0)
        filter_note(&f, "faces in the place of an earlier one, which are dropped: %zu",
                    dropped);
    check_surface(&surface, &defects, format, &request);
    if (surface.regions > 0 && !strchr(more.byte ? more.byte : "", 'A'))
        filter_leave_out(&f, "%zu regions, which --switches A would keep",
                         surface.regions);
    tm_stream_init(&mesh);
    mesh.base = surface.base;
    if (tetgen_run(&f, &request, &surface, &mesh, &error) != TM_OK)
        filter_fail(&f, &error);
    if (mesh_rows(&mesh, ".ele") == 0)
        fail_empty(&surface, &defects);
    /* TetGen hands markers and regions on, but knows no names. */
    if (tm_group_to_stream(&surface.group, &mesh, ".group", &error) != TM_OK)
        filter_fail(&f, &error);
    tm_turned turned =
        tm_tetgen_orient(tm_stream_find(&mesh, ".node"), tm_stream_find(&mesh, ".ele"));
    if (turned.flat > 0)
        filter_note(&f, "%zu tetrahedra that TetGen made are flat", turned.flat);
    if (keep_parts(&input, &mesh, &error) != TM_OK)
        filter_fail(&f, &error);
    if (f.json) {
        mesh_rows_json(filter_json_begin(&f), &mesh);
        filter_json_end(&f);
    }
    filter_write(&f, &mesh, "%zu nodes, %zu tetrahedra", mesh_rows(&mesh, ".node"),
                 mesh_rows(&mesh, ".ele"));
    tm_stream_free(&mesh);
    tm_stream_free(&input);
    tm_polygon_surface_free(&surface);
    tm_text_free(&more);
    return filter_finish(&f, EXIT_SUCCESS);
}
