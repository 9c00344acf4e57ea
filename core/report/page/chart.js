// Quality against cost, with the presets that no other one beats in both.

const chart = (() => {
  const state = {metric: leadingMetric(), log: true};
  let redraw = () => {};

  /** The presets on the Pareto front, by cost: no other is at least as cheap and good, and cheaper or better. */
  function paretoFront(points) {
    const byCost = [...points].sort((a, b) => a.cost - b.cost || a.bad - b.bad || a.index - b.index);
    const front = [];
    let best = Infinity;
    for (const point of byCost) {
      const twin = front.length > 0 && point.bad === best && point.cost === front[front.length - 1].cost;
      if (point.bad < best || twin) front.push(point);
      best = Math.min(best, point.bad);
    }
    return front;
  }

  function pointsOf(metric) {
    return report.presets
      .map((preset) => ({index: preset.index, name: preset.name, cost: preset.total, value: preset.scores[metric.name],
        bad: badness(metric, preset.scores[metric.name])}))
      .filter((point) => isNumber(point.value) && isNumber(point.cost) && (!state.log || point.cost > 0));
  }

  /** Steps from a front's point to the next: what there is to have for a cost. */
  function frontPath(front, x, y, right) {
    let path = '';
    front.forEach((point, i) => { path += i === 0 ? `M${x(point.cost)},${y(point.value)}` : `H${x(point.cost)}V${y(point.value)}`; });
    return `${path}H${right}`;
  }

  /** Where a point's name goes: beside it where nothing else is, or nowhere. */
  function placedLabels(points, onFront, x, y, box) {
    const taken = points.map((p) => ({x0: x(p.cost) - 7, x1: x(p.cost) + 7, y0: y(p.value) - 7, y1: y(p.value) + 7}));
    const free = (r) => r.x0 >= box.left && r.x1 <= box.right && r.y0 >= box.top - 8 && r.y1 <= box.bottom
      && taken.every((t) => r.x1 <= t.x0 || r.x0 >= t.x1 || r.y1 <= t.y0 || r.y0 >= t.y1);
    const labels = [];
    for (const point of points) {
      const text = point.name.length > 26 ? `${point.name.slice(0, 25)}…` : point.name;
      const width = text.length * 6.4 + 2, cx = x(point.cost), cy = y(point.value);
      // The front's line leaves its points to the right and comes from below.
      const places = onFront.has(point.index)
        ? [[-14, 4, 'end'], [10, -10, 'start'], [-8, -12, 'end'], [0, -15, 'middle'], [14, 15, 'start'], [-10, 18, 'end']]
        : [[9, 4, 'start'], [-9, 4, 'end'], [0, -10, 'middle'], [0, 18, 'middle'], [9, -7, 'start'], [9, 15, 'start'], [-9, -7, 'end'], [-9, 15, 'end']];
      for (const [dx, dy, anchor] of places) {
        const left = cx + dx - (anchor === 'end' ? width : anchor === 'middle' ? width / 2 : 0);
        const area = {x0: left, x1: left + width, y0: cy + dy - 10, y1: cy + dy + 3};
        if (!free(area)) continue;
        taken.push(area);
        labels.push(svg('text', {class: 'point-label', x: cx + dx, y: cy + dy, 'text-anchor': anchor, 'data-preset': point.index}, text));
        break;
      }
    }
    return labels;
  }

  function dot(point, x, y, onFront, metric) {
    const group = svg('g', {class: onFront ? 'point front' : 'point', transform: `translate(${x(point.cost)},${y(point.value)})`,
      tabindex: 0, role: 'img', 'data-front': onFront ? 'yes' : 'no', 'data-value': point.value, 'data-cost': point.cost,
      onclick: () => focus.toggle(point.index), onfocus: () => focus.hover(point.index), onblur: () => focus.hover(null),
      onkeydown: (event) => { if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); focus.toggle(point.index); } }},
    svg('circle', {r: 12, class: 'target'}));
    if (onFront) group.append(svg('circle', {r: 9.5, class: 'halo'}));
    group.append(marker(point.index, 5.2));
    const text = `${point.name}: ${formatted(point.value)} ${metric.unit} at ${milliseconds(point.cost)} ms${onFront ? ', on the Pareto front' : ''}`;
    group.append(svg('title', {}, text));
    group.setAttribute('aria-label', text);
    return focusable(group, point.index);
  }

  function nothingToDraw(metric) {
    if (report.presets.every((preset) => preset.total === null)) return 'Cost was not measured, so there is nothing to set quality against.';
    if (!metric) return 'No metric was computed.';
    return `${titleOf(metric)} has no value for any preset whose cost is known.`;
  }

  function draw(width) {
    const plot = byId('chart-plot'), metric = metricOf.get(state.metric);
    const points = metric ? pointsOf(metric) : [];
    if (points.length === 0) {
      plot.replaceChildren(el('p', {class: 'empty'}, nothingToDraw(metric)));
      return;
    }
    const height = Math.round(Math.max(280, Math.min(420, width * 0.62)));
    const box = {left: 62, top: 34, right: width - 14, bottom: height - 42};
    const x = scaleOf(points.map((p) => p.cost), box.left, box.right, {log: state.log, air: 0.08, ticks: Math.max(3, Math.floor(width / 90))});
    // Better is up, whichever way the metric points.
    const values = metric.better === 'zero' ? [...points.map((p) => p.value), 0] : points.map((p) => p.value);
    const y = metric.better === 'lower' ? scaleOf(values, box.top, box.bottom, {air: 0.1}) : scaleOf(values, box.bottom, box.top, {air: 0.1});
    const front = paretoFront(points), onFront = new Set(front.map((point) => point.index));
    const drawing = svg('svg', {width, height, viewBox: `0 0 ${width} ${height}`, role: 'group',
      'aria-label': `${titleOf(metric)} against cost`});
    drawing.append(axes(box, x, y, `cost, ms per frame${state.log ? ' (log)' : ''}`,
      upward(metric)));
    if (metric.better === 'zero') drawing.append(svg('line', {class: 'zero', x1: box.left, x2: box.right, y1: y(0), y2: y(0)}));
    if (metric.better !== 'zero') drawing.append(svg('path', {class: 'front-line', d: frontPath(front, x, y, box.right)}));
    // Names on the front are placed first.
    const ordered = [...front, ...points.filter((point) => !onFront.has(point.index))];
    drawing.append(...placedLabels(ordered, onFront, x, y, box), ...points.map((point) => dot(point, x, y, onFront.has(point.index), metric)));
    const missing = report.presets.length - points.length;
    plot.replaceChildren(drawing, el('p', {class: 'caption'},
      `${metric.doc ? `${metric.doc[0].toUpperCase()}${metric.doc.slice(1)}. ` : ''}Ringed: the Pareto front, where nothing cheaper is better.`
      + (missing > 0 ? ` ${missing} preset${missing > 1 ? 's have' : ' has'} no value here.` : '')));
    showFocus(plot);
  }

  function start() {
    const bar = byId('chart-bar');
    if (report.metrics.length > 0)
      bar.append(chooser('Quality', 'chart-metric', metricChoices(), state.metric, (value) => { state.metric = value; redraw(); }));
    if (report.presets.some((preset) => preset.total !== null))
      bar.append(segmented('Cost axis', 'chart-scale', [['log', 'Log cost'], ['linear', 'Linear']], 'log',
        (value) => { state.log = value === 'log'; redraw(); }));
    redraw = drawnToWidth(byId('chart-plot'), draw);
    focus.listeners.push(() => showFocus(byId('chart-plot')));
  }
  return {start, paretoFront};
})();
