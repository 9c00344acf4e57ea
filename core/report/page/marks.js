// How presets are told apart: colour, shape and dash together, so that none of them has to do it alone.

const colourCount = 10;
const shapes = ['circle', 'square', 'triangle', 'diamond', 'cross', 'nabla', 'bar'];
const dashes = ['', '7 3', '2 3', '9 3 2 3', '5 2 1 2 1 2'];

/** Pairs repeat only after 70 presets. */
const colourOf = (index) => `var(--c${index % colourCount})`;
const shapeOf = (index) => shapes[index % shapes.length];
const dashOf = (index) => dashes[index % dashes.length];

const outlines = {
  circle: (r) => `M${-r},0A${r},${r} 0 1 0 ${r},0A${r},${r} 0 1 0 ${-r},0Z`,
  square: (r) => `M${-r * 0.9},${-r * 0.9}h${r * 1.8}v${r * 1.8}h${-r * 1.8}Z`,
  triangle: (r) => `M0,${-r * 1.15}L${r * 1.1},${r * 0.85}H${-r * 1.1}Z`,
  nabla: (r) => `M0,${r * 1.15}L${r * 1.1},${-r * 0.85}H${-r * 1.1}Z`,
  diamond: (r) => `M0,${-r * 1.3}L${r * 1.3},0L0,${r * 1.3}L${-r * 1.3},0Z`,
  cross: (r) => {
    const a = r * 1.15, b = r * 0.42;
    return `M${-b},${-a}h${2 * b}v${a - b}h${a - b}v${2 * b}h${b - a}v${a - b}h${-2 * b}v${b - a}h${b - a}v${-2 * b}h${a - b}Z`;
  },
  bar: (r) => `M${-r * 1.25},${-r * 0.55}h${r * 2.5}v${r * 1.1}h${r * -2.5}Z`,
};

/** The preset's marker around (0, 0), for a chart. */
function marker(index, radius) {
  return svg('path', {class: 'marker', d: outlines[shapeOf(index)](radius), style: `fill:${colourOf(index)}`});
}

/** The preset's marker as a picture between words. */
function glyph(index) {
  return svg('svg', {class: 'glyph', viewBox: '-7 -7 14 14', width: 14, height: 14, 'aria-hidden': 'true'}, marker(index, 4.6));
}

/** Stages by name, in order of appearance: their colour is their own on the whole page. */
const stageNames = [...new Set(report.presets.flatMap((preset) => (preset.cost ?? []).map((stage) => stage.stage)))];
const stageColour = (name) => `var(--s${stageNames.indexOf(name) % 10})`;
/** Every second stage is hatched: neighbours in a bar differ in more than colour. */
const stageHatched = (name) => stageNames.indexOf(name) % 2 === 1;

/** Fades what is not singled out: every element under `root` that names a preset. */
function showFocus(root) {
  const active = focus.active();
  root.classList.toggle('focused', active.size > 0);
  for (const element of root.querySelectorAll('[data-preset]'))
    element.classList.toggle('in-focus', active.has(Number(element.dataset.preset)));
}

/** Pointing at the element singles its preset out for as long. */
function focusable(element, index) {
  element.dataset.preset = index;
  element.addEventListener('pointerenter', () => focus.hover(index));
  element.addEventListener('pointerleave', () => focus.hover(null));
  return element;
}
