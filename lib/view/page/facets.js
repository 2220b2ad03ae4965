/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The facets of a mesh: facet f is the polygon facetItem[facetStart[f]] …, between the
 * elements side[2 f] and side[2 f + 1], which is NONE on the boundary. Elements share a
 * face if they have the same nodes there; of three, the third has one of its own. */

const FACES_OF = {
    4: [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]],
    5: [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    6: [[0, 1, 2], [3, 5, 4], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]],
    8: [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]],
};

/* The faces of elements, one after the other, by three of their nodes: the least, the one
 * above it and the largest, which of more than three has its highest bit set. */
function listFaces(mesh) {
    const {start, item, elements} = mesh;
    const from = new Uint32Array(elements + 1);
    for (let e = 0; e < elements; e++)
        from[e + 1] = from[e] + FACES_OF[start[e + 1] - start[e]].length;
    const count = from[elements];
    const faces = {from, count, least: new Uint32Array(count), next: new Uint32Array(count),
                   last: new Uint32Array(count)};
    for (let e = 0, h = 0; e < elements; e++) {
        const s = start[e], table = FACES_OF[start[e + 1] - s];
        for (let i = 0; i < table.length; i++, h++) {
            const t = table[i];
            putKey(faces, h, item[s + t[0]], item[s + t[1]], item[s + t[2]],
                   t.length > 3 ? item[s + t[3]] : NONE);
        }
    }
    return faces;
}

function putKey(faces, h, a, b, c, d) {
    let low = a < b ? a : b, high = a < b ? b : a, middle;
    if (c < low) {
        middle = low;
        low = c;
    } else if (c > high) {
        middle = high;
        high = c;
    } else {
        middle = c;
    }
    if (d !== NONE) {
        if (d < low) {
            middle = low;
            low = d;
        } else if (d < middle) {
            middle = d;
        }
        high = (Math.max(high, d) | 0x80000000) >>> 0;
    }
    faces.least[h] = low;
    faces.next[h] = middle;
    faces.last[h] = high;
}

/* order[first[v]] … order[first[v + 1] - 1]: the faces whose least node is v, with next and
 * last in this order, too: what is compared is side by side. */
function bucketsOf(faces, nodes) {
    const {count, least} = faces, first = new Uint32Array(nodes + 1);
    const order = new Uint32Array(count), next = new Uint32Array(count);
    const last = new Uint32Array(count), few = 500;
    for (let h = 0; h < count; h++)
        first[least[h]]++;
    for (let v = 0, sum = 0; v <= nodes; v++) {
        sum += first[v];
        first[v] = sum;
    }
    for (let h = count; h-- > 0;)
        order[--first[least[h]]] = h;
    for (let v = 0; v < nodes; v++)
        if (first[v + 1] - first[v] > few)
            order.subarray(first[v], first[v + 1]).sort(
                (g, h) => faces.next[g] - faces.next[h] || faces.last[g] - faces.last[h] || g - h);
    for (let i = 0; i < count; i++) {
        next[i] = faces.next[order[i]];
        last[i] = faces.last[order[i]];
    }
    return {first, order, next, last, few};
}

/* mate[h]: the face that is the same as h; itself where there is none. Large buckets are
 * sorted: what is the same follows. */
function matesOf(count, buckets, nodes) {
    const {first, order, next, last, few} = buckets;
    const mate = new Uint32Array(count).fill(NONE);
    for (let v = 0; v < nodes; v++) {
        const from = first[v], to = first[v + 1], isSorted = to - from > few;
        for (let i = from; i < to; i++) {
            const h = order[i], n = next[i], l = last[i];
            if (mate[h] !== NONE)
                continue;
            mate[h] = h;
            const end = isSorted && i + 2 < to ? i + 2 : to;
            for (let j = i + 1; j < end; j++) {
                if (next[j] !== n || last[j] !== l)
                    continue;
                const g = order[j];
                if (mate[g] !== NONE)
                    continue;
                mate[h] = g;
                mate[g] = h;
                break;
            }
        }
    }
    return mate;
}

