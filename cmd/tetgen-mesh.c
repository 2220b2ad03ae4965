/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tetgen-mesh: tetrahedra of a surface or of points, made by TetGen. */
#include "common/input/mesh_input.h"
#include "common/input/surface_input.h"
#include "common/tetgen/tetgen.h"
#include "common/tetgen/tetgen_attributes.h"
#include "common/tetgen/tetgen_markers.h"
#include "common/tetgen/tetgen_parts.h"
#include "common/tetgen/tetgen_regions.h"
#include "common/tetgen/tetgen_switches.h"

#include "../lib/base/array.h"
#include "../lib/number/number.h"
#include "../lib/stream/coordinates.h"
#include "../lib/surface/surface_defects.h"
#include "../lib/format/tetgen.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum {
    OPTION_SWITCHES = FILTER_OWN,
    OPTION_TETGEN,
    OPTION_SIZE,
    OPTION_REGIONS,
    OPTION_CAVITIES,
    OPTION_HOLE,
    OPTION_REGION,
    OPTION_TIMEOUT
};

static const struct option options[] = {
    {"quality", optional_argument, NULL, 'q'},
    {"max-volume", required_argument, NULL, 'a'},
    {"keep-surface", no_argument, NULL, 'Y'},
    {"metric", required_argument, NULL, 'm'},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"refine", no_argument, NULL, 'r'},
    {"regions", no_argument, NULL, OPTION_REGIONS},
    {"cavities", no_argument, NULL, OPTION_CAVITIES},
    {"hole", required_argument, NULL, OPTION_HOLE},
    {"region", required_argument, NULL, OPTION_REGION},
    {"timeout", required_argument, NULL, OPTION_TIMEOUT},
    {"switches", required_argument, NULL, OPTION_SWITCHES},
    {"tetgen", required_argument, NULL, OPTION_TETGEN},
    FILTER_OPTIONS,
};

static filter f = {
    .name = "tetgen-mesh",
    .synopsis = "[-q[RATIO]] [-a VOLUME] [-m N | --size H] [-Yr] [--regions] "
                "[--cavities] [--hole X,Y,Z] [--region X,Y,Z[,A]] [--timeout S] "
                "[--switches S] [--tetgen PROG] [FILE]",
    .purpose = "Fill a surface with tetrahedra, join points to tetrahedra, or refine\n"
               "tetrahedra, by TetGen.",
    .help =
        "  -q, --quality[=RATIO]     bound the radius-edge ratio (TetGen's own "
        "bound: 2)\n"
        "  -a, --max-volume VOLUME   bound the volume of each tetrahedron\n"
        "  -m, --metric N            edges as long as attribute N of the nodes says\n"
        "      --size H              edges of length H\n"
        "  -Y, --keep-surface        put no new nodes on the surface\n"
        "  -r, --refine              refine the tetrahedra of a stream, also where it\n"
        "                            has a surface\n"
        "      --regions             number what each closed shell is around\n"
        "      --cavities            leave empty what a shell that looks inward is "
        "around\n"
        "      --hole X,Y,Z          leave empty what this point is in\n"
        "      --region X,Y,Z[,A]    number what this point is in\n"
        "      --timeout S           end TetGen after S seconds\n"
        "      --switches S          more switches for TetGen\n"
        "      --tetgen PROG         the program to run\n",
    .options = options,
    .letters = "q::a:m:rY" FILTER_LETTERS,
    .q_is_own = true,
};

/* Options -------------------------------------------------------------------------- */

/* Numbers with commas between them, `least` or more of them; returns how many. */
static size_t read_numbers(const char *option, const char *text, size_t least,
                           size_t most, double *value)
{
    size_t count = 0;
    const char *at = text;
    bool more = true;
    while (more && count < most) {
        const char *end = strchrnul(at, ',');
        if (tm_read_double(at, end, &value[count]) != end)
            break;
        count++;
        more = *end == ',';
        at = end + more;
    }
    if (more || count < least)
        filter_usage_error(&f, "%s: '%s' (%s would be right)", option, text,
                           most > 3 ? "X,Y,Z or X,Y,Z,A" : "X,Y,Z");
    return count;
}

