/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "openfoam_zones.h"

#include "../../base/array.h"
#include "../../number/number.h"
#include "../../stream/group.h"

#include <stdlib.h>
#include <string.h>

/* A patch or a zone: its name, and what it is the value of. */
typedef struct zone {
    tm_word name;
    int32_t value;
    bool is_given;       /* its name says the value, and it has none else */
    size_t first, count; /* of a patch: faces */
} zone;

typedef struct zones {
    zone *zone;
    size_t count, room;
} zones;

typedef struct reader {
    const tm_openfoam_file *file;
    tm_openfoam_report *report;
    tm_error *error;
    tm_block *facet, *cell;
    size_t inside;
    zones faces, cells; /* patches, then zones of faces */
    size_t patches;
    uint32_t *face_zone, *cell_zone; /* [facets], [cells]; TM_NONE: of none */
    tm_block group;
} reader;

/* Names ------------------------------------------------------------------------------ */

/* Whether a name is "marker_M" with a number that is written so. */
static bool is_number(tm_word name, const char *before, int32_t *value)
{
    const size_t size = strlen(before);
    int64_t number = 0;
    char text[TM_INTEGER_CHARS];
    if (name.size <= size || memcmp(name.begin, before, size) != 0)
        return false;
    const char *digits = name.begin + size, *end = name.begin + name.size;
    if (tm_read_int64(digits, end, &number) != end || number < INT32_MIN ||
        number > INT32_MAX)
        return false;
    *value = (int32_t)number;
    const size_t written = (size_t)(tm_write_int64(text, number) - text);
    return written == name.size - size && memcmp(text, digits, written) == 0;
}

static zone *find(const zones *all, tm_word name)
{
    for (size_t i = 0; i < all->count; i++)
        if (all->zone[i].name.size == name.size &&
            memcmp(all->zone[i].name.begin, name.begin, name.size) == 0)
            return &all->zone[i];
    return NULL;
}

/* The zone of that name, a new one where it is new; NULL where memory is out. */
static zone *name_zone(zones *all, tm_word name, const char *before)
{
    zone *known = find(all, name);
    if (known)
        return known;
    zone *room = tm_grow(all->zone, &all->room, all->count + 1, sizeof *all->zone);
    if (!room)
        return NULL;
    all->zone = room;
    zone *added = &all->zone[all->count++];
    *added = (zone){.name = name};
    added->is_given = is_number(name, before, &added->value);
    return added;
}

static bool is_taken(const zones *all, int32_t value)
{
    for (size_t i = 0; i < all->count; i++)
        if (all->zone[i].is_given && all->zone[i].value == value)
            return true;
    return false;
}

/* Those that have no value yet get the least that are free; their names go to .group. */
static tm_status give_values(reader *r, zones *all, tm_group_dimension dimension)
{
    int32_t next = 0;
    tm_status status = TM_OK;
    for (size_t i = 0; i < all->count && status == TM_OK; i++) {
        zone *z = &all->zone[i];
        tm_text name = {0};
        if (z->is_given)
            continue;
        do
            next++;
        while (is_taken(all, next));
        z->value = next;
        tm_group_clean(&name, z->name.begin, z->name.size);
        if (name.failed)
            status = tm_fail_memory(r->error);
        else if (name.size > 0)
            status = tm_group_add(&r->group, dimension, z->value, name.byte, r->error);
        tm_text_free(&name);
    }
    return status;
}

/* Dictionaries ------------------------------------------------------------------------
 */

/* Takes the entry `key` of a dictionary, up to its end. */
typedef tm_status entry_reader(reader *r, tm_foam *foam, tm_word key, zone *z);

