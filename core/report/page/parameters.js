// The presets' parameters side by side, and what each preset says of itself.

const parameters = (() => {
  const state = {all: report.presets.length === 1, singled: false};
  const stagesOf = (preset) => preset.preset.stages;

  /** Rows "stage.key" in the order of the presets' stages; each key after those that precede it in its stage. */
  function rows() {
    const stages = new Map();
    for (const preset of report.presets)
      for (const stage of stagesOf(preset)) {
        if (!stages.has(stage.id)) stages.set(stage.id, []);
        const keys = stages.get(stage.id);
        let place = 0;
        for (const key of Object.keys(stage).filter((name) => name !== 'id')) {
          const at = keys.indexOf(key);
          if (at >= 0) place = at + 1;
          else keys.splice(place++, 0, key);
        }
      }
    return [...stages].map(([id, keys]) => ({id, rows: keys.map((key) => ({id, key}))}));
  }

  const valueOf = (preset, row) => stagesOf(preset).find((stage) => stage.id === row.id)?.[row.key];
  const docOf = (presets, row) => {
    const method = presets.map((preset) => stagesOf(preset).find((stage) => stage.id === row.id)?.method).find((m) => report.docs[m]?.[row.key]);
    return method ? report.docs[method][row.key] : row.key === 'method' ? 'which algorithm the stage is' : '';
  };
  const textOf = (value) => (value === undefined ? '–' : value === '' ? 'empty' : value === true ? 'yes' : value === false ? 'no' : String(value));

  /** The value that more of the presets have than any other, if there is one. */
  function commonest(texts) {
    const counts = new Map();
    for (const text of texts.filter((t) => t !== '–')) counts.set(text, (counts.get(text) ?? 0) + 1);
    const [first, second] = [...counts].sort((a, b) => b[1] - a[1]);
    return first && first[1] > (second ? second[1] : 1) ? first[0] : null;
  }

  function columnsShown() {
    return state.singled && focus.pinned.size > 0 ? report.presets.filter((preset) => focus.pinned.has(preset.index)) : report.presets;
  }

  function rowOf(row, presets) {
    const texts = presets.map((preset) => textOf(valueOf(preset, row))), usual = commonest(texts);
    const cells = texts.map((text) => el('td', {class: text === '–' ? 'none' : usual !== null && text !== usual && presets.length > 2 ? 'unusual' : null}, text));
    return el('tr', {class: new Set(texts).size > 1 ? 'differs' : 'same'}, el('th', {scope: 'row', title: docOf(presets, row)}, row.key), cells);
  }

  function draw() {
    const presets = columnsShown(), root = byId('parameters-table');
    const bodies = [];
    for (const stage of rows()) {
      const lines = stage.rows.map((row) => rowOf(row, presets)).filter((line) => state.all || line.classList.contains('differs'));
      if (lines.length > 0)
        bodies.push(el('tbody', {}, el('tr', {class: 'stage-row'}, el('th', {scope: 'rowgroup', colspan: presets.length + 1}, el('span', {}, stage.id))), lines));
    }
    if (bodies.length === 0) {
      root.replaceChildren(el('p', {class: 'empty'}, 'These presets have the same parameters.'));
      return;
    }
    const heads = presets.map((preset) => el('th', {scope: 'col', title: preset.name}, el('span', {class: 'head'}, glyph(preset.index), el('span', {}, preset.name))));
    root.replaceChildren(el('table', {class: presets.length > 6 ? 'parameters many' : 'parameters'},
      el('thead', {}, el('tr', {}, el('th', {scope: 'col'}, 'parameter'), heads)), bodies));
  }

  function descriptions() {
    return report.presets.map((preset) => {
      const text = preset.preset.description || 'No description.';
      const first = text.match(/^.*?[.!?](?=\s|$)/s)?.[0] ?? text, rest = text.slice(first.length).trim();
      const name = el('h3', {}, glyph(preset.index), preset.name);
      const stages = el('p', {class: 'stages'}, stagesOf(preset).map((stage) => `${stage.id}: ${stage.method}`).join(' · ') || 'no stages');
      const more = rest ? el('details', {}, el('summary', {}, 'What is known and what is assumed'), el('p', {}, rest)) : null;
      return el('article', {}, name, el('p', {}, first), more, stages);
    });
  }

  function start() {
    const bar = byId('parameters-bar');
    if (report.presets.length > 1)
      bar.append(toggleButton('Equal ones too', 'parameters-all', false, (on) => { state.all = on; draw(); }));
    if (report.presets.length > 2)
      bar.append(toggleButton('Only singled-out presets', 'parameters-singled', false, (on) => { state.singled = on; draw(); }));
    if (report.presets.length > 2) bar.append(el('span', {class: 'hint'}, 'Bold differs from what most have.'));
    focus.listeners.push(() => { if (state.singled && focus.hovered === null) draw(); });
    byId('presets-list').append(...descriptions());
    draw();
  }
  return {start};
})();
