/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which elements are seen: those on one side of a plane, as whole ones, behind so many
 * layers, in a range of the field, and not hidden. */

/* The `count` elements with the least values, as bytes; kept until others are asked for. */
function worstOf(mesh, values, count) {
    const {worst} = mesh;
    if (!worst || worst.values !== values || worst.count !== count)
        mesh.worst = {values, count, chosen: findWorst(mesh, values, count)};
    return mesh.worst.chosen;
}

function findWorst(mesh, values, count) {
    const chosen = new Uint8Array(mesh.elements);
    if (count >= mesh.elements)
        return chosen.fill(1);
    const sorted = Float32Array.from(values).sort(), limit = sorted[count];
    let left = count;
    for (let e = 0; e < mesh.elements; e++) {
        if (values[e] < limit) {
            chosen[e] = 1;
            left--;
        }
    }
    for (let e = 0; e < mesh.elements && left > 0; e++) {
        if (values[e] === limit) {
            chosen[e] = 1;
            left--;
        }
    }
    return chosen;
}

/* Takes those out whose category is switched off. */
function applyCategories(mesh, own, field) {
    const off = new Set(field.categories.filter(c => state.off.has(c.value)).map(c => c.value));
    if (off.size === 0 || !own.means)
        return;
    for (let e = 0; e < mesh.elements; e++)
        if (off.has(own.means[e]))
            mesh.visible[e] = 0;
}

function applySelection(mesh, own) {
    const {visible} = mesh, values = own.means;
    if (state.worst > 0) {
        const chosen = worstOf(mesh, values, state.worst);
        for (let e = 0; e < mesh.elements; e++)
            visible[e] &= chosen[e];
    } else if (state.select) {
        const [low, high] = state.select;
        for (let e = 0; e < mesh.elements; e++)
            if (!(values[e] >= low && values[e] <= high))
                visible[e] = 0;
    }
}

/* Sets mesh.visible and returns how many there are. */
function findVisible(mesh) {
    const {visible, hidden, centroid, elements} = mesh;
    const [a, b, c] = state.normal, offset = state.offset;
    const cuts = state.cut === 'whole';
    for (let e = 0; e < elements; e++)
        visible[e] = hidden[e] ? 0 : 1;
    if (cuts) {
        for (let e = 0, i = 0; e < elements; e++, i += 3)
            if (a * centroid[i] + b * centroid[i + 1] + c * centroid[i + 2] > offset)
                visible[e] = 0;
    }
    if (state.peel > 0) {
        const {layer} = layersOf(mesh);
        for (let e = 0; e < elements; e++)
            if (layer[e] < state.peel)
                visible[e] = 0;
    }
    const field = view.fields.get(state.field);
    const own = mesh.fields.find(f => f.key === state.field);
    if (own && own.means && (state.worst > 0 || state.select))
        applySelection(mesh, own);
    if (own && field.categories && state.off.size > 0)
        applyCategories(mesh, own, field);
    let count = 0;
    for (let e = 0; e < elements; e++)
        count += visible[e];
    return count;
}

/* The facets that are drawn, and for each the element whose face it is there: those with
 * a visible element on one side only; of exploded elements, both sides of all. */
function findDrawn(mesh, exploded) {
    const {side, visible, facets} = mesh, few = 100000;
    if (!mesh.drawnFacet || mesh.drawnFacet.length < facets) {
        mesh.drawnFacet = new Uint32Array(facets);
        mesh.drawnElement = new Uint32Array(facets);
    }
    let {drawnFacet: facet, drawnElement: element} = mesh, count = 0;
    for (let f = 0; f < facets; f++) {
        const p = side[2 * f], q = side[2 * f + 1];
        const a = visible[p], b = q < LEFT_OUT ? visible[q] : 0;
        if (a === b)
            continue;
        facet[count] = f;
        element[count++] = a ? p : q;
    }
    if (exploded && mesh.content !== 'surface') {
        const apart = new Uint8Array(mesh.elements);
        if (mesh.elements <= few)
            apart.set(visible);
        for (let i = 0; i < count; i++)
            apart[element[i]] = 1;
        const both = [[], []];
        for (let f = 0; f < facets; f++) {
            for (let i = 0; i < 2; i++) {
                const e = side[2 * f + i];
                if (e < LEFT_OUT && apart[e]) {
                    both[0].push(f);
                    both[1].push(e);
                }
            }
        }
        [facet, element] = both;
        count = facet.length;
    }
    return {facet, element, count};
}

/* The facets of the boundary. */
function boundaryOf(mesh) {
    const facet = [], element = [];
    for (let f = 0; f < mesh.facets; f++) {
        if (mesh.side[2 * f + 1] !== NONE)
            continue;
        facet.push(f);
        element.push(mesh.side[2 * f]);
    }
    return {facet, element, count: facet.length};
}