/* "name { … }" */
static tm_status read_dictionary(reader *r, tm_foam *foam, zones *all, const char *before,
                                 entry_reader *read)
{
    tm_foam_token token;
    tm_status status = tm_foam_next(foam, &token, r->error);
    if (status == TM_OK && token.word.size == 0)
        status = tm_scan_fail(&foam->scan, r->error, "a name is missing");
    if (status == TM_OK)
        status = tm_foam_expect(foam, '{', r->error);
    if (status != TM_OK)
        return status;
    zone *z = name_zone(all, token.word, before);
    if (!z)
        return tm_fail_memory(r->error);
    while (status == TM_OK && !tm_foam_is(foam, '}')) {
        status = tm_foam_next(foam, &token, r->error);
        if (status == TM_OK && token.word.size == 0)
            status =
                tm_scan_fail(&foam->scan, r->error, "the file ends where '}' should be");
        if (status == TM_OK)
            status = read(r, foam, token.word, z);
    }
    return status;
}

/* The beginning of a list, N. */
static tm_status begin_list(tm_foam *foam, const tm_openfoam_file *file, size_t *count,
                            tm_error *error)
{
    const tm_status status = tm_openfoam_begin(foam, file, error);
    *count = 0;
    return status == TM_OK
               ? tm_foam_count(foam, "the size of the list", UINT32_MAX - 1, count, error)
               : status;
}

tm_status tm_openfoam_count_zones(const tm_openfoam_file *file, size_t *count,
                                  tm_error *error)
{
    tm_foam foam;
    return begin_list(&foam, file, count, error);
}

/* N(name {…} …), or nothing at all. */
static tm_status read_all(reader *r, tm_openfoam_kind kind, zones *all,
                          const char *before, entry_reader *read)
{
    tm_foam foam;
    size_t count;
    tm_status status = begin_list(&foam, &r->file[kind], &count, r->error);
    const bool opens = status == TM_OK && tm_foam_is(&foam, '(');
    if (status == TM_OK && !opens && count > 0)
        status = tm_foam_expect(&foam, '(', r->error);
    for (size_t i = 0; i < count && status == TM_OK; i++)
        status = read_dictionary(r, &foam, all, before, read);
    if (opens && status == TM_OK)
        status = tm_foam_expect(&foam, ')', r->error);
    return status == TM_OK ? tm_foam_end(&foam, r->error) : status;
}

/* Patches -----------------------------------------------------------------------------
 */

/* "wall, empty": each once. */
static void note_type(reader *r, tm_word type)
{
    tm_text *names = &r->report->type_names;
    r->report->types++;
    for (const char *at = names->byte; at;
         at = strchr(at, ',') ? strchr(at, ',') + 2 : NULL)
        if (strcspn(at, ",") == type.size && memcmp(at, type.begin, type.size) == 0)
            return;
    if (names->size > 0)
        tm_text_string(names, ", ");
    tm_text_append(names, type.begin, type.size);
}

static tm_status read_patch_entry(reader *r, tm_foam *foam, tm_word key, zone *z)
{
    const size_t faces = r->facet->count;
    tm_status status;
    tm_foam_token type;
    if (tm_word_is(key, "nFaces"))
        status = tm_foam_count(foam, "nFaces", faces, &z->count, r->error);
    else if (tm_word_is(key, "startFace"))
        status = tm_foam_count(foam, "startFace", faces, &z->first, r->error);
    else if (tm_word_is(key, "type")) {
        status = tm_foam_next(foam, &type, r->error);
        if (status == TM_OK && !tm_word_is(type.word, "patch"))
            note_type(r, type.word);
    } else
        return tm_foam_skip_value(foam, r->error);
    return status == TM_OK ? tm_foam_expect(foam, ';', r->error) : status;
}

