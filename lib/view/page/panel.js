/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The panel: what it says and what it does. Text goes in as text. */

function byId(id) {
    return document.getElementById(id);
}

function thousands(n) {
    return String(n).replace(/\B(?=(\d{3})+$)/g, '\u202f');
}

function say(message) {
    byId('message').textContent = message;
    clearTimeout(view.messageTimer);
    const while_ = 2500;
    if (message)
        view.messageTimer = setTimeout(() => say(''), while_);
}

/* Once ------------------------------------------------------------------------------- */

function fillPanel() {
    byId('title').textContent = header.title;
    byId('both').hidden = view.meshes.length < 2;
    const names = document.querySelectorAll('[data-show]');
    view.meshes.forEach((mesh, i) => {
        names[i].textContent = mesh.name || names[i].textContent;
    });
    const fields = byId('field');
    for (const f of view.fields.values())
        fields.append(new Option(f.label, f.key));
    const maps = byId('map');
    maps.append(new Option('usual colours', ''));
    for (const name of Object.keys(MAPS))
        maps.append(new Option(name, name));
    const notes = view.meshes.filter(m => m.head.shown < m.head.elements).map(
        m => `Of ${thousands(m.head.elements)} elements of ${m.name} this page holds ` +
            `${thousands(m.head.shown)}: those at the boundary and the worst hundredth.`);
    byId('note').textContent = notes.join(' ');
    byId('note').hidden = notes.length === 0;
    for (const mesh of view.meshes)
        for (const line of mesh.head.history) {
            const item = document.createElement('li');
            item.textContent = line;
            byId('history').append(item);
        }
    byId('history').parentElement.hidden = byId('history').children.length === 0;
    const solid = view.meshes.some(m => m.content !== 'points' && m.content !== 'surface');
    document.querySelector('[data-cut=plain]').hidden = !solid;
    byId('peeling').hidden = !solid;
    byId('exploding').hidden = !solid;
    for (const id of ['offset'])
        Object.assign(byId(id), {min: -view.reach, max: view.reach});
}

function on(id, event, what) {
    byId(id).addEventListener(event, what);
}

function onEach(attribute, what) {
    for (const button of document.querySelectorAll(`[data-${attribute}]`))
        button.addEventListener('click', () => what(button.dataset[attribute]));
}

function listenToPanel() {
    on('field', 'change', () => setField(byId('field').value));
    on('map', 'change', () => set({map: byId('map').value}));
    for (const id of ['from', 'to'])
        on(id, 'change', () => {
            const [low, high] = selectionNow();
            const number = part => byId(part).value === '' ? NaN : Number(byId(part).value);
            const from = number('from'), to = number('to');
            select(Number.isNaN(from) ? low : from, Number.isNaN(to) ? high : to);
        });
    on('worst', 'click', () => selectWorst(100));
    on('all', 'click', selectAll);
    on('range', 'click', () => set({range: state.range ? null : selectionNow()}));
    onEach('cut', setCut);
    onEach('normal', text => setNormal(text.split(',').map(Number)));
    onEach('look', lookFrom);
    onEach('show', show => set({show}));
    on('offset', 'input', () => setOffset(Number(byId('offset').value)));
    for (const id of ['turn', 'lift'])
        on(id, 'input', () => {
            const [turn, lift] = ['turn', 'lift'].map(i => Number(byId(i).value) * Math.PI / 180);
            setNormal([Math.cos(lift) * Math.cos(turn), Math.cos(lift) * Math.sin(turn),
                       Math.sin(lift)]);
        });
    on('facing', 'click', () => setNormal(frameOf(state.camera).back));
    on('flip', 'click', flip);
    on('peel', 'input', () => set({peel: Number(byId('peel').value)}));
    on('explode', 'input', () => setExplode(Number(byId('explode').value)));
    on('edges', 'change', () => set({edges: byId('edges').checked}));
    on('ghost', 'change', () => set({ghost: byId('ghost').checked}));
    on('lines', 'change', () => set({lines: byId('lines').checked}));
    on('fit', 'click', fit);
    on('hide', 'click', hidePicked);
    on('leave', 'click', () => pick(null, -1));
    on('unhide', 'click', unhide);
    on('link', 'click', copyLink);
    on('save', 'click', savePicture);
    on('help', 'click', () => byId('sheet').showModal());
    on('fold', 'click', () => {
        const folded = byId('panel').classList.toggle('folded');
        byId('fold').setAttribute('aria-expanded', String(!folded));
        draw();
    });
}

/* Changes parts of the state. */
function set(parts) {
    Object.assign(state, parts);
    changed();
    refresh();
}

function flip() {
    state.offset = -state.offset;
    setNormal(state.normal.map(x => 0 - x));
}

function hidePicked() {
    for (const mesh of view.meshes) {
        if (mesh.picked < 0)
            continue;
        mesh.hidden[mesh.picked] = 1;
        mesh.hides = true;
    }
    pick(null, -1);
    refresh();
}

function unhide() {
    for (const mesh of view.meshes) {
        mesh.hidden.fill(0);
        mesh.hides = false;
    }
    refresh();
}

async function copyLink() {
    writeHash();
    try {
        await navigator.clipboard.writeText(location.href);
        say('The link is in the clipboard.');
    } catch (error) {
        say('The address of this page is the link.');
    }
}

/* What is on the canvas now, as a file. */
function savePicture() {
    drawNow();
    byId('canvas').toBlob(blob => {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(blob);
        link.download = (header.title || 'mesh').replace(/[^\w.-]+/g, '_') + '.png';
        link.click();
        URL.revokeObjectURL(link.href);
    });
}

