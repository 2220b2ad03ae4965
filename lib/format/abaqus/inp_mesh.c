/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_mesh.h"

#include "../../base/array.h"
#include "../../element/shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_inp_mesh_free(tm_inp_mesh *mesh)
{
    free(mesh->xyz);
    free(mesh->type);
    free(mesh->face_of);
    tm_lists_free(&mesh->of);
    tm_lists_free(&mesh->faces);
    tm_polygon_table_free(&mesh->table);
}

/* Places ---------------------------------------------------------------------------- */

/* Turns x about the axis from a to b, by Rodrigues' formula. */
static void turn(const tm_inp_instance *instance, double x[3])
{
    const double radian = 0.017453292519943295; /* π / 180 */
    const double *a = instance->axis[0], *b = instance->axis[1];
    double u[3], p[3], length = 0, along = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = b[i] - a[i];
        p[i] = x[i] - a[i];
        length += u[i] * u[i];
    }
    length = sqrt(length);
    if (length == 0)
        return;
    for (int i = 0; i < 3; i++) {
        u[i] /= length;
        along += u[i] * p[i];
    }
    const double c = cos(instance->degrees * radian), s = sin(instance->degrees * radian);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double across = u[j] * p[k] - u[k] * p[j];
        x[i] = a[i] + p[i] * c + across * s + u[i] * along * (1 - c);
    }
}

static void place_node(const tm_inp_instance *instance, double x[3])
{
    for (int i = 0; i < 3 && instance->is_moved; i++)
        x[i] += instance->move[i];
    if (instance->is_turned)
        turn(instance, x);
}

/* Numbers what stands in the instances. */
static tm_status count(tm_inp_mesh *mesh)
{
    tm_inp_model *model = mesh->model;
    tm_status status = TM_OK;
    for (size_t s = 0; s < model->scopes && status == TM_OK; s++) {
        status = tm_inp_ids_sort(&model->scope[s].nodes, model, "node");
        if (status == TM_OK)
            status = tm_inp_ids_sort(&model->scope[s].elements, model, "element");
    }
    for (size_t i = 0; i < model->instances && status == TM_OK; i++) {
        const tm_inp_scope *scope = &model->scope[model->instance[i].scope];
        model->instance[i].first_node = mesh->nodes;
        model->instance[i].first_element = mesh->elements;
        mesh->nodes += scope->nodes.count;
        mesh->elements += scope->elements.count;
        if (mesh->nodes >= INT32_MAX || mesh->elements >= INT32_MAX)
            status = tm_fail_at(model->error, TM_ERROR_INPUT, model->text.name, 0, NULL,
                                "more nodes or elements than 31 bits number");
    }
    return status;
}

static tm_status make_nodes(tm_inp_mesh *mesh)
{
    const tm_inp_model *model = mesh->model;
    mesh->xyz = tm_new(mesh->nodes, sizeof *mesh->xyz);
    if (!mesh->xyz)
        return tm_fail_memory(model->error);
    for (size_t i = 0; i < model->instances; i++) {
        const tm_inp_instance *instance = &model->instance[i];
        const tm_inp_scope *scope = &model->scope[instance->scope];
        for (size_t r = 0; r < scope->nodes.count; r++) {
            double *x = mesh->xyz[instance->first_node + r];
            memcpy(x, scope->xyz[tm_inp_row(&scope->nodes, r)], sizeof *mesh->xyz);
            place_node(instance, x);
        }
    }
    return TM_OK;
}

/* Elements -------------------------------------------------------------------------- */

