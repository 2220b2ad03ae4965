/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header and the arrays of the page, and the meshes that they make.
 *
 * A mesh: nodes, xyz [3 * nodes] in the frame of the page; elements, start and item: the
 * nodes of element e are item[start[e]] … item[start[e + 1] - 1] (not of polyhedra);
 * facets, see facets.js; centroid [3 * elements]; fields, see colour.js. */
'use strict';

const NONE = 0xffffffff;
const LEFT_OUT = 0xfffffffe; /* a side of a facet: an element that is not in the page */

const header = JSON.parse(document.getElementById('header').textContent);

function bytesOfBase64(text) {
    if (Uint8Array.fromBase64)
        return Uint8Array.fromBase64(text);
    const binary = atob(text), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; i++)
        bytes[i] = binary.charCodeAt(i);
    return bytes;
}

/* What an element of the page holds, inflated. The element is removed. */
async function inflate(id) {
    const element = document.getElementById(id);
    const packed = new Blob([bytesOfBase64(element.textContent.trim())]);
    element.remove();
    const stream = packed.stream().pipeThrough(new DecompressionStream('deflate-raw'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/* An array of the header: the lowest bytes of all numbers come first. */
async function readArray(array) {
    const bytes = await inflate('array-' + array.array), n = array.count;
    if (array.type === 'u8')
        return bytes;
    const number = new Uint32Array(n);
    for (let i = 0; i < n; i++)
        number[i] = bytes[i] | bytes[n + i] << 8 | bytes[2 * n + i] << 16 |
            bytes[3 * n + i] << 24;
    if (array.type === 'f32')
        return new Float32Array(number.buffer);
    return array.type === 'i32' ? new Int32Array(number.buffer) : number;
}

/* start[i + 1] - start[i] = size[i]; or `same` for all of `count`. */
function startsOf(size, count, same) {
    const start = new Uint32Array(count + 1);
    for (let i = 0; i < count; i++)
        start[i + 1] = start[i] + (size ? size[i] : same);
    return start;
}

const NODES_OF = {surface: 3, tetrahedra: 4};
const KIND_OF_NODES = {3: 'triangle', 4: 'tetrahedron', 5: 'pyramid', 6: 'wedge',
                       8: 'hexahedron'};

async function readMesh(head) {
    const array = {};
    for (const key of Object.keys(head.arrays))
        array[key] = await readArray(head.arrays[key]);
    const mesh = {head, name: head.name, content: head.content, nodes: head.nodes,
                  xyz: array.xyz, elements: head.shown, number: array.number || null,
                  outer: array.outer || null, hidden: new Uint8Array(head.shown),
                  visible: new Uint8Array(head.shown), names: [{}, {}, {}, {}]};
    for (const [dimension, value, name] of head.names)
        mesh.names[dimension][value] = name;
    if (array.item) {
        mesh.item = array.item;
        mesh.start = startsOf(array.size, mesh.elements, NODES_OF[mesh.content]);
    }
    const marked = [];
    for (const m of head.marked || [])
        marked.push({size: await readArray(m.size), item: await readArray(m.item),
                     marker: await readArray(m.marker)});
    mesh.lines = {node: array.edge || null, marker: array.edgeMarker || null,
                  count: array.edge ? array.edge.length / 2 : 0};
    await pause();
    makeFacets(mesh, array, marked);
    findCentroids(mesh);
    mesh.fields = [];
    for (const f of head.fields)
        mesh.fields.push({...f, values: await readArray(f.values), type: f.values.type});
    return mesh;
}

/* The number of element e in the stream. */
function numberOf(mesh, e) {
    return (mesh.number ? mesh.number[e] : e) + mesh.head.base;
}

function kindOf(mesh, e) {
    if (mesh.content === 'points')
        return 'point';
    return mesh.content === 'polyhedra' ? 'polyhedron'
                                        : KIND_OF_NODES[mesh.start[e + 1] - mesh.start[e]];
}

/* The nodes of an element, each once. */
function nodesOf(mesh, e) {
    if (mesh.content === 'points')
        return [e];
    if (mesh.item)
        return Array.from(mesh.item.subarray(mesh.start[e], mesh.start[e + 1]));
    const nodes = new Set(), cell = cellFacets(mesh);
    for (let i = cell.start[e]; i < cell.start[e + 1]; i++) {
        const f = cell.facet[i];
        for (let j = mesh.facetStart[f]; j < mesh.facetStart[f + 1]; j++)
            nodes.add(mesh.facetItem[j]);
    }
    return [...nodes];
}

/* The mean of an element's nodes; of a polyhedron, of the corners of its facets. */
function findCentroids(mesh) {
    const {xyz, elements} = mesh, centroid = new Float32Array(3 * elements);
    if (mesh.content === 'points') {
        mesh.centroid = xyz;
        return;
    }
    mesh.centroid = centroid;
    if (mesh.item) {
        for (let e = 0; e < elements; e++) {
            const from = mesh.start[e], to = mesh.start[e + 1];
            let x = 0, y = 0, z = 0;
            for (let i = from; i < to; i++) {
                const v = 3 * mesh.item[i];
                x += xyz[v];
                y += xyz[v + 1];
                z += xyz[v + 2];
            }
            centroid[3 * e] = x / (to - from);
            centroid[3 * e + 1] = y / (to - from);
            centroid[3 * e + 2] = z / (to - from);
        }
        return;
    }
    const corners = new Uint32Array(elements);
    for (let f = 0; f < mesh.facets; f++) {
        for (let side = 0; side < 2; side++) {
            const c = mesh.side[2 * f + side];
            if (c >= LEFT_OUT)
                continue;
            for (let i = mesh.facetStart[f]; i < mesh.facetStart[f + 1]; i++) {
                for (let a = 0; a < 3; a++)
                    centroid[3 * c + a] += xyz[3 * mesh.facetItem[i] + a];
                corners[c]++;
            }
        }
    }
    for (let i = 0; i < centroid.length; i++)
        centroid[i] /= corners[Math.floor(i / 3)] || 1;
}

/* Lets the browser draw and listen. */
function pause() {
    return new Promise(resolve => setTimeout(resolve, 0));
}

/* x y z as the stream has them. */
function toStream(p) {
    return p.map((x, a) => header.centre[a] + header.scale * x);
}