/* By the state ----------------------------------------------------------------------- */

function selectionNow() {
    return state.select || rangeOf(view.fields.get(state.field));
}

function press(selector, attribute, value) {
    for (const button of document.querySelectorAll(selector))
        button.setAttribute('aria-pressed', String(button.dataset[attribute] === value));
}

function showState() {
    const field = view.fields.get(state.field), [low, high] = rangeOf(field);
    byId('field').value = state.field;
    byId('map').value = state.map;
    byId('map').hidden = Boolean(field.categories) || field.of === 'nothing';
    byId('low').textContent = words(low) + field.unit;
    byId('middle').textContent = words((low + high) / 2) + field.unit;
    byId('high').textContent = words(high) + field.unit;
    const chosen = selectionNow();
    for (const [id, value] of [['from', chosen[0]], ['to', chosen[1]]])
        if (document.activeElement !== byId(id))
            byId(id).value = state.worst > 0 ? '' : round(value);
    byId('worst').setAttribute('aria-pressed', String(state.worst > 0));
    byId('all').setAttribute('aria-pressed', String(state.worst === 0 && !state.select));
    byId('range').setAttribute('aria-pressed', String(Boolean(state.range)));
    press('[data-cut]', 'cut', state.cut);
    press('[data-show]', 'show', state.show);
    press('[data-normal]', 'normal', state.normal.join(','));
    byId('cutting').hidden = state.cut === 'none';
    byId('offset').value = state.offset;
    const [a, b, c] = state.normal;
    if (document.activeElement !== byId('turn') && Math.hypot(a, b) > 1e-9)
        byId('turn').value = Math.atan2(b, a) * 180 / Math.PI;
    byId('lift').value = Math.asin(Math.max(-1, Math.min(1, c))) * 180 / Math.PI;
    byId('peel').value = state.peel;
    byId('peeled').textContent = String(state.peel);
    byId('explode').value = state.explode;
    byId('edges').checked = state.edges;
    byId('ghost').checked = state.ghost;
    byId('lines').checked = state.lines;
    byId('unhide').hidden = !view.meshes.some(m => m.hides);
    showLacking(field);
    showCategories(field);
    drawHistogram();
}

/* Of two meshes one may have no such field. */
function showLacking(field) {
    const lacking = view.meshes.filter(m => !m.fields.some(f => f.key === field.key));
    byId('lacking').hidden = lacking.length === 0;
    byId('lacking').textContent = lacking.map(
        m => `${m.name} has no ${field.label}: it has the colours of outside and inside.`).join(' ');
}

/* The line of a legend: the parts behind what switches it. */
function legendOf({colour, name, count}) {
    const swatch = document.createElement('i'), text = document.createElement('span');
    const number = document.createElement('small');
    swatch.style.background = `rgb(${colour})`;
    text.textContent = name;
    number.textContent = thousands(count);
    return [swatch, text, number];
}

/* The legend of a category; its values can be switched off. */
function showCategories(field) {
    const list = byId('categories'), key = field.key + ' ' + [...state.off];
    list.hidden = !field.categories;
    if (!field.categories || list.dataset.key === key)
        return;
    list.dataset.key = key;
    list.replaceChildren(...field.categories.map(category => {
        const item = document.createElement('li'), label = document.createElement('label');
        const box = document.createElement('input');
        box.type = 'checkbox';
        box.checked = !state.off.has(category.value);
        box.hidden = field.of !== 'element';
        box.addEventListener('change', () => {
            if (box.checked)
                state.off.delete(category.value);
            else
                state.off.add(category.value);
            changed();
            refresh();
        });
        label.append(box, ...legendOf(category));
        item.append(label);
        return item;
    }));
}

const ONE_OF = {points: 'point', triangles: 'triangle', tetrahedra: 'tetrahedron',
                pyramids: 'pyramid', wedges: 'wedge', hexahedra: 'hexahedron',
                polyhedra: 'polyhedron'};

/* How many elements of each kind there are, and how many are shown. */
function showCounts() {
    const all = panes().map(({mesh}) => {
        const kinds = Object.entries(mesh.head.kinds).map(
            ([kind, n]) => `${thousands(n)} ${n === 1 ? ONE_OF[kind] : kind}`);
        const part = mesh.shown < mesh.elements ? `; ${thousands(mesh.shown)} shown` : '';
        const nodes = mesh.content === 'points' ? '' : `, ${thousands(mesh.nodes)} nodes`;
        return kinds.join(', ') + nodes + part;
    });
    byId('counts').textContent = all.join(' | ');
    const shown = panes(), width = byId('canvas').clientWidth;
    byId('labels').replaceChildren(...(view.meshes.length < 2 ? [] : shown).map(pane => {
        const label = document.createElement('span');
        label.textContent = pane.mesh.name;
        label.style.left = (pane.x + pane.width / 2) / width * 100 + '%';
        return label;
    }));
    byId('canvas').dataset.shown = shown.map(({mesh}) => mesh.shown).join(' ');
}

function showPicked(mesh, e) {
    byId('picked').hidden = !mesh;
    byId('words').replaceChildren(...(mesh ? wordsOf(mesh, e) : []).map(([name, value]) => {
        const row = document.createElement('tr'), head = document.createElement('th');
        const cell = document.createElement('td');
        head.scope = 'row';
        head.textContent = name;
        cell.textContent = value;
        row.append(head, cell);
        return row;
    }));
    if (mesh)
        byId('picked').scrollIntoView({block: 'nearest'});
}