/* The nodes of a row of a scope; those of an instance may be in the assembly. */
static tm_status look_up(tm_inp_mesh *mesh, const tm_inp_instance *instance, size_t row)
{
    const tm_inp_model *model = mesh->model;
    const tm_inp_scope *scope = &model->scope[instance->scope];
    const size_t begin = scope->of.start[row], k = scope->of.start[row + 1] - begin;
    uint32_t *to = tm_lists_room(&mesh->of, k);
    if (!to)
        return tm_fail_memory(model->error);
    for (size_t i = 0; i < k; i++) {
        const int32_t id = (int32_t)scope->of.item[begin + i];
        const uint32_t rank = tm_inp_ids_find(&scope->nodes, id);
        if (rank == TM_INP_NONE)
            return tm_fail_at(model->error, TM_ERROR_INPUT, model->text.name, 0, NULL,
                              "element %d: there is no node %d",
                              (int)scope->elements.id[row], (int)id);
        to[i] = (uint32_t)(instance->first_node + rank);
    }
    return tm_lists_end(&mesh->of, k) ? TM_OK : tm_fail_memory(model->error);
}

static tm_status make_elements(tm_inp_mesh *mesh)
{
    const tm_inp_model *model = mesh->model;
    tm_status status = TM_OK;
    size_t e = 0;
    mesh->type = tm_new(mesh->elements, sizeof *mesh->type);
    if (!mesh->type || !tm_lists_begin(&mesh->of))
        return tm_fail_memory(model->error);
    for (size_t i = 0; i < model->instances; i++) {
        const tm_inp_instance *instance = &model->instance[i];
        const tm_inp_scope *scope = &model->scope[instance->scope];
        for (size_t r = 0; r < scope->elements.count && status == TM_OK; r++) {
            const uint32_t row = tm_inp_row(&scope->elements, r);
            mesh->type[e++] = scope->type[row];
            status = look_up(mesh, instance, row);
        }
    }
    return status;
}

/* Faces ----------------------------------------------------------------------------- */

static tm_status add_face(tm_inp_mesh *mesh, const uint32_t *node, size_t k,
                          uint32_t *face)
{
    tm_error *error = mesh->model->error;
    const uint32_t id = (uint32_t)mesh->faces.count;
    uint32_t *to = tm_lists_room(&mesh->faces, k);
    if (!to)
        return tm_fail_memory(error);
    memcpy(to, node, k * sizeof *to);
    if (!tm_lists_end(&mesh->faces, k) ||
        !tm_polygon_table_join(&mesh->table, mesh->faces.start, mesh->faces.item, id,
                               face))
        return tm_fail_memory(error);
    if (*face != id)
        mesh->faces.count--;
    return TM_OK;
}

tm_status tm_inp_mesh_face(tm_inp_mesh *mesh, uint32_t element, int number,
                           uint32_t *face)
{
    const tm_inp_type *type = &mesh->type[element];
    const uint32_t *v = mesh->of.item + mesh->of.start[element];
    uint32_t node[4];
    *face = TM_INP_NONE;
    if (type->dimension == 2 && number == 0)
        *face = mesh->face_of[element];
    const int f = type->dimension == 3 ? tm_inp_face(type->corners, number) : -1;
    if (f < 0)
        return TM_OK;
    const uint8_t *corner = tm_element_shapes[type->corners].face[f];
    for (size_t i = 0; i < 4; i++)
        node[i] = v[corner[i]];
    return add_face(mesh, node, tm_mixed_face_nodes(corner), face);
}

static tm_status make_shells(tm_inp_mesh *mesh)
{
    tm_status status = TM_OK;
    mesh->face_of = tm_new(mesh->elements, sizeof *mesh->face_of);
    if (!mesh->face_of || !tm_lists_begin(&mesh->faces))
        return tm_fail_memory(mesh->model->error);
    for (size_t e = 0; e < mesh->elements && status == TM_OK; e++) {
        mesh->face_of[e] = TM_INP_NONE;
        if (mesh->type[e].dimension == 2)
            status = add_face(mesh, mesh->of.item + mesh->of.start[e],
                              mesh->type[e].corners, &mesh->face_of[e]);
    }
    return status;
}

tm_status tm_inp_mesh_make(tm_inp_mesh *mesh, tm_inp_model *model)
{
    *mesh = (tm_inp_mesh){.model = model};
    tm_status status = count(mesh);
    if (status == TM_OK)
        status = make_nodes(mesh);
    if (status == TM_OK)
        status = make_elements(mesh);
    if (status == TM_OK)
        status = make_shells(mesh);
    return status;
}
