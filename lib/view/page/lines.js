/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The edges of the stream (.edge): feature curves and what else is marked, as lines. */

/* The values of markers of edges that there are: value, name, colour, count. */
function edgeGroups(meshes) {
    const count = new Map();
    for (const mesh of meshes)
        for (let i = 0; i < mesh.lines.count; i++) {
            const value = mesh.lines.marker ? mesh.lines.marker[i] : 0;
            count.set(value, (count.get(value) || 0) + 1);
        }
    const byName = value => meshes.map(m => m.names[1][value]).find(name => name);
    return [...count.keys()].sort((a, b) => a - b).map((value, i) => ({
        value, count: count.get(value), colour: paletteColour(i + 5),
        name: byName(value) ? value + ' ' + byName(value) : value === 0 ? 'none' : String(value),
    }));
}

/* Whether somebody has told edges apart: 1 and -1 are what TetGen gives to all of them. */
function areTold(groups) {
    return groups.some(g => Math.abs(g.value) > 1 || / /.test(g.name));
}

/* The lines of a mesh, once: they never change. */
function makeLines(mesh, groups) {
    const {node, marker, count} = mesh.lines;
    const colour = new Map(groups.map(g => [g.value, g.colour]));
    const position = new Float32Array(6 * count), tint = new Uint8Array(6 * count);
    for (let i = 0; i < 2 * count; i++) {
        position.set(mesh.xyz.subarray(3 * node[i], 3 * node[i] + 3), 3 * i);
        tint.set(colour.get(marker ? marker[i >> 1] : 0), 3 * i);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(tint, 3, true));
    mesh.lines.plane = new THREE.Plane();
    mesh.lines.object = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial(
        {vertexColors: THREE.VertexColors, clippingPlanes: [mesh.lines.plane]}));
    mesh.lines.object.frustumCulled = false;
    mesh.scene.add(mesh.lines.object);
}

/* They end at the plane of a cut; where elements are pulled apart there are none. */
function updateLines(mesh) {
    const {object, plane, count} = mesh.lines, cut = state.cut !== 'none';
    const [a, b, c] = state.normal;
    object.visible = state.lines && count > 0 && state.explode === 0;
    plane.normal.set(-a, -b, -c);
    plane.constant = cut ? state.offset : Infinity;
}

/* The legend below their switch. */
function listLines(groups) {
    byId('lining').hidden = groups.length === 0;
    byId('lineNames').replaceChildren(...groups.map(group => {
        const item = document.createElement('li');
        item.append(...legendOf(group));
        return item;
    }));
}
