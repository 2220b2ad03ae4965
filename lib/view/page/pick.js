/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Picking: the first triangle on the ray through a pixel. */

/* The ray through a pixel of the canvas, in its pane. */
function rayAt(x, y, pane) {
    const height = view.canvas.clientHeight, camera = cameraOf(pane.width / height);
    const tangent = Math.tan(camera.fov * Math.PI / 360), {right, up, back} = frameOf(state.camera);
    const u = (2 * (x - pane.x) / pane.width - 1) * tangent * camera.aspect;
    const v = (1 - 2 * y / height) * tangent;
    return {from: eyeOf(state.camera), to: back.map((b, a) => u * right[a] + v * up[a] - b)};
}

/* How far along the ray it meets a triangle; Infinity where it does not. (Möller and
 * Trumbore 1997.) */
function distanceTo(ray, p, i) {
    const edge = [p[i + 3] - p[i], p[i + 4] - p[i + 1], p[i + 5] - p[i + 2]];
    const other = [p[i + 6] - p[i], p[i + 7] - p[i + 1], p[i + 8] - p[i + 2]];
    const h = crossOf(ray.to, other), determinant = dotOf(edge, h);
    if (determinant === 0)
        return Infinity;
    const s = [ray.from[0] - p[i], ray.from[1] - p[i + 1], ray.from[2] - p[i + 2]];
    const u = dotOf(s, h) / determinant;
    if (u < 0 || u > 1)
        return Infinity;
    const q = crossOf(s, edge), v = dotOf(ray.to, q) / determinant;
    if (v < 0 || u + v > 1)
        return Infinity;
    const t = dotOf(other, q) / determinant;
    return t > 0 ? t : Infinity;
}

/* The element that is seen at a pixel of the canvas; -1 where there is none. */
function elementAt(x, y) {
    const pane = paneAt(x), {mesh} = pane, ray = rayAt(x, y, pane);
    let nearest = Infinity, element = -1;
    if (mesh.content === 'points')
        return {mesh, element: pointAt(mesh, ray)};
    for (const target of [mesh.solid, mesh.cap]) {
        for (let t = 0; 3 * t < target.count; t++) {
            const distance = distanceTo(ray, target.position, 9 * t);
            if (!(distance < nearest) || (target === mesh.solid && isClipped(ray, distance)))
                continue;
            nearest = distance;
            element = target.elementOf[t];
        }
    }
    return {mesh, element};
}

function isClipped(ray, distance) {
    return state.cut === 'plain' &&
        dotOf(ray.from.map((x, a) => x + distance * ray.to[a]), state.normal) > state.offset;
}

/* The visible point nearest to the ray, within some pixels. */
function pointAt(mesh, ray) {
    const size = Math.hypot(...ray.to), pixels = 8;
    const tangent = Math.tan(FIELD_OF_VIEW * Math.PI / 360);
    let nearest = 2 * pixels * tangent / view.canvas.clientHeight, element = -1;
    for (let e = 0; e < mesh.elements; e++) {
        if (!mesh.visible[e])
            continue;
        const p = [0, 1, 2].map(a => mesh.xyz[3 * e + a] - ray.from[a]);
        const along = dotOf(p, ray.to) / size;
        const away = Math.hypot(...crossOf(p, ray.to)) / size / along;
        if (along > 0 && away < nearest) {
            nearest = away;
            element = e;
        }
    }
    return element;
}

function pickAt(x, y) {
    const {mesh, element} = elementAt(x, y);
    pick(mesh, element);
}

/* Marks an element, or none, and says what it is. */
function pick(mesh, element) {
    for (const m of view.meshes) {
        m.picked = m === mesh ? element : -1;
        updateMark(m);
    }
    showPicked(element >= 0 ? mesh : null, element);
    draw();
}

function neighboursOf(mesh, e) {
    if (mesh.content === 'points' || mesh.content === 'surface')
        return [];
    const cell = cellFacets(mesh), list = new Set();
    for (let i = cell.start[e]; i < cell.start[e + 1]; i++) {
        const f = cell.facet[i], p = mesh.side[2 * f], q = mesh.side[2 * f + 1];
        const other = p === e ? q : p;
        if (other < LEFT_OUT)
            list.add(other);
    }
    return [...list];
}

/* Rows of words about an element. */
function wordsOf(mesh, e) {
    const rows = [[kindOf(mesh, e), String(numberOf(mesh, e))]];
    for (const f of mesh.fields) {
        if (!f.means || f.key === 'kind')
            continue;
        const joined = view.fields.get(f.key);
        const category = joined.categories && joined.categories.find(c => c.value === f.means[e]);
        rows.push([f.label, category ? category.name : words(f.means[e]) + (f.unit || '')]);
    }
    if (mesh.facetMarker) {
        const cell = cellFacets(mesh), markers = new Set();
        for (let i = cell.start[e]; i < cell.start[e + 1]; i++)
            if (mesh.facetMarker[cell.facet[i]] !== 0)
                markers.add(nameOfValue([mesh], 'marker', mesh.facetMarker[cell.facet[i]]));
        if (markers.size > 0)
            rows.push(['markers of faces', [...markers].join(', ')]);
    }
    const few = 24, neighbours = neighboursOf(mesh, e).map(n => numberOf(mesh, n));
    if (neighbours.length > 0)
        rows.push(['neighbours', neighbours.slice(0, few).join(' ') +
                   (neighbours.length > few ? ' …' : '')]);
    const nodes = nodesOf(mesh, e);
    rows.push(['centre', toStream([...mesh.centroid.subarray(3 * e, 3 * e + 3)])
        .map(words).join(' ')]);
    nodes.slice(0, few).forEach(v => rows.push(
        ['node ' + (v + mesh.head.base),
         toStream([...mesh.xyz.subarray(3 * v, 3 * v + 3)]).map(words).join(' ')]));
    return rows;
}

/* A number with some five digits. */
function words(x) {
    if (Number.isInteger(x) && Math.abs(x) < 1e6)
        return String(x);
    return String(Number(x.toPrecision(5)));
}
