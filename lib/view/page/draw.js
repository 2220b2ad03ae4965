/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drawing, by three.js: triangles that know which of their sides are edges of elements. */

const VERTEX = `
attribute vec4 tint;
attribute vec4 corner;
uniform float pointSize;
varying vec3 vTint, vCorner, vPlace, vWorld;
void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    vTint = tint.rgb;
    vCorner = corner.rgb;
    vPlace = place.xyz;
    vWorld = position;
    gl_Position = projectionMatrix * place;
    gl_PointSize = pointSize;
}`;

/* Edges are as wide everywhere, and fade where they would cover their triangle. */
const FRAGMENT = `
uniform vec4 plane;
uniform float clips, edges, edgeWidth, fill, pointSize;
uniform vec3 edgeColour;
varying vec3 vTint, vCorner, vPlace, vWorld;
void main() {
    if (clips > 0.5 && dot(plane.xyz, vWorld) > plane.w)
        discard;
    if (pointSize > 0.0) {
        vec2 p = 2.0 * gl_PointCoord - 1.0;
        float r = dot(p, p);
        if (r > 1.0)
            discard;
        gl_FragColor = vec4(vTint * (0.55 + 0.45 * sqrt(1.0 - r)), 1.0);
        return;
    }
    vec3 normal = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
    if (dot(normal, vPlace) > 0.0)
        normal = -normal;
    float light = 0.58 + 0.44 * max(dot(normal, vec3(0.267, 0.445, 0.855)), 0.0);
    vec3 wide = max(fwidth(vCorner), vec3(1e-6));
    vec3 away = smoothstep(wide * (edgeWidth - 0.6), wide * (edgeWidth + 0.6), vCorner);
    float line = edges * (1.0 - min(min(away.x, away.y), away.z));
    line *= clamp(1.7 - 6.0 * max(max(wide.x, wide.y), wide.z), 0.0, 1.0);
    vec3 colour = mix(vTint * light, edgeColour, line * (fill < 1.0 ? 1.0 : 0.75));
    gl_FragColor = vec4(colour, fill < 1.0 ? max(fill, line * 0.5) : 1.0);
}`;

function makeMaterial(more) {
    return new THREE.ShaderMaterial({
        vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide,
        extensions: {derivatives: true},
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
        uniforms: {plane: {value: new THREE.Vector4()}, clips: {value: 0}, edges: {value: 1},
                   edgeWidth: {value: 0.7}, fill: {value: 1}, pointSize: {value: 0},
                   edgeColour: {value: new THREE.Color(0x101418)}},
        ...more});
}

/* A growing set of triangles. */
class Triangles {
    constructor(material, points) {
        this.points = points;
        this.room = 0;
        this.count = 0; /* of vertices */
        this.object = points ? new THREE.Points(new THREE.BufferGeometry(), material)
                             : new THREE.Mesh(new THREE.BufferGeometry(), material);
        this.object.frustumCulled = false;
    }

    /* Makes room and forgets what there was. */
    begin(vertices) {
        this.count = 0;
        if (vertices <= this.room)
            return;
        this.room = Math.ceil(vertices * 1.3) + 300;
        this.position = new Float32Array(3 * this.room);
        this.tint = new Uint8Array(4 * this.room);
        this.corner = new Uint8Array(4 * this.room);
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute('position', new THREE.BufferAttribute(this.position, 3));
        geometry.setAttribute('tint', new THREE.BufferAttribute(this.tint, 4, true));
        geometry.setAttribute('corner', new THREE.BufferAttribute(this.corner, 4, true));
        this.object.geometry.dispose();
        this.object.geometry = geometry;
    }

    end() {
        const {attributes} = this.object.geometry;
        this.object.visible = this.count > 0;
        this.object.geometry.setDrawRange(0, this.count);
        for (const name of Object.keys(attributes)) {
            attributes[name].updateRange = {offset: 0, count: this.count * attributes[name].itemSize};
            attributes[name].needsUpdate = true;
        }
    }

    /* The corners of a triangle from the last three vertices; which of the sides opposite
     * to them are edges. */
    setCorners(a, b, c) {
        const at = 4 * (this.count - 3), q = this.corner;
        for (let i = 0; i < 3; i++) {
            q[at + 4 * i] = i === 0 || !a ? 255 : 0;
            q[at + 4 * i + 1] = i === 1 || !b ? 255 : 0;
            q[at + 4 * i + 2] = i === 2 || !c ? 255 : 0;
        }
    }
}

