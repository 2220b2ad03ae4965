/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_rules.h"

#include "surface_input.h"

#include <stdlib.h>

static void add(const filter *f, octree_rules *rules, const tm_octree_rule *rule)
{
    tm_error error;
    if (tm_octree_rules_add(&rules->rules, rule, &error) != TM_OK)
        filter_fail(f, &error);
}

void octree_rules_add_level(const filter *f, octree_rules *rules,
                            tm_octree_rule_kind kind, unsigned level)
{
    add(f, rules, &(tm_octree_rule){.kind = kind, .level = level});
}

static unsigned level_of(const filter *f, const char *option, const char *text)
{
    return (unsigned)filter_integer(f, option, text, 0, TM_OCTREE_LEVEL_MAX);
}

/* One item more at the end of an array of `count`. */
static void *append(const filter *f, void *array, size_t count, size_t size)
{
    void *more = realloc(array, (count + 1) * size);
    if (!more)
        filter_fail_memory(f);
    return more;
}

static void add_boxes(const filter *f, octree_rules *rules, const char *file)
{
    tm_error error;
    tm_text bytes = {0};
    filter_read_file(f, file, &bytes);
    if (tm_reg_read(&rules->rules, bytes.byte, bytes.size, file, &error) != TM_OK)
        filter_fail_file(f, &error, &bytes, "octree-mesh -");
    tm_text_free(&bytes);
}

static void add_leaves(const filter *f, octree_rules *rules, const char *file)
{
    tm_error error;
    tm_text bytes = {0};
    filter_read_file(f, file, &bytes);
    tm_octree_rule rule = {.kind = TM_RULE_LEAVES};
    uint32_t *leaf;
    if (tm_ref_read(&leaf, &rule.leaves, bytes.byte, bytes.size, file, &error) != TM_OK)
        filter_fail_file(f, &error, &bytes, "octree-mesh -");
    tm_text_free(&bytes);
    rules->leaf_list =
        append(f, rules->leaf_list, rules->leaf_lists, sizeof *rules->leaf_list);
    rules->leaf_list[rules->leaf_lists++] = leaf;
    rule.leaf = leaf;
    add(f, rules, &rule);
}

static void add_region(const filter *f, octree_rules *rules, const char *file,
                       unsigned level)
{
    filter named = *f;
    named.input = file;
    /* Rules point to regions, which therefore stay where they are: there is room for one
     * for each word of the command. */
    if (!rules->region)
        rules->region = append(f, NULL, (size_t)f->argc, sizeof *rules->region);
    tm_surface *surface = &rules->region[rules->regions++];
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE};
    surface_input_build(&named, &options, surface, NULL);
    add(f, rules,
        &(tm_octree_rule){.kind = TM_RULE_REGION, .level = level, .region = surface});
}

void octree_rules_option(filter *f, octree_rules *rules, int c)
{
    const char *file = optarg;
    switch (c) {
    case 'a':
        octree_rules_add_level(f, rules, TM_RULE_EVERYTHING, level_of(f, "-a", optarg));
        break;
    case 's':
        octree_rules_add_level(f, rules, TM_RULE_SURFACE, level_of(f, "-s", optarg));
        break;
    case 'b':
        add_boxes(f, rules, file);
        break;
    case 'l':
        add_leaves(f, rules, file);
        break;
    case 'r':
        if (optind >= f->argc)
            filter_usage_error(f, "-r %s lacks its level: -r SURFACE L", file);
        tm_text_format(&f->command, " %s", f->argv[optind]);
        add_region(f, rules, file, level_of(f, "-r", f->argv[optind++]));
        break;
    }
}

void octree_rules_free(octree_rules *rules)
{
    for (size_t i = 0; i < rules->regions; i++)
        tm_surface_free(&rules->region[i]);
    for (size_t i = 0; i < rules->leaf_lists; i++)
        free(rules->leaf_list[i]);
    free(rules->region);
    free(rules->leaf_list);
    tm_octree_rules_free(&rules->rules);
}
