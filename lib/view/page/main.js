/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What happens when the page is opened. `meshView` is for the console of the browser, and
 * for tests. */

/* three.js is a script that is put in when it is inflated; it is THREE. */
async function loadThree() {
    const bytes = await inflate('three'), script = document.createElement('script');
    script.textContent = new TextDecoder().decode(bytes);
    document.head.append(script);
}

/* Where the nodes of all meshes are: a ball around them, in which the plane moves. */
function findPlace() {
    const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity];
    for (const {xyz} of view.meshes)
        for (let i = 0; i < xyz.length; i++) {
            const a = i % 3;
            if (xyz[i] < least[a])
                least[a] = xyz[i];
            if (xyz[i] > most[a])
                most[a] = xyz[i];
        }
    view.middle = least.map((x, a) => (x + most[a]) / 2);
    view.radius = Math.hypot(...least.map((x, a) => most[a] - x)) / 2 || 1;
    view.reach = view.radius * 1.02;
    view.layers = () => Math.max(...view.meshes.map(m => layersOf(m).most));
}

/* Quality first, where there is one; of polyhedra and mixed elements, too. */
function chooseField() {
    const quality = [...view.fields.values()].find(f => f.quality);
    state.field = quality ? quality.key : 'plain';
}

/* Follows a hash that somebody else has set. */
function followHash() {
    if (location.hash === view.hash)
        return;
    readHash(location.hash);
    refresh();
}

async function start() {
    await pause();
    await loadThree();
    for (const head of header.meshes)
        view.meshes.push(await readMesh(head));
    for (const mesh of view.meshes) {
        addOwnFields(mesh);
        mesh.picked = -1;
    }
    view.fields = joinFields(view.meshes);
    findPlace();
    view.canvas = byId('canvas');
    byId('panel').hidden = false;
    view.renderer = makeRenderer(view.canvas);
    view.camera = new THREE.PerspectiveCamera();
    view.meshes.forEach(makeScene);
    const lines = edgeGroups(view.meshes);
    for (const mesh of view.meshes)
        makeLines(mesh, lines);
    state.lines = view.linesFirst = areTold(lines);
    chooseField();
    state.show = view.meshes.length > 1 ? 'both' : 'a';
    state.camera.distance = fittingDistance();
    state.camera.target = [...view.middle];
    readHash(location.hash);
    fillPanel();
    listLines(lines);
    fillSheet();
    listenToPanel();
    listenToKeys();
    listenToPointers(view.canvas);
    listenToHistogram(byId('histogram'));
    window.addEventListener('hashchange', followHash);
    new ResizeObserver(() => { drawNow(); drawHistogram(); }).observe(view.canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
        drawHistogram();
        draw();
    });
    showState();
    updateNow();
    say('');
    view.loadTime = performance.now();
    byId('canvas').dataset.ready = 'true';
    await pause();
    showLayers();
}

/* The slider of layers, when they are known: that can wait. */
function showLayers() {
    setTimeout(() => {
        byId('peel').max = view.layers();
        byId('peeling').hidden = byId('peeling').hidden || view.layers() === 0;
    }, 50);
}

/* The pixels, in the page, of the centre of an element. */
function pixelsOf(i, e) {
    const pane = panes().find(p => p.mesh === view.meshes[i]);
    const box = view.canvas.getBoundingClientRect(), {mesh} = pane;
    const camera = cameraOf(pane.width / view.canvas.clientHeight);
    const p = new THREE.Vector3(...[0, 1, 2].map(
        a => mesh.centroid[3 * e + a] * (1 + state.explode))).project(camera);
    return [box.left + pane.x + (p.x + 1) / 2 * pane.width,
            box.top + (1 - p.y) / 2 * view.canvas.clientHeight];
}

window.meshView = {
    ready: start().catch(error => {
        byId('message').textContent = String(error.message || error);
        throw error;
    }),
    state, view, set, setField, setCut, setNormal, setOffset, select, selectWorst, selectAll,
    setExplode, lookFrom, fit, pick, update: updateNow, pixelsOf, elementAt, hashOfState,
    /* The numbers, in the stream, of the elements that are shown of mesh i. */
    shown: i => {
        const mesh = view.meshes[i], list = [];
        for (let e = 0; e < mesh.elements; e++)
            if (mesh.visible[e])
                list.push(numberOf(mesh, e));
        return list;
    },
};
