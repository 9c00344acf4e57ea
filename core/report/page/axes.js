// Scales, ticks and the frame of a plot.

/** Round steps: 1, 2 or 5 times a power of ten. */
function linearTicks(low, high, count) {
  const rough = (high - low) / Math.max(1, count), power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((factor) => factor * power >= rough) ?? 10);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) ticks.push(i * step);
  return ticks;
}

function logTicks(low, high) {
  const ticks = [];
  const factors = high / low > 300 ? [1] : high / low > 8 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
    for (const factor of factors) {
      const tick = factor * 10 ** power;
      if (tick >= low * 0.999 && tick <= high * 1.001) ticks.push(tick);
    }
  return ticks;
}

/** A scale from values to pixels with some air at its ends: scale(value), scale.ticks. */
function scaleOf(values, from, to, {log = false, air = 0.06, ticks = 5} = {}) {
  let low = Math.min(...values), high = Math.max(...values);
  if (log) {
    if (low === high) [low, high] = [low / 1.5, high * 1.5];
    const a = Math.log(low), b = Math.log(high), pad = (b - a) * air;
    const scale = (value) => from + ((Math.log(value) - a + pad) / (b - a + 2 * pad)) * (to - from);
    scale.ticks = logTicks(Math.exp(a - pad), Math.exp(b + pad));
    return scale;
  }
  if (low === high) {
    const half = Math.abs(low) * 0.1 || 1;
    [low, high] = [low - half, high + half];
  }
  const pad = (high - low) * air, a = low - pad, b = high + pad;
  const scale = (value) => from + ((value - a) / (b - a)) * (to - from);
  scale.ticks = linearTicks(a, b, ticks);
  return scale;
}

/** A tick's text: as many digits as tell neighbours apart. */
function tickText(value, ticks) {
  const step = ticks.length > 1 ? Math.abs(ticks[1] - ticks[0]) : Math.abs(value) || 1;
  if (value === 0) return '0';
  if (Math.abs(value) >= 1e7 || Math.abs(value) < 1e-4) return value.toExponential(0).replace('-', '−');
  const digits = Math.max(0, Math.min(6, Math.ceil(-Math.log10(Math.min(step, Math.abs(value))) - 1e-9)));
  return value.toFixed(digits).replace('-', '−');
}

/** Grid lines, ticks and axis titles. `box` is {left, top, right, bottom}. */
function axes(box, x, y, xTitle, yTitle, xText = tickText) {
  const group = svg('g', {class: 'axes'});
  for (const tick of y.ticks)
    group.append(svg('line', {class: 'grid', x1: box.left, x2: box.right, y1: y(tick), y2: y(tick)}),
      svg('text', {x: box.left - 7, y: y(tick), dy: '0.32em', 'text-anchor': 'end'}, tickText(tick, y.ticks)));
  for (const tick of x.ticks)
    group.append(svg('line', {class: 'tick', x1: x(tick), x2: x(tick), y1: box.bottom, y2: box.bottom + 4}),
      svg('text', {x: x(tick), y: box.bottom + 17, 'text-anchor': 'middle'}, xText(tick, x.ticks)));
  group.append(svg('line', {class: 'base', x1: box.left, x2: box.right, y1: box.bottom, y2: box.bottom}),
    svg('text', {class: 'axis-title', x: box.right, y: box.bottom + 34, 'text-anchor': 'end'}, xTitle),
    svg('text', {class: 'axis-title', x: box.left, y: box.top - 12}, yTitle));
  return group;
}

/** Draws into `element` now and whenever its width changes; returns a function that draws again. */
function drawnToWidth(element, draw) {
  let width = 0;
  const again = () => { if (width > 0) draw(width); };
  new ResizeObserver(([entry]) => {
    const now = Math.round(entry.contentRect.width);
    if (now !== width) { width = now; again(); }
  }).observe(element);
  return again;
}
