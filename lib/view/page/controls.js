/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The camera, and how pointers move it: it looks at `target` from `distance` away, turned
 * by `turn` around z and lifted by `lift`. */

const FIELD_OF_VIEW = 35;

function eyeOf(camera) {
    const {turn, lift, distance, target} = camera;
    return [target[0] + distance * Math.cos(lift) * Math.cos(turn),
            target[1] + distance * Math.cos(lift) * Math.sin(turn),
            target[2] + distance * Math.sin(lift)];
}

/* To the right and up in the picture, and towards the eye. */
function frameOf(camera) {
    const {turn, lift} = camera;
    return {right: [-Math.sin(turn), Math.cos(turn), 0],
            up: [-Math.sin(lift) * Math.cos(turn), -Math.sin(lift) * Math.sin(turn),
                 Math.cos(lift)],
            back: [Math.cos(lift) * Math.cos(turn), Math.cos(lift) * Math.sin(turn),
                   Math.sin(lift)]};
}

function cameraOf(aspect) {
    const camera = state.camera, eye = eyeOf(camera), {right, up, back} = frameOf(camera);
    /* In a narrow picture the width has the angle of view. */
    const angle = aspect >= 1 ? FIELD_OF_VIEW
        : 2 * Math.atan(Math.tan(FIELD_OF_VIEW * Math.PI / 360) / aspect) * 180 / Math.PI;
    const far = camera.distance + 2 * view.radius * (1 + state.explode);
    const near = Math.max(camera.distance - 2 * view.radius * (1 + state.explode), far / 5000);
    const three = view.camera;
    three.fov = angle;
    three.aspect = aspect;
    three.near = near;
    three.far = far;
    three.updateProjectionMatrix();
    three.matrixAutoUpdate = false;
    three.matrix.set(right[0], up[0], back[0], eye[0], right[1], up[1], back[1], eye[1],
                     right[2], up[2], back[2], eye[2], 0, 0, 0, 1);
    three.updateMatrixWorld(true);
    return three;
}

/* How long what is a pixel at the target is. */
function pixelLength(pane) {
    const height = view.canvas.clientHeight, least = Math.min(pane.width, height);
    return 2 * state.camera.distance * Math.tan(FIELD_OF_VIEW * Math.PI / 360) / least;
}

/* From where all is seen that is not exploded. */
function fittingDistance() {
    return 1.12 * view.radius / Math.sin(FIELD_OF_VIEW * Math.PI / 360);
}

function fit() {
    state.camera.target = [...view.middle];
    state.camera.distance = fittingDistance() * (1 + state.explode);
    changed();
    draw();
}

const QUARTER = Math.PI / 2;
const VIEWS = {x: [0, 0], y: [QUARTER, 0], z: [-QUARTER, QUARTER], '-x': [Math.PI, 0],
               '-y': [-QUARTER, 0], '-z': [-QUARTER, -QUARTER], iso: [-0.9, 0.5]};

function lookFrom(name) {
    [state.camera.turn, state.camera.lift] = VIEWS[name];
    fit();
}

function orbit(dx, dy) {
    const {camera} = state, speed = 0.008;
    camera.turn -= dx * speed;
    camera.lift = Math.max(-QUARTER, Math.min(QUARTER, camera.lift + dy * speed));
    changed();
    draw();
}

function pan(dx, dy, pane) {
    const {right, up} = frameOf(state.camera), length = pixelLength(pane);
    state.camera.target = state.camera.target.map(
        (x, a) => x - length * (dx * right[a] - dy * up[a]));
    changed();
    draw();
}

/* What is under the pointer stays there. x and y are pixels from the middle of the pane. */
function zoom(factor, x, y, pane) {
    const before = pixelLength(pane), {right, up} = frameOf(state.camera);
    const least = 0.002 * view.radius, most = 40 * view.radius;
    state.camera.distance = Math.max(least, Math.min(most, state.camera.distance * factor));
    const gained = before - pixelLength(pane);
    state.camera.target = state.camera.target.map(
        (c, a) => c + gained * (x * right[a] - y * up[a]));
    changed();
    draw();
}

/* Shift: along its normal; Alt: turned. */
function dragPlane(dx, dy, turned, pane) {
    const {right, up} = frameOf(state.camera);
    if (state.cut === 'none')
        setCut('whole');
    if (turned) {
        const speed = 0.006;
        const moved = state.normal.map((n, a) => n + speed * (dx * right[a] - dy * up[a]));
        setNormal(moved);
        return;
    }
    const along = [dotOf(state.normal, right), -dotOf(state.normal, up)];
    const size = Math.hypot(...along);
    const pixels = size > 0.15 ? (dx * along[0] + dy * along[1]) / size : -dy;
    setOffset(state.offset + pixels * pixelLength(pane));
}

function paneAt(x) {
    const all = panes();
    return all.find(p => x < p.x + p.width) || all[all.length - 1];
}

function listenToPointers(canvas) {
    const down = new Map();
    let moved = 0;
    const place = event => {
        const box = canvas.getBoundingClientRect();
        return {x: event.clientX - box.left, y: event.clientY - box.top};
    };
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    canvas.addEventListener('pointerdown', event => {
        canvas.setPointerCapture(event.pointerId);
        down.set(event.pointerId, place(event));
        if (down.size === 1)
            moved = 0;
    });
    canvas.addEventListener('pointermove', event => {
        const before = down.get(event.pointerId);
        if (!before)
            return;
        const now = place(event), dx = now.x - before.x, dy = now.y - before.y;
        const pane = paneAt(before.x);
        moved += Math.abs(dx) + Math.abs(dy);
        if (down.size === 2)
            pinch(down, event.pointerId, now, pane);
        else if (event.shiftKey || event.altKey)
            dragPlane(dx, dy, event.altKey, pane);
        else if (event.buttons & 6 || event.ctrlKey)
            pan(dx, dy, pane);
        else
            orbit(dx, dy);
        down.set(event.pointerId, now);
    });
    const up = event => {
        const few = 5;
        if (down.delete(event.pointerId) && down.size === 0 && moved < few &&
            event.type === 'pointerup')
            pickAt(place(event).x, place(event).y);
    };
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('wheel', event => {
        event.preventDefault();
        const {x, y} = place(event), pane = paneAt(x);
        const lines = event.deltaMode === 1 ? 30 : 1;
        zoom(Math.exp(0.0015 * lines * event.deltaY), x - pane.x - pane.width / 2,
             y - canvas.clientHeight / 2, pane);
    }, {passive: false});
    canvas.addEventListener('dblclick', fit);
}

/* Two fingers: what is between them moves, and grows with their distance. */
function pinch(down, id, now, pane) {
    const [other] = [...down].filter(([key]) => key !== id).map(([, p]) => p);
    const before = down.get(id);
    const was = Math.hypot(before.x - other.x, before.y - other.y);
    const is = Math.hypot(now.x - other.x, now.y - other.y);
    pan((now.x - before.x) / 2, (now.y - before.y) / 2, pane);
    if (was > 0 && is > 0)
        zoom(was / is, (now.x + other.x) / 2 - pane.x - pane.width / 2,
             (now.y + other.y) / 2 - view.canvas.clientHeight / 2, pane);
}
