// Any metric frame by frame, a line per preset.

const frames = (() => {
  const state = {metric: leadingMetric() ?? 'cost', frame: null};
  let redraw = () => {}, selected = () => {};
  const numbers = report.frames;
  const shownNumbers = () => new Set(shownFrames.map((frame) => frame.frame));
  const costMetric = {name: 'cost', unit: 'ms', better: 'lower', doc: 'milliseconds of the frame, all stages'};
  const metric = () => (state.metric === 'cost' ? costMetric : metricOf.get(state.metric));

  function series(preset) {
    const byNumber = new Map(preset.frames.map((frame) => [frame.frame, state.metric === 'cost' ? frame.total : frame.scores[state.metric]]));
    return numbers.map((number) => byNumber.get(number) ?? null);
  }

  /** Values that are missing break the line; single ones between two gaps are dots. */
  function linePath(values, x, y) {
    let path = '', pen = false;
    values.forEach((value, i) => {
      if (isNumber(value)) path += `${pen ? 'L' : 'M'}${x(numbers[i]).toFixed(1)},${y(value).toFixed(1)}`;
      pen = isNumber(value);
    });
    return path;
  }

  function markersOf(preset, values, x, y) {
    const every = Math.max(1, Math.ceil(numbers.length / 8));
    const group = [];
    values.forEach((value, i) => {
      const lonely = !isNumber(values[i - 1]) && !isNumber(values[i + 1]);
      if (!isNumber(value) || !(lonely || (i + preset.index) % every === 0)) return;
      const mark = marker(preset.index, 3.2);
      mark.setAttribute('transform', `translate(${x(numbers[i])},${y(value)})`);
      group.push(mark);
    });
    return group;
  }

  function nearestFrame(px, x) {
    return numbers.reduce((best, number) => (Math.abs(x(number) - px) < Math.abs(x(best) - px) ? number : best), numbers[0]);
  }

  /** The values at a frame, best first. */
  function fillTip(tip, number, lines) {
    const at = numbers.indexOf(number), active = focus.pinned;
    const rows = lines
      .filter(({preset}) => active.size === 0 || active.has(preset.index))
      .map(({preset, values}) => ({preset, value: values[at]}))
      .sort((a, b) => badness(metric(), a.value) - badness(metric(), b.value));
    tip.replaceChildren(el('strong', {}, `frame ${number}`),
      ...rows.map(({preset, value}) => el('div', {}, glyph(preset.index), el('span', {}, preset.name), el('b', {}, formatted(value)))));
  }

  function cursorOn(drawing, plot, box, x, lines) {
    const line = svg('line', {class: 'cursor', y1: box.top, y2: box.bottom, visibility: 'hidden'});
    const tip = el('div', {class: 'tip', hidden: true, role: 'status'});
    const show = (number) => {
      state.frame = number;
      line.setAttribute('x1', x(number));
      line.setAttribute('x2', x(number));
      line.setAttribute('visibility', 'visible');
      fillTip(tip, number, lines);
      tip.hidden = false;
      const left = x(number) + 12, width = tip.offsetWidth;
      tip.style.left = `${left + width > plot.clientWidth ? Math.max(0, x(number) - width - 12) : left}px`;
      tip.style.top = `${box.top}px`;
    };
    const hide = () => {
      line.setAttribute('visibility', 'hidden');
      tip.hidden = true;
    };
    const step = (by) => show(numbers[Math.max(0, Math.min(numbers.length - 1, numbers.indexOf(state.frame ?? numbers[0]) + by))]);
    drawing.addEventListener('pointermove', (event) => show(nearestFrame(event.clientX - drawing.getBoundingClientRect().left, x)));
    drawing.addEventListener('pointerleave', hide);
    drawing.addEventListener('blur', hide);
    drawing.addEventListener('click', () => { if (state.frame !== null) selected(state.frame); });
    drawing.addEventListener('keydown', (event) => {
      const steps = {ArrowLeft: -1, ArrowRight: 1, Home: -numbers.length, End: numbers.length};
      if (event.key in steps) step(steps[event.key]);
      else if (event.key === 'Enter' && state.frame !== null) selected(state.frame);
      else return;
      event.preventDefault();
    });
    drawing.append(line);
    return tip;
  }

  function frameScale(box) {
    const x = scaleOf(numbers, box.left, box.right, {air: numbers.length > 1 ? 0.02 : 0.5, ticks: Math.max(2, Math.floor((box.right - box.left) / 60))});
    x.ticks = [...new Set(x.ticks.map(Math.round))].filter((tick) => tick >= numbers[0] && tick <= numbers[numbers.length - 1]);
    return x;
  }

  /** Triangles below the frames whose pictures are on the page. */
  function pictureTicks(box, x, chosen) {
    const shown = shownNumbers();
    return numbers.filter((number) => shown.has(number)).map((number) => svg('path', {
      class: number === chosen ? 'picture-tick chosen' : 'picture-tick', 'data-frame': number, d: `M${x(number)},${box.bottom - 7}l4.5,7h-9Z`,
    }, svg('title', {}, `frame ${number}: pictures below`)));
  }

  function draw(width) {
    const plot = byId('frames-plot');
    const lines = metric() ? report.presets.map((preset) => ({preset, values: series(preset)})) : [];
    const values = lines.flatMap((line) => finite(line.values));
    if (values.length === 0) {
      plot.replaceChildren(el('p', {class: 'empty'}, metric() ? `${titleOf(metric())} has no value for any frame.` : 'No metric was computed.'));
      return;
    }
    const height = Math.round(Math.max(280, Math.min(420, width * 0.62)));
    const box = {left: 62, top: 34, right: width - 14, bottom: height - 42};
    const x = frameScale(box), up = metric().better !== 'lower';
    const y = scaleOf(values, up ? box.bottom : box.top, up ? box.top : box.bottom, {air: 0.1});
    const drawing = svg('svg', {width, height, viewBox: `0 0 ${width} ${height}`, tabindex: 0, role: 'application',
      'aria-label': `${titleOf(metric())} frame by frame; arrow keys read values, Enter shows the frame`});
    drawing.append(axes(box, x, y, 'frame', upward(metric()), String));
    for (const {preset, values: own} of lines)
      drawing.append(svg('g', {class: 'series', 'data-preset': preset.index},
        svg('path', {class: 'line', d: linePath(own, x, y), style: `stroke:${colourOf(preset.index)}`, 'stroke-dasharray': dashOf(preset.index)}),
        ...markersOf(preset, own, x, y)));
    drawing.append(...pictureTicks(box, x, frames.chosen));
    const tip = cursorOn(drawing, plot, box, x, lines);
    plot.replaceChildren(drawing, tip, legend());
    showFocus(plot);
  }

  function legend() {
    return el('div', {class: 'legend chips'}, report.presets.map((preset) => focusable(el('button', {type: 'button', class: 'chip',
      'aria-pressed': String(focus.pinned.has(preset.index)), onclick: () => focus.toggle(preset.index)}, glyph(preset.index), preset.name), preset.index)));
  }

  function markFocus() {
    const plot = byId('frames-plot');
    showFocus(plot);
    for (const chip of plot.querySelectorAll('.chip')) chip.setAttribute('aria-pressed', String(focus.pinned.has(Number(chip.dataset.preset))));
  }

  /** `onSelected` is called with a frame number that the reader chose. */
  function start(onSelected) {
    selected = onSelected;
    const choices = metricChoices();
    if (report.presets.some((preset) => preset.frames.some((frame) => frame.total !== null))) choices.push(['cost', 'cost (ms)']);
    if (choices.length > 0)
      byId('frames-bar').append(chooser('Metric', 'frames-metric', choices, state.metric, (value) => { state.metric = value; redraw(); }));
    if (shownFrames.length > 0) byId('frames-bar').append(el('span', {class: 'hint'}, '▲ has pictures: click to see them.'));
    redraw = drawnToWidth(byId('frames-plot'), draw);
    focus.listeners.push(markFocus);
  }
  return {start, chosen: null, choose(number) { frames.chosen = number; redraw(); }};
})();
