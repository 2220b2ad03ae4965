/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keyboard. */

const KEYS = [
    {keys: ['?'], what: 'this sheet', run: () => byId('sheet').showModal()},
    {keys: ['Home', '0'], what: 'all of it', run: fit},
    {keys: ['x', 'y', 'z'], what: 'look along an axis; with Shift from the other side',
     run: key => lookFrom(key)},
    {keys: ['X', 'Y', 'Z'], run: key => lookFrom('-' + key.toLowerCase())},
    {keys: ['i'], what: 'look from a corner', run: () => lookFrom('iso')},
    {keys: ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'], what: 'turn', run: key => {
        const step = 30;
        orbit(key === 'ArrowLeft' ? step : key === 'ArrowRight' ? -step : 0,
              key === 'ArrowUp' ? step : key === 'ArrowDown' ? -step : 0);
    }},
    {keys: ['+', '-'], what: 'closer, farther',
     run: key => zoom(key === '+' ? 0.85 : 1 / 0.85, 0, 0, panes()[0])},
    {keys: ['c'], what: 'cut by whole elements, or not',
     run: () => setCut(state.cut === 'whole' ? 'none' : 'whole')},
    {keys: ['s'], what: 'plain section, or not',
     run: () => setCut(state.cut === 'plain' ? 'none' : 'plain')},
    {keys: ['[', ']'], what: 'move the plane',
     run: key => setOffset(state.offset + (key === '[' ? -1 : 1) * view.reach / 50)},
    {keys: ['v'], what: 'the plane faces the eye', run: () => setNormal(frameOf(state.camera).back)},
    {keys: ['f'], what: 'the other side of the plane', run: flip},
    {keys: ['<', '>'], what: 'peel a layer less, more',
     run: key => set({peel: Math.max(0, Math.min(view.layers(), state.peel + (key === '<' ? -1 : 1)))})},
    {keys: ['('], run: () => setExplode(state.explode - 0.1)},
    {keys: [')'], what: 'pull elements apart; with ( together',
     run: () => setExplode(state.explode + 0.1)},
    {keys: ['n'], what: 'colour by the next thing', run: () => {
        const keys = [...view.fields.keys()];
        setField(keys[(keys.indexOf(state.field) + 1) % keys.length]);
    }},
    {keys: ['w'], what: 'the worst 100', run: () => selectWorst(state.worst > 0 ? 0 : 100)},
    {keys: ['a'], what: 'all elements', run: selectAll},
    {keys: ['e'], what: 'edges', run: () => set({edges: !state.edges})},
    {keys: ['g'], what: 'ghost of the rest', run: () => set({ghost: !state.ghost})},
    {keys: ['m'], what: 'marked edges', run: () => set({lines: !state.lines})},
    {keys: ['b'], what: 'the other mesh; with Shift both', run: () => nextMesh(['a', 'b'])},
    {keys: ['B'], run: () => nextMesh(['a', 'both'])},
    {keys: ['h'], what: 'hide what is picked', run: hidePicked},
    {keys: ['u'], what: 'show what was hidden', run: unhide},
    {keys: ['l'], what: 'copy a link', run: copyLink},
    {keys: ['p'], what: 'save a picture', run: savePicture},
    {keys: ['Escape'], what: 'pick nothing', run: () => pick(null, -1)},
];
const POINTERS = [
    ['drag', 'turn'], ['right button, or Ctrl and drag; two fingers', 'move'],
    ['wheel; two fingers', 'zoom to the pointer'], ['click', 'pick an element'],
    ['double click', 'all of it'], ['Shift and drag', 'move the plane'],
    ['Alt and drag', 'turn the plane'],
];

function nextMesh(shows) {
    if (view.meshes.length > 1)
        set({show: state.show === shows[1] ? shows[0] : shows[1]});
}

function fillSheet() {
    const short = {ArrowLeft: '←', ArrowRight: '→', ArrowUp: '↑', ArrowDown: '↓'};
    const rows = KEYS.filter(k => k.what).map(({keys, what}) => {
        const head = document.createElement('th');
        for (const key of keys) {
            const kbd = document.createElement('kbd');
            kbd.textContent = short[key] || key;
            head.append(kbd, ' ');
        }
        return [head, what];
    });
    for (const [pointer, what] of POINTERS) {
        const head = document.createElement('th');
        head.textContent = pointer;
        head.style.whiteSpace = 'normal';
        rows.push([head, what]);
    }
    byId('keys').replaceChildren(...rows.map(([head, what]) => {
        const row = document.createElement('tr'), cell = document.createElement('td');
        head.scope = 'row';
        cell.textContent = what;
        row.append(head, cell);
        return row;
    }));
}

function listenToKeys() {
    document.addEventListener('keydown', event => {
        const {target} = event;
        if (event.ctrlKey || event.metaKey || event.altKey || byId('sheet').open ||
            target.matches('select, input[type=number]') ||
            (target.matches('input') && event.key.startsWith('Arrow')))
            return;
        const key = KEYS.find(k => k.keys.includes(event.key));
        if (!key)
            return;
        event.preventDefault();
        key.run(event.key);
    });
}
