/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is shown and how: all of it is in the page's hash, so that a link shows the same. */

const state = {
    field: 'plain',
    range: null,     /* of colours: [low, high]; null: that of the field */
    map: '',         /* '': by the field */
    select: null,    /* [low, high] of the field */
    worst: 0,        /* so many with the least values */
    off: new Set(),  /* values of categories that are not shown */
    cut: 'none',     /* 'whole' elements, or a 'plain' section: below the plane */
    normal: [1, 0, 0],
    offset: 0,
    peel: 0,
    explode: 0,
    edges: true,
    ghost: true,
    lines: false,    /* the edges of the stream */
    show: 'a',       /* of two meshes: 'a', 'b', 'both' */
    camera: {turn: -0.9, lift: 0.5, distance: 4, target: [0, 0, 0]},
};

const view = {meshes: [], fields: new Map(), radius: 1, middle: [0, 0, 0], frames: 0};

function rangeOf(field) {
    if (state.range)
        return state.range;
    return field.least < Infinity ? [field.least, field.most] : [0, 1];
}

function mapOf(field) {
    return state.map || (field.quality ? 'orange to blue' : 'viridis');
}

const round = x => Number(x.toPrecision(6));

function hashOfState() {
    const {camera} = state, parts = ['f=' + encodeURIComponent(state.field)];
    const add = (key, value) => parts.push(key + '=' + value);
    if (state.range)
        add('r', state.range.map(round));
    if (state.map)
        add('m', encodeURIComponent(state.map));
    if (state.worst > 0)
        add('w', state.worst);
    else if (state.select)
        add('s', state.select.map(round));
    if (state.off.size > 0)
        add('h', [...state.off]);
    if (state.cut !== 'none')
        add('k', [state.cut, ...state.normal.map(round), round(state.offset)]);
    if (state.peel > 0)
        add('p', state.peel);
    if (state.explode > 0)
        add('x', round(state.explode));
    if (!state.edges || !state.ghost)
        add('o', (state.edges ? 'e' : '') + (state.ghost ? 'g' : '') || '-');
    if (state.lines !== view.linesFirst)
        add('l', Number(state.lines));
    if (state.show !== 'a')
        add('v', state.show);
    add('c', [camera.turn, camera.lift, camera.distance, ...camera.target].map(round));
    return '#' + parts.join('&');
}

/* Takes from a hash what is right in it. */
function readHash(hash) {
    const numbers = (text, count) => {
        const list = text.split(',').map(Number);
        return list.length === count && list.every(Number.isFinite) ? list : null;
    };
    const take = {
        f: t => { if (view.fields.has(t)) state.field = t; },
        r: t => { state.range = numbers(t, 2); },
        m: t => { if (t in MAPS) state.map = t; },
        w: t => { state.worst = Math.max(0, Math.round(Number(t)) || 0); },
        s: t => { state.select = numbers(t, 2); },
        h: t => { state.off = new Set(t.split(',').map(Number)); },
        k: t => {
            const [cut, ...rest] = t.split(','), plane = numbers(rest.join(), 4);
            if (plane && (cut === 'whole' || cut === 'plain') && Math.hypot(...plane.slice(0, 3)) > 0) {
                state.cut = cut;
                state.normal = unitOf(plane.slice(0, 3));
                state.offset = plane[3];
            }
        },
        p: t => { state.peel = Math.max(0, Math.round(Number(t)) || 0); },
        x: t => { state.explode = Math.max(0, Math.min(3, Number(t) || 0)); },
        o: t => {
            state.edges = t.includes('e');
            state.ghost = t.includes('g');
        },
        l: t => { state.lines = t === '1'; },
        v: t => { if (view.meshes.length > 1 && ['a', 'b', 'both'].includes(t)) state.show = t; },
        c: t => {
            const c = numbers(t, 6);
            if (c && c[2] > 0)
                state.camera = {turn: c[0], lift: c[1], distance: c[2], target: c.slice(3)};
        },
    };
    for (const part of hash.replace(/^#/, '').split('&')) {
        const [key, value] = part.split(/=(.*)/);
        if (key in take && value !== undefined) {
            try {
                take[key](decodeURIComponent(value));
            } catch (error) { /* no good %XX: as if it were not there */ }
        }
    }
}

function unitOf(p) {
    const size = Math.hypot(...p);
    return size > 0 ? p.map(x => x / size) : [1, 0, 0];
}

/* The state has changed: the hash follows, when there is time. */
function changed() {
    clearTimeout(view.hashTimer);
    const some = 250;
    view.hashTimer = setTimeout(writeHash, some);
}

function writeHash() {
    clearTimeout(view.hashTimer);
    view.hash = hashOfState();
    history.replaceState(null, '', view.hash);
}

/* Changes by name ---------------------------------------------------------------------- */

function setField(key) {
    state.field = key;
    state.range = null;
    state.select = null;
    state.worst = 0;
    state.off.clear();
    changed();
    refresh();
}

function setCut(cut) {
    state.cut = cut;
    changed();
    refresh();
}

function setNormal(normal) {
    state.normal = unitOf(normal);
    changed();
    refresh();
}

function setOffset(offset) {
    const most = view.reach;
    state.offset = Math.max(-most, Math.min(most, offset));
    changed();
    refresh();
}

/* What is pulled apart is seen from farther away. */
function setExplode(explode) {
    const most = 1.5, now = Math.max(0, Math.min(most, explode));
    state.camera.distance *= (1 + now) / (1 + state.explode);
    state.explode = now;
    changed();
    refresh();
}

function select(low, high) {
    state.worst = 0;
    state.select = [low, high];
    changed();
    refresh();
}

function selectWorst(count) {
    state.select = null;
    state.worst = count;
    changed();
    refresh();
}

function selectAll() {
    state.select = null;
    state.worst = 0;
    changed();
    refresh();
}

/* Shows the state: in the panel, and drawn. */
function refresh() {
    showState();
    update();
}