/* They are the boundary, one after another. */
static tm_status check_patches(const reader *r)
{
    size_t next = r->inside;
    for (size_t p = 0; p < r->patches; p++) {
        const zone *z = &r->faces.zone[p];
        if (z->count > 0 && z->first != next)
            return tm_fail_at(r->error, TM_ERROR_INPUT, r->file[TM_FOAM_BOUNDARY].path, 0,
                              NULL,
                              "patch '%.*s' begins at face %zu (%zu would be right)",
                              tm_word_shown(z->name), z->name.begin, z->first, next);
        next += z->count;
    }
    if (next == r->facet->count)
        return TM_OK;
    return tm_fail_at(r->error, TM_ERROR_INPUT, r->file[TM_FOAM_BOUNDARY].path, 0, NULL,
                      "the patches end at face %zu (%zu would be right)", next,
                      r->facet->count);
}

/* Zones -------------------------------------------------------------------------------
 */

/* Gives labels that are in no zone yet to zone z; counts the others. */
static tm_status take_labels(reader *r, tm_foam *foam, const zone *z, const zones *all,
                             uint32_t *zone_of, size_t limit, size_t *taken)
{
    tm_numbers labels = {0};
    tm_status status = tm_foam_labels(foam, "labels of a zone", limit, &labels, r->error);
    for (size_t i = 0; i < labels.count && status == TM_OK; i++) {
        int64_t label = 0;
        if (!tm_numbers_whole(&labels, i, 0, (int64_t)limit - 1, &label))
            status = tm_scan_fail(&foam->scan, r->error,
                                  "zone '%.*s': label %.17g is out of range (below %zu)",
                                  tm_word_shown(z->name), z->name.begin,
                                  tm_numbers_real(&labels, i), limit);
        else if (zone_of[label] == TM_NONE)
            zone_of[label] = (uint32_t)(z - all->zone);
        else
            ++*taken;
    }
    tm_numbers_free(&labels);
    return status;
}

/* "List<label>" may stand before a list. */
static tm_status skip_kind(tm_foam *foam, tm_error *error)
{
    static const char list[] = "List<";
    tm_foam ahead = *foam;
    tm_foam_token kind;
    const tm_status status = tm_foam_next(&ahead, &kind, error);
    if (status == TM_OK && kind.word.size > sizeof list &&
        memcmp(kind.word.begin, list, sizeof list - 1) == 0)
        *foam = ahead;
    return status;
}

static tm_status read_cell_entry(reader *r, tm_foam *foam, tm_word key, zone *z)
{
    if (!tm_word_is(key, "cellLabels"))
        return tm_foam_skip_value(foam, r->error);
    tm_status status = skip_kind(foam, r->error);
    if (status == TM_OK)
        status = take_labels(r, foam, z, &r->cells, r->cell_zone, r->cell->count,
                             &r->report->cells_of_two);
    return status == TM_OK ? tm_foam_expect(foam, ';', r->error) : status;
}

static tm_status count_flips(reader *r, tm_foam *foam)
{
    tm_numbers bits = {0};
    const tm_status status =
        tm_foam_bits(foam, "bits of a flipMap", r->facet->count, &bits, r->error);
    for (size_t i = 0; i < bits.count && status == TM_OK; i++)
        r->report->flipped += tm_numbers_real(&bits, i) != 0;
    tm_numbers_free(&bits);
    return status;
}

static tm_status read_face_entry(reader *r, tm_foam *foam, tm_word key, zone *z)
{
    const bool labels = tm_word_is(key, "faceLabels");
    if (!labels && !tm_word_is(key, "flipMap"))
        return tm_foam_skip_value(foam, r->error);
    tm_status status = skip_kind(foam, r->error);
    if (status == TM_OK && labels)
        status = take_labels(r, foam, z, &r->faces, r->face_zone, r->facet->count,
                             &r->report->faces_of_two);
    else if (status == TM_OK)
        status = count_flips(r, foam);
    return status == TM_OK ? tm_foam_expect(foam, ';', r->error) : status;
}

/* Values ------------------------------------------------------------------------------
 */