function facetsOfElements(mesh, marked) {
    const {start, item, elements} = mesh;
    const faces = listFaces(mesh), buckets = bucketsOf(faces, mesh.nodes);
    const mate = matesOf(faces.count, buckets, mesh.nodes);
    const owner = new Uint32Array(faces.count), facet = new Uint32Array(faces.count);
    for (let e = 0; e < elements; e++)
        owner.fill(e, faces.from[e], faces.from[e + 1]);
    let count = 0, items = 0;
    for (let h = 0; h < faces.count; h++) {
        if (mate[h] < h)
            continue;
        count++;
        items += faces.last[h] & 0x80000000 ? 4 : 3;
    }
    const side = new Uint32Array(2 * count), facetStart = new Uint32Array(count + 1);
    const facetItem = new Uint32Array(items);
    for (let e = 0, h = 0, f = 0, k = 0; e < elements; e++) {
        const s = start[e], table = FACES_OF[start[e + 1] - s];
        for (let i = 0; i < table.length; i++, h++) {
            if (mate[h] < h) {
                facet[h] = facet[mate[h]];
                continue;
            }
            facet[h] = f;
            side[2 * f] = e;
            side[2 * f + 1] = mate[h] !== h ? owner[mate[h]]
                : !mesh.outer || mesh.outer[e] >> i & 1 ? NONE : LEFT_OUT;
            const t = table[i];
            for (let j = 0; j < t.length; j++)
                facetItem[k++] = item[s + t[j]];
            facetStart[++f] = k;
        }
    }
    Object.assign(mesh, {facets: count, side, facetStart, facetItem, facetMarker: null});
    if (marked.length > 0)
        markFacets(mesh, marked, buckets, facet);
}

/* Markers of the stream's rows go to the facets that have their nodes. */
function markFacets(mesh, marked, buckets, facet) {
    const key = {least: [0], next: [0], last: [0]};
    mesh.facetMarker = new Int32Array(mesh.facets);
    for (const {size, item, marker} of marked) {
        for (let r = 0, i = 0; r < size.length; i += size[r++]) {
            if (size[r] > 4)
                continue;
            putKey(key, 0, item[i], item[i + 1], item[i + 2], size[r] > 3 ? item[i + 3] : NONE);
            const v = key.least[0];
            for (let j = buckets.first[v]; j < buckets.first[v + 1]; j++) {
                const h = buckets.order[j];
                if (buckets.next[j] === key.next[0] && buckets.last[j] === key.last[0])
                    mesh.facetMarker[facet[h]] = marker[r];
            }
        }
    }
}

function makeFacets(mesh, array, marked) {
    if (mesh.content === 'points') {
        Object.assign(mesh, {facets: 0, side: new Uint32Array(0), facetMarker: null,
                             facetStart: new Uint32Array(1), facetItem: new Uint32Array(0)});
    } else if (mesh.content === 'surface') {
        const side = new Uint32Array(2 * mesh.elements).fill(NONE);
        for (let e = 0; e < mesh.elements; e++)
            side[2 * e] = e;
        Object.assign(mesh, {facets: mesh.elements, side, facetStart: mesh.start,
                             facetItem: mesh.item, facetMarker: null});
    } else if (mesh.content === 'polyhedra') {
        const size = array.facetSize;
        Object.assign(mesh, {facets: size.length, side: array.side,
                             facetStart: startsOf(size, size.length),
                             facetItem: array.facetItem,
                             facetMarker: array.facetMarker || null});
    } else {
        facetsOfElements(mesh, marked);
    }
}

/* The facets of element e: facet[start[e]] … facet[start[e + 1] - 1]. */
function cellFacets(mesh) {
    if (mesh.cell)
        return mesh.cell;
    const start = new Uint32Array(mesh.elements + 1);
    for (let i = 0; i < mesh.side.length; i++)
        if (mesh.side[i] < LEFT_OUT)
            start[mesh.side[i]]++;
    for (let e = 0, sum = 0; e <= mesh.elements; e++) {
        sum += start[e];
        start[e] = sum;
    }
    const facet = new Uint32Array(start[mesh.elements]);
    for (let i = mesh.side.length; i-- > 0;)
        if (mesh.side[i] < LEFT_OUT)
            facet[--start[mesh.side[i]]] = i >> 1;
    mesh.cell = {start, facet};
    return mesh.cell;
}

