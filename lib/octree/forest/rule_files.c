/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rule_files.h"

#include "../../base/array.h"
#include "../../format/scan.h"

#include <stdlib.h>

tm_status tm_octree_rules_add(tm_octree_rules *rules, const tm_octree_rule *rule,
                              tm_error *error)
{
    tm_octree_rule *grown =
        tm_grow(rules->rule, &rules->room, rules->count + 1, sizeof *rules->rule);
    if (!grown)
        return tm_fail_memory(error);
    rules->rule = grown;
    rules->rule[rules->count++] = *rule;
    return TM_OK;
}

void tm_octree_rules_free(tm_octree_rules *rules)
{
    free(rules->rule);
    *rules = (tm_octree_rules){.count = 0};
}

static tm_status read_box(tm_scan *scan, tm_octree_rule *box, tm_error *error)
{
    static const char *const what[2][3] = {
        {"the smallest x", "the smallest y", "the smallest z"},
        {"the largest x", "the largest y", "the largest z"}};
    *box = (tm_octree_rule){.kind = TM_RULE_BOX};
    tm_status status = TM_OK;
    for (int i = 0; i < 3 && status == TM_OK; i++)
        status = tm_scan_next_double(scan, what[0][i], &box->low[i], error);
    for (int i = 0; i < 3 && status == TM_OK; i++) {
        status = tm_scan_next_double(scan, what[1][i], &box->high[i], error);
        if (status == TM_OK && box->high[i] < box->low[i])
            status = tm_scan_fail(scan, error, "%s is below %s", what[1][i], what[0][i]);
    }
    int64_t level = 0;
    if (status == TM_OK)
        status = tm_scan_next_integer(scan, "the level of the box", 0,
                                      TM_OCTREE_LEVEL_MAX, &level, error);
    box->level = (unsigned)level;
    return status;
}

static tm_status read_count(tm_scan *scan, int64_t *count, tm_error *error)
{
    if (!tm_scan_seek(scan) || !tm_word_is(tm_scan_word(scan), "n_regions"))
        return tm_scan_fail(scan, error,
                            "no file of boxes (it begins with 'n_regions' and how many "
                            "there are)");
    return tm_scan_next_integer(scan, "the number of boxes", 0, UINT32_MAX, count, error);
}

tm_status tm_reg_read(tm_octree_rules *rules, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '#');
    const size_t before = rules->count;
    int64_t count = 0;
    tm_status status = read_count(&scan, &count, error);
    for (int64_t i = 0; i < count && status == TM_OK; i++) {
        tm_octree_rule box;
        status = read_box(&scan, &box, error);
        if (status == TM_OK)
            status = tm_octree_rules_add(rules, &box, error);
    }
    if (status == TM_OK && tm_scan_seek(&scan))
        status =
            tm_scan_fail(&scan, error, "more than the %lld boxes that n_regions says",
                         (long long)count);
    if (status != TM_OK)
        rules->count = before;
    return status;
}

tm_status tm_ref_read(uint32_t **leaf, size_t *leaves, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '#');
    uint32_t *list = NULL;
    size_t count = 0, room = 0;
    tm_status status = TM_OK;
    while (status == TM_OK && tm_scan_seek(&scan)) {
        int64_t value = 0;
        status = tm_scan_integer(&scan, "the octant", 0, UINT32_MAX - 1, &value, error);
        if (status == TM_OK)
            status = tm_scan_no_more(&scan, "the octant", error);
        if (status != TM_OK)
            break;
        uint32_t *grown = tm_grow(list, &room, count + 1, sizeof *list);
        if (!grown)
            status = tm_fail_memory(error);
        else
            list = grown;
        if (grown)
            list[count++] = (uint32_t)value;
    }
    if (status != TM_OK) {
        free(list);
        list = NULL;
        count = 0;
    }
    *leaf = list;
    *leaves = count;
    return status;
}