static void succeed(tm_status status, const tm_error *error)
{
    if (status != TM_OK)
        filter_fail(&f, error);
}

static void add_hole(tetgen_parts *parts, const char *text)
{
    tm_error error;
    double xyz[3] = {0};
    read_numbers("--hole", text, 3, 3, xyz);
    succeed(tm_polygon_surface_add_hole(&parts->given, xyz, &error), &error);
}

static void add_region(tetgen_parts *parts, const char *text)
{
    tm_error error;
    double value[4] = {0, 0, 0, NAN};
    read_numbers("--region", text, 3, 4, value);
    if (!isnan(value[3]) && value[3] != floor(value[3]))
        filter_usage_error(&f, "--region: %g is not whole, as TetGen's regions are",
                           value[3]);
    if (fabs(value[3]) > INT32_MAX)
        filter_usage_error(&f, "--region: %.17g is too large a number for TetGen",
                           value[3]);
    tm_region region = {.attribute = value[3], .max_volume = -1};
    memcpy(region.point, value, sizeof region.point);
    succeed(tm_polygon_surface_add_region(&parts->given, &region, &error), &error);
}

/* What of the run is not TetGen's. */
typedef struct settings {
    tetgen_request request;
    tetgen_parts parts;
    tm_text more;
    long metric; /* the attribute with the lengths of edges, from 1; 0: none */
    double size; /* that everywhere; 0: none */
    bool refine;
} settings;

static void take_option(settings *s, int c)
{
    static const double ratio_min = 1, ratio_max = 1000;
    tetgen_request *r = &s->request;
    switch (c) {
    case 'q':
        strcpy(r->quality, "-q");
        if (optarg)
            tetgen_ratio_switch(r->quality,
                                filter_number(&f, "-q", optarg, ratio_min, ratio_max));
        break;
    case 'a':
        tetgen_volume_switch(r->volume,
                             filter_number(&f, "-a", optarg, DBL_MIN, DBL_MAX));
        break;
    case 'm':
        s->metric = filter_integer(&f, "-m", optarg, 1, INT32_MAX);
        break;
    case OPTION_SIZE:
        s->size = filter_number(&f, "--size", optarg, DBL_MIN, DBL_MAX);
        break;
    case 'r':
        s->refine = true;
        break;
    case 'Y':
        r->keep_surface = true;
        break;
    case OPTION_REGIONS:
        s->parts.regions = true;
        break;
    case OPTION_CAVITIES:
        s->parts.cavities = true;
        break;
    case OPTION_HOLE:
        add_hole(&s->parts, optarg);
        break;
    case OPTION_REGION:
        add_region(&s->parts, optarg);
        break;
    case OPTION_TIMEOUT:
        r->timeout = filter_number(&f, "--timeout", optarg, 0, DBL_MAX);
        break;
    case OPTION_SWITCHES:
        tetgen_take_switches(&f, r, &s->more, optarg);
        break;
    case OPTION_TETGEN:
        r->program = optarg;
        break;
    default:
        filter_usage_error(&f, "option -%c is unknown", c);
    }
}

static void read_options(settings *s)
{
    int c;
    while ((c = filter_option(&f)) != -1)
        take_option(s, c);
    filter_operands(&f);
    tetgen_request *r = &s->request;
    if (s->metric && s->size > 0)
        filter_usage_error(&f, "-m and --size: one of them");
    if ((s->metric || s->size > 0) && !*r->quality)
        strcpy(r->quality, "-q"); /* long edges are halved where shapes are looked at */
    r->regions = (s->parts.regions || s->parts.given.regions > 0) &&
                 !strchr(r->more ? r->more : "", 'A');
}

static bool asks_for_parts(const settings *s)
{
    const tetgen_parts *p = &s->parts;
    return p->regions || p->cavities || p->given.holes + p->given.regions > 0;
}