/* Puts facets of a mesh into triangles; facetOf[t] and elementOf[t] of each triangle. */
function fillFacets(target, mesh, list, paint, explode) {
    const {xyz, facetStart, facetItem, centroid} = mesh, {facet, element, count} = list;
    let vertices = 0;
    for (let i = 0; i < count; i++)
        vertices += 3 * (facetStart[facet[i] + 1] - facetStart[facet[i]] - 2);
    target.begin(vertices);
    const facetOf = target.facetOf = new Uint32Array(vertices / 3);
    const elementOf = target.elementOf = new Uint32Array(vertices / 3);
    const {position, tint} = target;
    let n = 0;
    for (let i = 0; i < count; i++) {
        const f = facet[i], e = element[i], from = facetStart[f];
        const k = facetStart[f + 1] - from, triangle = trianglesOf(mesh, f);
        const x = explode * centroid[3 * e], y = explode * centroid[3 * e + 1],
              z = explode * centroid[3 * e + 2];
        for (let t = 0; t < triangle.length; t += 3) {
            for (let j = 0; j < 3; j++, n++) {
                const v = facetItem[from + triangle[t + j]];
                position[3 * n] = xyz[3 * v] + x;
                position[3 * n + 1] = xyz[3 * v + 1] + y;
                position[3 * n + 2] = xyz[3 * v + 2] + z;
                paint(f, e, v, tint, 4 * n);
            }
            facetOf[n / 3 - 1] = f;
            elementOf[n / 3 - 1] = e;
            const [a, b, c] = [triangle[t], triangle[t + 1], triangle[t + 2]];
            target.count = n;
            target.setCorners(isSide(b, c, k), isSide(c, a, k), isSide(a, b, k));
        }
    }
    target.end();
}

function isSide(a, b, k) {
    return (a + 1) % k === b || (b + 1) % k === a;
}

/* Nodes as points; or those that are visible. */
function fillPoints(target, mesh, paint) {
    target.begin(mesh.elements);
    const elementOf = target.elementOf = new Uint32Array(mesh.elements);
    for (let e = 0; e < mesh.elements; e++) {
        if (!mesh.visible[e])
            continue;
        elementOf[target.count] = e;
        target.position.set(mesh.xyz.subarray(3 * e, 3 * e + 3), 3 * target.count);
        paint(-1, e, e, target.tint, 4 * target.count++);
    }
    target.end();
}

function fillSection(target, mesh, section, paint) {
    const [u, v] = axesOf(state.normal);
    const list = section.map(({element, polygon}) => ({
        element, polygon,
        triangle: triangulate(polygon.map(p => dotOf(p, u)), polygon.map(p => dotOf(p, v)),
                              polygon.length)}));
    target.begin(list.reduce((sum, s) => sum + s.triangle.length, 0));
    const elementOf = target.elementOf = [];
    for (const {element, polygon, triangle} of list) {
        const k = polygon.length;
        for (let t = 0; t < triangle.length; t += 3) {
            for (let j = 0; j < 3; j++) {
                target.position.set(polygon[triangle[t + j]], 3 * target.count);
                paint(-1, element, -1, target.tint, 4 * target.count++);
            }
            elementOf.push(element);
            const [a, b, c] = [triangle[t], triangle[t + 1], triangle[t + 2]];
            target.setCorners(isSide(b, c, k), isSide(c, a, k), isSide(a, b, k));
        }
    }
    target.end();
}

/* The scene of one mesh: its facets, the section, the ghost of the boundary, the picked
 * element. */
function makeScene(mesh) {
    const scene = new THREE.Scene();
    mesh.solid = new Triangles(makeMaterial({}), mesh.content === 'points');
    mesh.cap = new Triangles(makeMaterial({}));
    mesh.ghost = new Triangles(makeMaterial({transparent: true, depthWrite: false}));
    mesh.mark = new Triangles(makeMaterial({transparent: true, depthTest: false}));
    mesh.ghost.object.material.uniforms.fill.value = 0.06;
    mesh.ghost.object.renderOrder = 1;
    mesh.mark.object.renderOrder = 2;
    for (const t of [mesh.solid, mesh.cap, mesh.ghost, mesh.mark]) {
        t.object.visible = false;
        scene.add(t.object);
    }
    mesh.scene = scene;
}

/* Makes all that is drawn of a mesh by the state. */
function updateMesh(mesh) {
    const field = view.fields.get(state.field), paint =
        painterOf(mesh, field, rangeOf(field), mapOf(field));
    mesh.shown = findVisible(mesh);
    mesh.cap.begin(0);
    mesh.cap.end();
    if (mesh.content === 'points') {
        fillPoints(mesh.solid, mesh, paint);
    } else {
        fillFacets(mesh.solid, mesh, findDrawn(mesh, state.explode > 0), paint, state.explode);
        if (state.cut === 'plain' && mesh.content !== 'surface')
            fillSection(mesh.cap, mesh, sectionOf(mesh), paint);
    }
    updateGhost(mesh);
    updateMark(mesh);
    updateLines(mesh);
}

