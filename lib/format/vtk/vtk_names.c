/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which arrays are regions and markers. The first of a list that a file has, in capitals
 * or not, and that is what such numbers are, is taken. */
#include "vtk_cells.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/* First what vtu-export writes, then what others do: Gmsh and Medit's files by meshio,
 * ParaView and VTK's readers (CellEntityIds: vtkGmshReader, ElementBlockIds and ObjectId:
 * Exodus), Salome, Elmer (GeometryIds), GetFEM, TetGen and MFEM (attribute). */
static const char *const region_names[] = {
    "region",      "regions",         "region_id",       "regionid",    "gmsh:physical",
    "medit:ref",   "material",        "materials",       "material_id", "materialid",
    "materialids", "cellentityids",   "elementblockids", "objectid",    "geometryids",
    "cell_tags",   "domain",          "subdomain",       "zone",        "mat",
    "attribute",   "gmsh:geometrical"};
static const char *const marker_names[] = {
    "marker",        "markers",     "boundary_marker", "boundary", "boundary_id",
    "gmsh:physical", "medit:ref",   "facet_tags",      "patch",    "patchid",
    "cellentityids", "geometryids", "elementblockids", "objectid", "material",
    "materialids",   "attribute",   "gmsh:geometrical"};
static const char *const node_marker_names[] = {"marker", "markers", "medit:ref",
                                                "point_tags", "nodetags"};

typedef struct chooser {
    const tm_vtk_mesh *cells;
    const bool *keep;
    const tm_vtk_data_list *list;
    size_t count;  /* of points or cells */
    int dimension; /* of the cells that count: 3, or 2 for 0, 1 and 2; -1: of points */
} chooser;

static const char *name_of(const chooser *c, size_t array)
{
    return c->cells->names.byte + c->list->array[array].name;
}

static size_t find(const chooser *c, const char *name,
                   int (*compare)(const char *, const char *))
{
    for (size_t i = 0; i < c->list->arrays; i++)
        if (compare(name_of(c, i), name) == 0 && !c->list->array[i].lacks &&
            !c->list->array[i].measure)
            return i;
    return TM_VTK_NO_ARRAY;
}

static bool counts(const chooser *c, size_t i)
{
    if (c->dimension < 0)
        return true;
    return c->keep[i] &&
           (tm_vtk_dimension(c->cells->type[i]) == 3) == (c->dimension == 3);
}

/* Whether an array has one value for each, whole and of 32 bits. */
static bool is_numbering(const chooser *c, size_t array)
{
    const tm_vtk_data *data = &c->list->array[array];
    if (data->components != 1)
        return false;
    for (size_t i = 0; i < c->count; i++) {
        const double value = data->value[i];
        if (counts(c, i) &&
            (!(value >= INT32_MIN && value <= INT32_MAX) || value != floor(value)))
            return false;
    }
    return true;
}

/* Whether an array has one finite value for each. */
static bool is_finite(const chooser *c, size_t array)
{
    const tm_vtk_data *data = &c->list->array[array];
    if (data->components != 1)
        return false;
    for (size_t i = 0; i < c->count; i++)
        if (counts(c, i) && !isfinite(data->value[i]))
            return false;
    return true;
}

/* Markers of cells with a volume are their regions, where they have some. */
static size_t choose_markers(const chooser *c)
{
    const size_t array = find(c, "marker", strcasecmp);
    if (array == TM_VTK_NO_ARRAY || !is_numbering(c, array))
        return TM_VTK_NO_ARRAY;
    for (size_t i = 0; i < c->count; i++)
        if (counts(c, i) && c->list->array[array].value[i] != 0)
            return array;
    return TM_VTK_NO_ARRAY;
}

static bool has_any(const chooser *c)
{
    size_t i = 0;
    while (i < c->count && !counts(c, i))
        i++;
    return i < c->count;
}

/* The first of the names that numbers what counts. */
static size_t choose(const chooser *c, const char *const *name, size_t names)
{
    if (!has_any(c))
        return TM_VTK_NO_ARRAY;
    for (size_t n = 0; n < names; n++) {
        const size_t array = find(c, name[n], strcasecmp);
        if (array != TM_VTK_NO_ARRAY && is_numbering(c, array))
            return array;
    }
    return TM_VTK_NO_ARRAY;
}