static tm_status set_markers(reader *r)
{
    tm_block *facet = r->facet;
    bool any = false;
    for (size_t z = 0; z < r->faces.count; z++)
        any |= r->faces.zone[z].value != 0;
    if (!any)
        return TM_OK;
    facet->marker = calloc(facet->count + 1, sizeof *facet->marker);
    if (!facet->marker)
        return tm_fail_memory(r->error);
    facet->markers = true;
    for (size_t f = 0; f < facet->count; f++)
        if (r->face_zone[f] != TM_NONE)
            facet->marker[f] = r->faces.zone[r->face_zone[f]].value;
    return TM_OK;
}

static tm_status set_regions(reader *r)
{
    enum { ATTRIBUTES = 2, REGION = 1 };
    tm_block *cell = r->cell;
    if (r->cells.count == 0)
        return TM_OK;
    cell->attribute = calloc(ATTRIBUTES * cell->count + 1, sizeof *cell->attribute);
    if (!cell->attribute)
        return tm_fail_memory(r->error);
    cell->attributes = ATTRIBUTES;
    for (size_t c = 0; c < cell->count; c++)
        if (r->cell_zone[c] != TM_NONE)
            cell->attribute[ATTRIBUTES * c + REGION] =
                r->cells.zone[r->cell_zone[c]].value;
    return TM_OK;
}

static tm_status read_patches(reader *r)
{
    tm_status status =
        read_all(r, TM_FOAM_BOUNDARY, &r->faces, "marker_", read_patch_entry);
    r->patches = r->faces.count;
    if (status == TM_OK)
        status = check_patches(r);
    for (size_t p = 0; p < r->patches && status == TM_OK; p++) {
        const zone *z = &r->faces.zone[p];
        for (size_t f = z->first; f < z->first + z->count; f++)
            r->face_zone[f] = (uint32_t)p;
    }
    return status;
}

static tm_status read_and_set(reader *r)
{
    const tm_openfoam_file *file = r->file;
    r->face_zone = tm_new(r->facet->count, sizeof *r->face_zone);
    r->cell_zone = tm_new(r->cell->count, sizeof *r->cell_zone);
    if (!r->face_zone || !r->cell_zone)
        return tm_fail_memory(r->error);
    memset(r->face_zone, UINT8_MAX, r->facet->count * sizeof *r->face_zone);
    memset(r->cell_zone, UINT8_MAX, r->cell->count * sizeof *r->cell_zone);
    tm_status status = read_patches(r);
    if (status == TM_OK && file[TM_FOAM_FACE_ZONES].path)
        status = read_all(r, TM_FOAM_FACE_ZONES, &r->faces, "marker_", read_face_entry);
    if (status == TM_OK && file[TM_FOAM_CELL_ZONES].path)
        status = read_all(r, TM_FOAM_CELL_ZONES, &r->cells, "region_", read_cell_entry);
    if (status == TM_OK)
        status = give_values(r, &r->faces, TM_GROUP_FACES);
    if (status == TM_OK)
        status = give_values(r, &r->cells, TM_GROUP_REGIONS);
    if (status == TM_OK)
        status = set_markers(r);
    if (status == TM_OK)
        status = set_regions(r);
    if (status == TM_OK)
        status = tm_group_check(&r->group, 0, file[TM_FOAM_BOUNDARY].path, r->error);
    return status;
}

tm_status tm_openfoam_read_zones(tm_stream *stream,
                                 const tm_openfoam_file file[TM_OPENFOAM_FILES],
                                 size_t inside, tm_openfoam_report *report,
                                 tm_error *error)
{
    reader r = {.file = file,
                .report = report,
                .error = error,
                .facet = tm_stream_find(stream, ".facet"),
                .cell = tm_stream_find(stream, ".cell"),
                .inside = inside};
    tm_group_init(&r.group, ".group");
    tm_status status = read_and_set(&r);
    if (status == TM_OK && report->type_names.failed)
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_group_to_stream(&r.group, stream, ".group", error);
    tm_group_free(&r.group);
    free(r.face_zone);
    free(r.cell_zone);
    free(r.faces.zone);
    free(r.cells.zone);
    return status;
}
