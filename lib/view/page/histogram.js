/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The histogram of the field, which selects a range where it is dragged over. */

const BINS = 40;

function countBins(mesh, field) {
    const bins = new Float64Array(BINS), own = mesh.fields.find(f => f.key === field.key);
    const [low, high] = rangeOf(field);
    for (const value of (own && own.means) || []) {
        const at = Math.floor((value - low) / (high - low || 1) * BINS);
        if (at >= 0 && at <= BINS)
            bins[Math.min(at, BINS - 1)]++;
    }
    return bins;
}

/* Bars are as high as the root of what they count, so that a few bad ones are seen; of a
 * second mesh there is an outline. */
function drawHistogram() {
    const field = view.fields.get(state.field), canvas = byId('histogram');
    const scale = field.of !== 'nothing' && field.of !== 'facet' && !field.categories;
    byId('scale').hidden = !scale;
    byId('selection').hidden = !scale;
    if (!scale)
        return;
    const key = field.key + rangeOf(field);
    if (view.binsOf !== key) {
        view.bins = view.meshes.map(mesh => countBins(mesh, field));
        view.binsOf = key;
    }
    const width = canvas.clientWidth, height = canvas.clientHeight, bar = width / BINS;
    canvas.width = width * devicePixelRatio;
    canvas.height = height * devicePixelRatio;
    const ink = canvas.getContext('2d'), table = tableOf(mapOf(field));
    ink.scale(devicePixelRatio, devicePixelRatio);
    const most = Math.sqrt(Math.max(1, ...view.bins.map(b => Math.max(...b))));
    const tall = n => n > 0 ? Math.max(2, (height - 4) * Math.sqrt(n) / most) : 0;
    const first = state.show === 'b' && view.bins[1] ? 1 : 0;
    view.bins[first].forEach((n, i) => {
        const shade = 3 * Math.floor((i + 0.5) / BINS * SHADES);
        ink.fillStyle = `rgb(${table[shade]},${table[shade + 1]},${table[shade + 2]})`;
        ink.fillRect(i * bar, height - tall(n), bar - 0.5, tall(n));
    });
    ink.strokeStyle = themeColour('--text');
    ink.beginPath();
    if (view.bins[1 - first])
        view.bins[1 - first].forEach((n, i) => {
            ink.lineTo(i * bar, height - tall(n));
            ink.lineTo((i + 1) * bar, height - tall(n));
        });
    ink.stroke();
    showSelection(ink, field, width, height);
}

function showSelection(ink, field, width, height) {
    if (!state.select || state.worst > 0)
        return;
    const [low, high] = rangeOf(field);
    const [a, b] = state.select.map(v => Math.max(0, Math.min(1, (v - low) / (high - low || 1))) * width);
    ink.fillStyle = themeColour('--veil');
    ink.fillRect(0, 0, a, height);
    ink.fillRect(b, 0, width - b, height);
    ink.strokeStyle = themeColour('--accent');
    ink.lineWidth = 2;
    ink.strokeRect(a + 1, 1, Math.max(b - a - 2, 1), height - 2);
}

function listenToHistogram(canvas) {
    let from = null;
    const valueAt = event => {
        const box = canvas.getBoundingClientRect(), [low, high] = rangeOf(view.fields.get(state.field));
        const part = Math.max(0, Math.min(1, (event.clientX - box.left) / box.width));
        return low + part * (high - low);
    };
    canvas.addEventListener('pointerdown', event => {
        canvas.setPointerCapture(event.pointerId);
        from = valueAt(event);
    });
    canvas.addEventListener('pointermove', event => {
        if (from === null)
            return;
        const to = valueAt(event);
        select(Math.min(from, to), Math.max(from, to));
    });
    canvas.addEventListener('pointerup', event => {
        if (from !== null && valueAt(event) === from)
            selectAll();
        from = null;
    });
    canvas.addEventListener('pointercancel', () => { from = null; });
}