/* layer[e]: how many elements are between e and the boundary, from 0; and the most. */
function layersOf(mesh) {
    if (mesh.layers)
        return mesh.layers;
    const layer = new Int32Array(mesh.elements).fill(-1), cell = cellFacets(mesh);
    const queue = new Uint32Array(mesh.elements);
    let end = 0, most = 0;
    for (let f = 0; f < mesh.facets; f++) {
        const e = mesh.side[2 * f];
        if (mesh.side[2 * f + 1] === NONE && layer[e] < 0) {
            layer[e] = 0;
            queue[end++] = e;
        }
    }
    for (let at = 0; at < end; at++) {
        const e = queue[at];
        most = layer[e];
        for (let i = cell.start[e]; i < cell.start[e + 1]; i++) {
            const f = cell.facet[i];
            const other = mesh.side[2 * f] === e ? mesh.side[2 * f + 1] : mesh.side[2 * f];
            if (other < LEFT_OUT && layer[other] < 0) {
                layer[other] = layer[e] + 1;
                queue[end++] = other;
            }
        }
    }
    mesh.layers = {layer, most};
    return mesh.layers;
}

/* Polygons as triangles --------------------------------------------------------------- */

/* The triangles of a polygon with corners in the plane x[i] y[i], as numbers of corners:
 * a fan where it is convex, else ear by ear. */
function triangulate(x, y, k) {
    const cross = (a, b, c) =>
        (x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a]);
    let area = 0;
    for (let i = 1; i + 1 < k; i++)
        area += cross(0, i, i + 1);
    const sign = area < 0 ? -1 : 1, list = [], left = [];
    for (let i = 0; i < k; i++)
        left.push(i);
    const isEar = (a, b, c) => {
        if (sign * cross(a, b, c) <= 0)
            return false;
        for (const p of left)
            if (p !== a && p !== b && p !== c && sign * cross(a, b, p) >= 0 &&
                sign * cross(b, c, p) >= 0 && sign * cross(c, a, p) >= 0)
                return false;
        return true;
    };
    let at = 0, tries = 0;
    while (left.length > 3) {
        const n = left.length, a = left[at % n], b = left[(at + 1) % n],
              c = left[(at + 2) % n];
        if (isEar(a, b, c) || tries > n) {
            list.push(a, b, c);
            left.splice((at + 1) % n, 1);
            tries = 0;
        } else {
            at++;
            tries++;
        }
    }
    list.push(left[0], left[1], left[2]);
    return list;
}

/* The same of a polygon in space: seen along its largest extent. */
function triangulateInSpace(xyz, item, from, k) {
    const normal = [0, 0, 0];
    for (let i = 0; i < k; i++) {
        const p = 3 * item[from + i], q = 3 * item[from + (i + 1) % k];
        for (let a = 0; a < 3; a++) {
            const b = (a + 1) % 3, c = (a + 2) % 3;
            normal[a] += (xyz[p + b] - xyz[q + b]) * (xyz[p + c] + xyz[q + c]);
        }
    }
    const size = normal.map(Math.abs), axis = size.indexOf(Math.max(...size));
    const x = [], y = [];
    for (let i = 0; i < k; i++) {
        x.push(xyz[3 * item[from + i] + (axis + 1) % 3]);
        y.push(xyz[3 * item[from + i] + (axis + 2) % 3]);
    }
    return triangulate(x, y, k);
}

const TRIANGLE = [0, 1, 2], QUADRILATERAL = [0, 1, 2, 0, 2, 3];

/* The triangles of facet f as numbers of its corners. */
function trianglesOf(mesh, f) {
    const from = mesh.facetStart[f], k = mesh.facetStart[f + 1] - from;
    if (k === 3)
        return TRIANGLE;
    if (mesh.content === 'mixed')
        return QUADRILATERAL;
    if (!mesh.triangles)
        mesh.triangles = new Array(mesh.facets);
    return mesh.triangles[f] ||
        (mesh.triangles[f] = triangulateInSpace(mesh.xyz, mesh.facetItem, from, k));
}