function updateGhost(mesh) {
    const wanted = state.ghost && mesh.content !== 'points' &&
        (mesh.shown < mesh.elements || state.cut === 'plain') && state.explode === 0;
    if (wanted && !mesh.hasGhost) {
        fillFacets(mesh.ghost, mesh, boundaryOf(mesh),
                   (f, e, v, to, at) => to.set(OUTSIDE, at), 0);
        mesh.hasGhost = true;
    }
    mesh.ghost.object.visible = wanted && mesh.ghost.count > 0;
}

/* The picked element, through what is before it. */
function updateMark(mesh) {
    const e = mesh.picked, cell = e >= 0 && mesh.facets > 0 && cellFacets(mesh);
    mesh.mark.begin(0);
    if (cell) {
        const facet = Array.from(cell.facet.subarray(cell.start[e], cell.start[e + 1]));
        fillFacets(mesh.mark, mesh, {facet, element: facet.map(() => e), count: facet.length},
                   (f, e2, v, to, at) => to.set([255, 60, 130], at), state.explode);
    } else {
        mesh.mark.end();
    }
}

function setUniforms(mesh) {
    const colour = new THREE.Color(themeColour('--line'));
    const [a, b, c] = state.normal;
    for (const t of [mesh.solid, mesh.cap, mesh.ghost, mesh.mark]) {
        const {uniforms} = t.object.material;
        uniforms.edges.value = state.edges || t === mesh.ghost || t === mesh.mark ? 1 : 0;
        uniforms.edgeColour.value = t === mesh.ghost ? new THREE.Color(themeColour('--ghost')) :
            t === mesh.mark ? new THREE.Color(0xff3c82) : colour;
        uniforms.clips.value = state.cut === 'plain' && t === mesh.solid ? 1 : 0;
        uniforms.plane.value.set(a, b, c, state.offset);
        uniforms.pointSize.value = t.points
            ? Math.max(2, Math.min(9, 700 / Math.cbrt(mesh.elements + 1))) * devicePixelRatio : 0;
        uniforms.edgeWidth.value = (t === mesh.mark ? 1.2 : 0.55) * Math.min(devicePixelRatio, 2);
    }
    mesh.mark.object.material.uniforms.fill.value = 0.35;
}

function themeColour(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function makeRenderer(canvas) {
    const context = canvas.getContext('webgl2', {antialias: true, alpha: false});
    if (!context)
        throw new Error('This browser draws no WebGL 2.');
    const renderer = new THREE.WebGLRenderer({canvas, context});
    renderer.autoClear = false;
    renderer.localClippingEnabled = true;
    return renderer;
}

/* [{mesh, x, width}]: the meshes that are drawn, and where on the canvas, in its pixels. */
function panes() {
    const width = view.canvas.clientWidth, both = state.show === 'both';
    if (view.meshes.length === 1 || !both)
        return [{mesh: view.meshes[state.show === 'b' ? 1 : 0] || view.meshes[0], x: 0, width}];
    return view.meshes.map((mesh, i) => ({mesh, x: i * width / 2, width: width / 2}));
}

/* Draws at once. */
function drawNow() {
    view.wanted = false;
    const {renderer, canvas} = view, height = canvas.clientHeight;
    const ratio = Math.min(devicePixelRatio, 2);
    if (renderer.getPixelRatio() !== ratio)
        renderer.setPixelRatio(ratio);
    renderer.setSize(canvas.clientWidth, height, false);
    renderer.setClearColor(new THREE.Color(themeColour('--back')), 1);
    renderer.setScissorTest(false);
    renderer.clear();
    renderer.setScissorTest(true);
    for (const pane of panes()) {
        renderer.setViewport(pane.x, 0, pane.width, height);
        renderer.setScissor(pane.x, 0, pane.width, height);
        setUniforms(pane.mesh);
        renderer.render(pane.mesh.scene, cameraOf(pane.width / height));
    }
    view.frames++;
}

/* Draws before the next frame. */
function draw() {
    if (!view.wanted) {
        view.wanted = true;
        requestAnimationFrame(() => view.wanted && drawNow());
    }
}

/* Makes anew what is drawn, at the next frame at the latest. */
function update() {
    if (view.stale)
        return;
    view.stale = true;
    requestAnimationFrame(updateNow);
}

function updateNow() {
    const from = performance.now();
    view.stale = false;
    for (const {mesh} of panes())
        updateMesh(mesh);
    view.updateTime = performance.now() - from;
    showCounts();
    drawNow();
}
