/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "improve.h"

#define NAME(op, name, key, effect, phase, function) name,
const char *const tm_improve_op_name[TM_IMPROVE_OPS] = {TM_IMPROVE_TABLE(NAME)};

#define KEY(op, name, key, effect, phase, function) key,
static const char *const done_key[TM_IMPROVE_OPS] = {TM_IMPROVE_TABLE(KEY)};

#define EFFECT(op, name, key, effect, phase, function) TM_EFFECT_##effect,
static const tm_improve_effect effect_of[TM_IMPROVE_OPS] = {TM_IMPROVE_TABLE(EFFECT)};

void tm_improve_report_json(tm_json *json, const tm_improve_report *r)
{
    tm_json_integer(json, "passes", (int64_t)r->passes);
    tm_json_integer(json, "kicks", (int64_t)r->kicks);
    tm_json_open(json, "operations", '{');
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        tm_json_integer(json, done_key[op], (int64_t)r->done.op[op]);
    tm_json_integer(json, "edge_splits", (int64_t)r->done.edge_splits);
    tm_json_integer(json, "swallowed_nodes", (int64_t)r->done.swallowed);
    tm_json_close(json, '}');
    tm_json_open(json, "tried", '{');
    for (int op = TM_OP_SMOOTHING; op < TM_IMPROVE_OPS; op++)
        tm_json_integer(json, done_key[op], (int64_t)r->tried[op]);
    tm_json_close(json, '}');
    tm_json_open(json, "nodes", '{');
    tm_json_integer(json, "fixed", (int64_t)r->nodes_free[0]);
    tm_json_integer(json, "on_straight_edges", (int64_t)r->nodes_free[1]);
    tm_json_integer(json, "in_flat_facets", (int64_t)r->nodes_free[2]);
    tm_json_integer(json, "inside", (int64_t)r->nodes_free[3]);
    tm_json_close(json, '}');
    if (r->tolerance == 0)
        return;
    tm_json_open(json, "surface", '{');
    tm_json_double(json, "tolerance", r->tolerance);
    tm_json_integer(json, "patches", (int64_t)r->patches);
    tm_json_integer(json, "curves", (int64_t)r->curves);
    tm_json_integer(json, "corners", (int64_t)r->corners);
    tm_json_close(json, '}');
}

size_t tm_improve_operations(const tm_improve_report *report)
{
    size_t sum = 0;
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        sum += report->done.op[op];
    return sum;
}

size_t tm_improve_effects(const tm_improve_report *report, tm_improve_effect effect)
{
    size_t sum = effect == TM_EFFECT_NODES_REMOVED ? report->done.swallowed : 0;
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        sum += effect_of[op] == effect ? report->done.op[op] : 0;
    return sum;
}
