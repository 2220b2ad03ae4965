/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What elements are coloured by. A field has key, label, unit, of ("element", "node",
 * "facet" or "nothing"), values, least, most; a category has a list of the values that
 * there are, each with value, name, colour, count. */

/* Colour maps by some of their points; all are told apart by the colour-blind. */
const MAPS = {
    viridis: [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]],
    cividis: [[0, 34, 78], [65, 77, 107], [124, 123, 120], [188, 175, 111], [254, 232, 56]],
    'orange to blue': [[179, 63, 0], [240, 140, 60], [240, 232, 218], [110, 166, 214],
                       [13, 76, 146]],
};
const PALETTE = [[86, 180, 233], [230, 159, 0], [0, 158, 115], [204, 121, 167],
                 [240, 228, 66], [0, 114, 178], [213, 94, 0], [170, 170, 170]];
const OUTSIDE = [203, 209, 217], INSIDE = [242, 201, 110], UNMARKED = [190, 190, 190];
const SHADES = 256;

function mapColour(map, t) {
    const points = MAPS[map], at = Math.min(Math.max(t, 0), 1) * (points.length - 1);
    const i = Math.min(Math.floor(at), points.length - 2), part = at - i;
    return points[i].map((c, a) => Math.round(c + part * (points[i + 1][a] - c)));
}

function tableOf(map) {
    const table = new Uint8Array(3 * SHADES);
    for (let i = 0; i < SHADES; i++)
        table.set(mapColour(map, i / (SHADES - 1)), 3 * i);
    return table;
}

function paletteColour(i) {
    const round = Math.floor(i / PALETTE.length), scale = [1, 0.72, 0.5][round % 3];
    return PALETTE[i % PALETTE.length].map(c => Math.round(c * scale));
}

/* The mean of a field of nodes at each element. */
function meansOf(mesh, values) {
    if (mesh.content === 'points')
        return values;
    const means = new Float32Array(mesh.elements), count = new Uint32Array(mesh.elements);
    if (mesh.item) {
        for (let e = 0; e < mesh.elements; e++) {
            for (let i = mesh.start[e]; i < mesh.start[e + 1]; i++)
                means[e] += values[mesh.item[i]];
            means[e] /= mesh.start[e + 1] - mesh.start[e] || 1;
        }
        return means;
    }
    for (let i = 0; i < mesh.side.length; i++) {
        const e = mesh.side[i], f = i >> 1;
        for (let j = mesh.facetStart[f]; e < LEFT_OUT && j < mesh.facetStart[f + 1]; j++) {
            means[e] += values[mesh.facetItem[j]];
            count[e]++;
        }
    }
    return means.map((sum, e) => sum / (count[e] || 1));
}

/* Fields that are not in the page, as they follow from the elements. */
function addOwnFields(mesh) {
    const own = [];
    if (mesh.content === 'mixed')
        own.push({key: 'kind', label: 'kind', of: 'element', kinds: true,
                  values: Float32Array.from(
                      {length: mesh.elements}, (_, e) => mesh.start[e + 1] - mesh.start[e])});
    if (mesh.content === 'polyhedra') {
        const cell = cellFacets(mesh);
        own.push({key: 'facets', label: 'faces', of: 'element',
                  values: Float32Array.from(
                      {length: mesh.elements}, (_, e) => cell.start[e + 1] - cell.start[e])});
    }
    if (mesh.facetMarker)
        own.push({key: 'marker', label: 'marker', of: 'facet', values: mesh.facetMarker});
    mesh.fields = [{key: 'plain', label: 'nothing: outside and inside', of: 'nothing'},
                   ...mesh.fields, ...own];
    for (const f of mesh.fields) {
        f.means = f.of === 'node' ? meansOf(mesh, f.values)
            : f.of === 'element' ? f.values : null;
    }
}

const NAMES_OF = {region: 3, marker: 2, 'node-marker': 0};
const CATEGORIES = ['region', 'marker', 'node-marker', 'level', 'kind'];

/* The values of a field that counts few whole numbers; null where they are others. */
function categoriesOf(meshes, key) {
    const most = 64, count = new Map();
    for (const mesh of meshes) {
        const field = mesh.fields.find(f => f.key === key);
        if (!field)
            continue;
        for (const value of field.values) {
            if (!Number.isInteger(value))
                return null;
            count.set(value, (count.get(value) || 0) + 1);
            if (count.size > most)
                return null;
        }
    }
    const values = [...count.keys()].sort((a, b) => a - b);
    return values.map((value, i) => ({
        value, count: count.get(value), name: nameOfValue(meshes, key, value),
        colour: key === 'level' ? mapColour('viridis', i / Math.max(values.length - 1, 1))
            : key !== 'region' && value === 0 ? UNMARKED : paletteColour(i),
    }));
}

function nameOfValue(meshes, key, value) {
    if (key === 'kind')
        return KIND_OF_NODES[value];
    for (const mesh of meshes) {
        const name = key in NAMES_OF && mesh.names[NAMES_OF[key]][value];
        if (name)
            return value + ' ' + name;
    }
    return key !== 'region' && key !== 'level' && value === 0 ? 'none' : String(value);
}

/* All fields of the meshes by key, with the range of both. */
function joinFields(meshes) {
    const fields = new Map();
    for (const mesh of meshes) {
        for (const f of mesh.fields) {
            if (!fields.has(f.key))
                fields.set(f.key, {key: f.key, label: f.label, unit: f.unit || '', of: f.of,
                                   quality: Boolean(f.quality), least: Infinity,
                                   most: -Infinity});
            const joined = fields.get(f.key);
            for (const value of f.means || f.values || []) {
                joined.least = Math.min(joined.least, value);
                joined.most = Math.max(joined.most, value);
            }
        }
    }
    for (const f of fields.values())
        f.categories = CATEGORIES.includes(f.key) ? categoriesOf(meshes, f.key) : null;
    return fields;
}

/* The shade of values: colour(table, index) is at 3 * shade. */
function shadeOf(value, range) {
    const t = (value - range[0]) / (range[1] - range[0] || 1);
    return t > 0 ? t < 1 ? Math.floor(t * SHADES) : SHADES - 1 : 0;
}

/* A painter of a mesh: paint(facet, element, node, to, at) puts red, green and blue. */
function painterOf(mesh, field, range, map) {
    const own = mesh.fields.find(f => f.key === field.key);
    const plain = (f, to, at) => to.set(
        f >= 0 && mesh.side[2 * f + 1] !== NONE ? INSIDE : OUTSIDE, at);
    if (!own || own.of === 'nothing')
        return (f, e, v, to, at) => plain(f, to, at);
    if (field.categories) {
        const colour = new Map(field.categories.map(c => [c.value, c.colour]));
        const values = own.of === 'facet' || own.of === 'node' ? own.values : own.means;
        if (own.of === 'facet')
            return (f, e, v, to, at) => to.set(f < 0 ? INSIDE : colour.get(values[f]), at);
        if (own.of === 'node')
            return (f, e, v, to, at) => to.set(v < 0 ? INSIDE : colour.get(values[v]), at);
        return (f, e, v, to, at) => to.set(colour.get(values[e]), at);
    }
    const table = tableOf(map);
    return (f, e, v, to, at) => {
        const value = own.of === 'facet' ? f < 0 ? 0 : own.values[f]
            : own.of === 'node' && v >= 0 ? own.values[v] : own.means[e];
        const i = 3 * shadeOf(value, range);
        to[at] = table[i];
        to[at + 1] = table[i + 1];
        to[at + 2] = table[i + 2];
    };
}