static bool asks_for_nodes(const settings *s)
{
    const tetgen_request *r = &s->request;
    return *r->quality || *r->volume || r->keep_surface;
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
        const double *xyz = surface->xyz[defects->open_edge[0][i]];
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
                          const settings *s)
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
        if (asks_for_nodes(s) || asks_for_parts(s))
            filter_usage_error(&f, "-q, -a, -m, -Y and what is about regions need a "
                                   "surface, but the input has points alone");
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
        filter_note(&f, "the surface is not closed: %s (surface-mend may close it)",
                    text.byte);
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

static bool is_refined(const tm_block *block)
{
    static const char *const names[] = {".node", ".ele", ".face", ".edge"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(block->name, names[i]) == 0)
            return true;
    return false;
}

/* Moves the blocks of parts (the surface that came in), of refined tetrahedra the names,
 * and the history behind the new mesh; other blocks belong to a mesh that is no longer
 * there. */
static tm_status keep_parts(tm_stream *from, bool refined, tm_stream *mesh,
                            tm_error *error)
{
    for (size_t b = 0; b < from->blocks; b++) {
        tm_block *old = &from->block[b];
        const bool names = old->kind == TM_GROUP && old->name[0] == '.';
        if (refined && is_refined(old))
            continue;
        if (names && !refined) {
            if (tm_stream_find(from, "surface.group"))
                filter_leave_out(&f, "%zu names of another mesh (.group)", old->count);
            continue; /* the surface has its names */
        }
        if (old->name[0] == '.' && !names) {
            if (old->kind == TM_UNKNOWN)
                filter_leave_out(&f, "the block %s", old->name);
            else if (!surface_input_takes(from, old))
                filter_leave_out(&f, "%zu rows of another mesh (%s)", old->count,
                                 old->name);
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

/* The two ways ---------------------------------------------------------------------- */

/* The lengths of edges, by node; NULL where none are asked for. TetGen takes a length for
 * what edges are not to be much above: so the mean edge is as long as was asked for. */
static double *find_sizes(const settings *s, size_t nodes, size_t attributes,
                          const double *attribute, unsigned base)
{
    static const double share = 0.85;
    if (!s->metric && !(s->size > 0))
        return NULL;
    const size_t column = (size_t)s->metric - 1;
    if (s->metric && column >= attributes)
        filter_usage_error(&f, "-m %ld: the input's nodes have %zu attributes", s->metric,
                           attributes);
    double *size = tm_new(nodes, sizeof *size);
    if (!size)
        filter_fail_memory(&f);
    for (size_t v = 0; v < nodes; v++) {
        const double length = s->metric ? attribute[v * attributes + column] : s->size;
        if (length < 0)
            fail_input("node %zu: the length of edges, attribute %ld, is %g (0 or more "
                       "would be right)",
                       v + base, s->metric, length);
        size[v] = share * length;
    }
    return size;
}

/* TetGen failed: where the surface is such that it cannot fill it, that is why. */
_Noreturn static void fail_to_fill(const tm_error *error, const tm_error *why)
{
    if (error->status == TM_ERROR_SYSTEM && why->status == TM_ERROR_INPUT) {
        filter_message(&f, "%s", error->what);
        fail_input("%s: TetGen cannot fill it (surface-mend may mend it, octree-mesh "
                   "--lenient fills it as it is)",
                   why->what);
    }
    filter_fail(&f, error);
}

static void fill_surface(settings *s, tm_polygon_surface *surface, tm_format format,
                         tm_stream *mesh)
{
    tm_surface_defects defects;
    size_t dropped, mended, cut;
    tm_error error, why = {.status = TM_OK};
    if (tm_coordinates_check((const double(*)[3])surface->xyz, surface->nodes,
                             surface->base, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    if (tm_surface_drop_degenerate(surface, &mended, &error) != TM_OK ||
        tm_surface_drop_duplicates(surface, &dropped, &error) != TM_OK ||
        tm_surface_cut_slit(surface, &cut, &error) != TM_OK ||
        tm_surface_find_defects(surface, &defects, &error) != TM_OK)
        filter_fail(&f, &error);
    if (mended > 0)
        filter_note(&f,
                    "faces with two corners in the same place: %zu, which lose one, or "
                    "are dropped",
                    mended);
    if (dropped > 0)
        filter_note(&f, "faces in the place of an earlier one, which are dropped: %zu",
                    dropped);
    if (cut > 0)
        filter_note(&f,
                    "faces that have a corner twice, slit open, which are cut into "
                    "triangles: %zu",
                    cut);
    check_surface(surface, &defects, format, s);
    if (surface->facets > 0)
        tetgen_find_parts(&f, &s->parts, surface, &why);
    if (surface->regions > 0 && !s->request.regions &&
        !strchr(s->more.byte ? s->more.byte : "", 'A'))
        filter_leave_out(&f, "%zu regions, which --regions would keep", surface->regions);
    double *size = find_sizes(s, surface->nodes, surface->attributes, surface->attribute,
                              surface->base);
    s->request.size = size;
    mesh->base = surface->base;
    if (tetgen_run(&f, &s->request, surface, mesh, &error) != TM_OK)
        fail_to_fill(&error, &why);
    if (mesh_rows(mesh, ".ele") == 0)
        fail_empty(surface, &defects);
    tetgen_interpolate(&f, &s->request, surface, mesh);
    free(size);
    /* TetGen hands markers and regions on, but knows no names. */
    if (tm_group_to_stream(&surface->group, mesh, ".group", &error) != TM_OK)
        filter_fail(&f, &error);
}

static void refine_tets(settings *s, tm_stream *input, tm_stream *mesh)
{
    tm_error error;
    const tm_block *node = tm_stream_find(input, ".node");
    if (asks_for_parts(s))
        filter_usage_error(&f, "what is about regions and holes needs a surface, but "
                               "these are tetrahedra, which keep their regions");
    if (!asks_for_nodes(s) && !s->request.more)
        fail_input("holds tetrahedra (.ele), but tetgen-mesh takes them to refine only: "
                   "-q, -a, -m or --size would say how");
    if (tm_stream_check_coordinates(input, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    double *size =
        find_sizes(s, node->count, node->attributes, node->attribute, input->base);
    s->request.size = size;
    mesh->base = input->base;
    tetgen_aliases aliases;
    tetgen_hide_markers(&f, input, &aliases);
    tetgen_regions regions;
    tetgen_hide_regions(&f, input, &regions);
    if (tetgen_refine(&f, &s->request, input, mesh, &error) != TM_OK)
        filter_fail(&f, &error);
    tetgen_restore_markers(mesh, &aliases);
    tetgen_restore_regions(mesh, &regions);
    tetgen_interpolate_refined(&f, input, mesh);
    free(size);
}

int main(int argc, char **argv)
{
    settings s = {.request = {.program = "tetgen"}};
    tm_polygon_surface surface;
    tm_stream input, mesh;
    tm_error error;
    filter_start(&f, argc, argv);
    tm_polygon_surface_init(&s.parts.given);
    read_options(&s);
    const tm_format format = surface_input_read(&f, &surface, &input);
    /* Nodes alone beside an empty .ele are no surface. */
    const bool refines =
        s.refine ||
        (tm_stream_find(&input, ".ele") && !tm_stream_find(&input, ".node")) ||
        (surface.nodes == 0 && tm_stream_find(&input, ".ele"));
    if (refines && mesh_rows(&input, ".ele") == 0)
        fail_input("has no elements to refine (tetrahedra would be right)");
    tm_stream_init(&mesh);
    if (refines)
        refine_tets(&s, &input, &mesh);
    else
        fill_surface(&s, &surface, format, &mesh);
    tm_turned turned =
        tm_tetgen_orient(tm_stream_find(&mesh, ".node"), tm_stream_find(&mesh, ".ele"));
    if (turned.flat > 0)
        filter_note(&f, "%zu tetrahedra that TetGen made are flat", turned.flat);
    if (keep_parts(&input, refines, &mesh, &error) != TM_OK)
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
    tm_text_free(&s.more);
    tm_polygon_surface_free(&s.parts.given);
    return filter_finish(&f, EXIT_SUCCESS);
}
