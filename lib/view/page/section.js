/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plain section: where the plane meets elements there are polygons. */

/* The segments in which the plane meets facets, by the elements on both sides: next[head[e]]
 * … . Ends are in x y z, and known by the edge on which they are. */
function segmentsOf(mesh, height) {
    const {xyz, facetStart, facetItem, side, facets, nodes} = mesh;
    const end = [], key = [], element = [], above = new Uint8Array(nodes);
    for (let v = 0; v < nodes; v++)
        above[v] = height[v] > 0 ? 1 : 0;
    for (let f = 0; f < facets; f++) {
        const from = facetStart[f], to = facetStart[f + 1], first = above[facetItem[from]];
        let i = from + 1;
        while (i < to && above[facetItem[i]] === first)
            i++;
        if (i === to)
            continue;
        const ends = [];
        for (i = from; i < to; i++) {
            const p = facetItem[i], q = facetItem[i + 1 < to ? i + 1 : from];
            if (above[p] === above[q])
                continue;
            const low = Math.min(p, q), high = Math.max(p, q);
            const t = height[low] / (height[low] - height[high]);
            ends.push({key: low * nodes + high,
                       at: [0, 1, 2].map(a => xyz[3 * low + a] +
                           t * (xyz[3 * high + a] - xyz[3 * low + a]))});
        }
        sortAlong(ends);
        for (i = 0; i + 1 < ends.length; i += 2) {
            for (let s = 0; s < 2; s++) {
                const e = side[2 * f + s];
                if (e >= LEFT_OUT || !mesh.visible[e])
                    continue;
                end.push(ends[i].at, ends[i + 1].at);
                key.push(ends[i].key, ends[i + 1].key);
                element.push(e);
            }
        }
    }
    return {end, key, element};
}

/* Of a facet that is not convex there may be more than two ends on the line. */
function sortAlong(ends) {
    if (ends.length <= 2)
        return;
    const a = ends[0].at;
    let axis = 0, widest = 0;
    for (const {at} of ends)
        for (let i = 0; i < 3; i++)
            if (Math.abs(at[i] - a[i]) > widest) {
                widest = Math.abs(at[i] - a[i]);
                axis = i;
            }
    ends.sort((p, q) => p.at[axis] - q.at[axis]);
}

/* Chains the segments of one element to closed polygons: lists of x y z. */
function chain(segments, list) {
    const left = new Set(list), polygons = [];
    while (left.size > 0) {
        const first = left.values().next().value;
        left.delete(first);
        const polygon = [segments.end[2 * first], segments.end[2 * first + 1]];
        const begin = segments.key[2 * first];
        let key = segments.key[2 * first + 1], found = true;
        while (key !== begin && found) {
            found = false;
            for (const s of left) {
                const i = segments.key[2 * s] === key ? 0 : segments.key[2 * s + 1] === key ? 1 : -1;
                if (i < 0)
                    continue;
                left.delete(s);
                key = segments.key[2 * s + 1 - i];
                polygon.push(segments.end[2 * s + 1 - i]);
                found = true;
                break;
            }
        }
        if (key === begin)
            polygon.pop();
        if (polygon.length > 2)
            polygons.push(polygon);
    }
    return polygons;
}

/* [{element, polygon}] of all visible elements that the plane meets. */
function sectionOf(mesh) {
    const {xyz, nodes} = mesh, height = new Float32Array(nodes), [a, b, c] = state.normal;
    for (let v = 0, i = 0; v < nodes; v++, i += 3)
        height[v] = a * xyz[i] + b * xyz[i + 1] + c * xyz[i + 2] - state.offset;
    const segments = segmentsOf(mesh, height), of = new Map(), section = [];
    segments.element.forEach((e, s) => {
        if (!of.has(e))
            of.set(e, []);
        of.get(e).push(s);
    });
    for (const [element, list] of of)
        for (const polygon of chain(segments, list))
            section.push({element, polygon});
    return section;
}

/* Two axes in the plane with that normal. */
function axesOf(normal) {
    const [a, b, c] = normal, other = Math.abs(c) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    const u = crossOf(other, normal), size = Math.hypot(...u) || 1;
    const unit = u.map(x => x / size);
    return [unit, crossOf([a, b, c], unit)];
}

function crossOf(p, q) {
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
}

function dotOf(p, q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