/* "there is no cell data 'x' (there are: region, temperature)" */
static tm_status fail_missing(const chooser *c, const char *name, tm_error *error)
{
    tm_text there = {0};
    for (size_t i = 0; i < c->list->arrays; i++)
        tm_text_format(&there, "%s%s", i > 0 ? ", " : "", name_of(c, i));
    const tm_status status =
        tm_fail_at(error, TM_ERROR_INPUT, c->cells->name, 0, NULL,
                   "there is no cell data '%.100s' (%s%s)", name,
                   c->list->arrays > 0 ? "there are: " : "there are none",
                   there.byte ? there.byte : "");
    tm_text_free(&there);
    return status;
}

static tm_status find_named(const chooser *c, const char *name, bool whole, size_t *array,
                            tm_error *error)
{
    *array = find(c, name, strcmp);
    if (*array == TM_VTK_NO_ARRAY)
        return fail_missing(c, name, error);
    if (whole ? !is_numbering(c, *array) : !is_finite(c, *array))
        return tm_fail_at(error, TM_ERROR_INPUT, c->cells->name, 0, NULL,
                          "cell data '%.100s' are not one %s for each cell", name,
                          whole ? "whole number of 32 bits" : "finite number");
    return TM_OK;
}

#define CHOOSE(chooser, names) choose(chooser, names, sizeof(names) / sizeof *(names))

tm_status tm_vtk_find_roles(const tm_vtk_mesh *cells, const bool *keep,
                            const tm_vtk_read_options *options, tm_vtk_roles *roles,
                            tm_error *error)
{
    const chooser volumes = {cells, keep, &cells->cell_data, cells->cells, 3};
    const chooser others = {cells, keep, &cells->cell_data, cells->cells, 2};
    const chooser points = {cells, keep, &cells->point_data, cells->points, -1};
    tm_status status = TM_OK;
    /* what vtu-export wrote need not be whole */
    roles->region = find(&volumes, region_names[0], strcmp);
    if (roles->region == TM_VTK_NO_ARRAY || !is_finite(&volumes, roles->region))
        roles->region = CHOOSE(&volumes, region_names);
    if (roles->region == TM_VTK_NO_ARRAY)
        roles->region = choose_markers(&volumes);
    roles->marker = CHOOSE(&others, marker_names);
    roles->node_marker = CHOOSE(&points, node_marker_names);
    roles->tetrahedra = find(&volumes, "tetrahedra", strcmp);
    if (roles->tetrahedra != TM_VTK_NO_ARRAY && !is_finite(&volumes, roles->tetrahedra))
        roles->tetrahedra = TM_VTK_NO_ARRAY;
    if (options->region)
        status = find_named(&volumes, options->region, false, &roles->region, error);
    if (status == TM_OK && options->marker) {
        status = find_named(&others, options->marker, true, &roles->marker, error);
        const size_t array = find(&points, options->marker, strcmp);
        if (array != TM_VTK_NO_ARRAY && is_numbering(&points, array))
            roles->node_marker = array;
    }
    return status;
}

bool tm_vtk_is_internal(const char *name)
{
    return strcmp(name, "vtkGhostType") == 0 || strcmp(name, "vtkGhostLevels") == 0 ||
           strcmp(name, "vtkValidPointMask") == 0;
}

void tm_vtk_find_measures(tm_vtk_mesh *cells, const tm_vtk_read_options *options)
{
    /* names that others may use, too, are vtu-export's beside one that is its own */
    static const char *const measure[][2] = {{"dihedral_quality", "dihedral_quality"},
                                             {"jens", "jens"},
                                             {"kernel_radius", "kernel_radius"},
                                             {"level", "jens"},
                                             {"volume", "kernel_radius"}};
    tm_vtk_data_list *list = &cells->cell_data;
    for (size_t m = 0; m < sizeof measure / sizeof *measure; m++) {
        const char *name = measure[m][0];
        tm_vtk_data *data = tm_vtk_data_named(cells, list, name, false);
        const bool named = (options->region && strcmp(options->region, name) == 0) ||
                           (options->marker && strcmp(options->marker, name) == 0);
        if (data && tm_vtk_data_named(cells, list, measure[m][1], false))
            data->measure = !named;
    }
}
