// The table of results: a row per preset.

const results = (() => {
  const keyMetrics = ['psnr', 'ssim', 'ldr_flip', 'hdr_flip', 'flicker_stable', 'ao_rmse', 'ao_correlation', 'ao_bias', 'ao_flicker_stable'];
  const computed = report.metrics.filter((metric) => report.presets.some((preset) => isNumber(preset.scores[metric.name])));
  const hasCost = report.presets.some((preset) => preset.total !== null);
  const hasMemory = report.presets.some((preset) => isNumber(preset.memory_bytes));
  const mostCost = Math.max(0, ...finite(report.presets.map((preset) => preset.total)));
  const few = computed.filter((metric) => keyMetrics.includes(metric.name));
  const costs = finite(report.presets.map((preset) => preset.total)).sort((a, b) => a - b);
  // One preset far dearer than the rest would leave the others no length.
  const uneven = costs.length > 1 && mostCost > 6 * costs[Math.floor((costs.length - 1) / 2)];
  const state = {all: few.length === 0, stages: false, shares: uneven, sort: null, reversed: false};

  /** A column: its heading, what it sorts by (smaller first), and its cell. */
  function metricColumn(metric) {
    const best = Math.min(...report.presets.map((preset) => badness(metric, preset.scores[metric.name])));
    return {
      key: metric.name,
      heading: [titleOf(metric), el('small', {}, [metric.unit, {lower: '↓', higher: '↑', zero: '→0'}[metric.better]].filter(Boolean).join(' '))],
      title: `${metric.doc || titleOf(metric)} – ${direction[metric.better]}`,
      order: (preset) => badness(metric, preset.scores[metric.name]),
      cell: (preset) => {
        const value = preset.scores[metric.name], isBest = report.presets.length > 1 && typeof value === 'number' && badness(metric, value) === best;
        return el('td', {class: isBest ? 'number best' : 'number', title: isBest ? 'the best of all' : null}, formatted(value));
      },
    };
  }

  function costBar(preset) {
    const bar = el('span', {class: 'cost-bar', role: 'img', 'aria-label': preset.cost.map((s) => `${s.stage} ${milliseconds(s.ms)} ms`).join(', ')});
    for (const stage of preset.cost)
      bar.append(el('i', {class: stageHatched(stage.stage) ? 'hatched' : null, title: `${stage.stage} ${milliseconds(stage.ms)} ms`,
        style: `width:${(100 * (stage.ms ?? 0)) / ((state.shares ? preset.total : mostCost) || 1)}%;background-color:${stageColour(stage.stage)}`}));
    return bar;
  }
  const costColumn = () => ({
    key: 'cost', heading: ['cost', el('small', {}, state.shares ? 'ms per frame; shares of the stages' : 'ms per frame')], wide: true,
    title: 'median milliseconds of a frame, all stages; work shared by several presets counts in full for each',
    order: (preset) => preset.total ?? Infinity,
    cell: (preset) => preset.total === null ? el('td', {class: 'number'}, '–')
      : el('td', {class: 'cost'}, el('span', {class: 'number'}, milliseconds(preset.total)), costBar(preset)),
  });
  const stageColumn = (name) => {
    const ms = (preset) => preset.cost?.find((stage) => stage.stage === name)?.ms;
    return {
      key: `stage ${name}`, heading: [name, el('small', {}, 'ms')], title: `median milliseconds of a frame in ${name}`,
      order: (preset) => ms(preset) ?? Infinity, cell: (preset) => el('td', {class: 'number'}, milliseconds(ms(preset))),
    };
  };
  const memoryColumn = {
    key: 'memory', heading: ['memory', el('small', {}, 'at most')], title: 'the most memory that was held for it at once',
    order: (preset) => preset.memory_bytes ?? Infinity, cell: (preset) => el('td', {class: 'number'}, memory(preset.memory_bytes)),
  };
  const nameColumn = {
    key: 'name', heading: ['preset'], title: 'in the order given', order: (preset) => preset.index,
    cell: (preset) => {
      const button = el('button', {type: 'button', class: 'preset-name', title: 'single it out in all charts',
        onclick: () => focus.toggle(preset.index)}, glyph(preset.index), el('span', {}, preset.name));
      return el('th', {scope: 'row'}, button);
    },
  };

  function columns() {
    const out = [nameColumn, ...(state.all ? computed : few).map(metricColumn)];
    if (hasCost) out.push(costColumn());
    if (hasCost && state.stages) out.push(...stageNames.map(stageColumn));
    if (hasMemory) out.push(memoryColumn);
    return out;
  }

  function sortedPresets(column) {
    const sign = state.reversed ? -1 : 1;
    return [...report.presets].sort((a, b) => {
      const x = column.order(a), y = column.order(b);
      if (x === y) return a.index - b.index;
      if (x === Infinity || y === Infinity) return x === Infinity ? 1 : -1;  // what is not known comes last
      return sign * (x - y);
    });
  }

  function headingCell(column, sorted) {
    const sort = () => {
      state.reversed = state.sort === column.key && !state.reversed;
      state.sort = column.key;
      draw();
      byId('results-table').querySelector(`[data-sort="${CSS.escape(column.key)}"]`).focus();
    };
    return el('th', {scope: 'col', class: column.wide ? 'wide' : null,
      'aria-sort': sorted ? (state.reversed ? 'descending' : 'ascending') : null},
    el('button', {type: 'button', class: 'sort', title: column.title, 'data-sort': column.key, onclick: sort}, column.heading));
  }

  function draw() {
    const all = columns(), by = all.find((column) => column.key === state.sort) ?? nameColumn;
    const rows = sortedPresets(by).map((preset) => focusable(el('tr', {}, all.map((column) => column.cell(preset))), preset.index));
    const table = el('table', {class: hasCost ? 'results full' : 'results'},
      el('thead', {}, el('tr', {}, all.map((column) => headingCell(column, column === by)))), el('tbody', {}, rows));
    byId('results-table').replaceChildren(table);
    markFocus();
  }

  function markFocus() {
    const root = byId('results-table');
    for (const row of root.querySelectorAll('tr[data-preset]')) {
      const index = Number(row.dataset.preset);
      row.classList.toggle('pinned', focus.pinned.has(index));
      row.classList.toggle('hovered', focus.hovered === index);
      row.querySelector('.preset-name').setAttribute('aria-pressed', String(focus.pinned.has(index)));
    }
    byId('clear-focus').hidden = focus.pinned.size === 0;
  }

  function stageLegend() {
    if (!hasCost) return [];
    return [el('span', {class: 'legend-title'}, 'Cost by stage'), ...stageNames.map((name) => el('span', {class: 'swatch'},
      el('i', {class: stageHatched(name) ? 'hatched' : null, style: `background-color:${stageColour(name)}`}), name))];
  }

  function start() {
    const bar = byId('results-bar');
    if (few.length > 0 && few.length < computed.length)
      bar.append(segmented('Which metrics', 'results-metrics', [['few', 'Key metrics'], ['all', `All ${computed.length}`]], 'few',
        (choice) => { state.all = choice === 'all'; draw(); }));
    if (hasCost && costs.length > 1)
      bar.append(segmented('Cost bars', 'results-bars', [['scale', 'Bars to scale'], ['shares', 'Shares']], state.shares ? 'shares' : 'scale',
        (choice) => { state.shares = choice === 'shares'; draw(); }));
    if (hasCost) bar.append(toggleButton('Stage times', 'results-stages', false, (on) => { state.stages = on; draw(); }));
    bar.append(el('button', {type: 'button', id: 'clear-focus', class: 'quiet', onclick: () => focus.clear()}, 'Show all alike'));
    if (!hasCost) bar.append(el('span', {class: 'hint'}, 'Cost was not measured.'));
    if (report.presets.length > 1) bar.append(el('span', {class: 'hint'}, 'Bold is best. A preset’s name singles it out below.'));
    const leading = computed.find((metric) => metric.name === leadingMetric());
    state.sort = leading && report.presets.length > 1 ? leading.name : 'name';
    if (leading && !few.includes(leading)) state.all = true;
    byId('stage-legend').append(...stageLegend());
    focus.listeners.push(markFocus);
    draw();
  }
  return {start};
})();
