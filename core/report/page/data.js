// What the page is about, and the small tools that all modules use.

const report = JSON.parse(document.getElementById('data').textContent);
const shownFrames = JSON.parse(document.getElementById('shown').textContent);
const metricOf = new Map(report.metrics.map((metric) => [metric.name, metric]));

/** An element: el('p', {class: 'note', onclick}, 'text', child). Text is text, never markup. */
function el(name, attributes = {}, ...children) {
  return filledElement(document.createElement(name), attributes, children);
}
function svg(name, attributes = {}, ...children) {
  return filledElement(document.createElementNS('http://www.w3.org/2000/svg', name), attributes, children);
}
function filledElement(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else if (value !== undefined && value !== null && value !== false) element.setAttribute(key, value === true ? '' : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}
const byId = (id) => document.getElementById(id);

const fileName = (path) => path.split('/').filter(Boolean).pop() ?? path;
/** There may be several, one for colour and one for AO. */
const referenceName = () => report.reference.split(', ').map(fileName).join(' and ');

const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);
const finite = (values) => values.filter(isNumber);

/** Four digits that count; no exponent where a person would not write one. */
function formatted(value) {
  if (Math.abs(value) === Infinity) return value > 0 ? '∞' : '−∞';
  if (!isNumber(value)) return '–';
  const size = Math.abs(value);
  if (value === 0) return '0';
  if (size < 1e-4 || size >= 1e6) return value.toExponential(2).replace('-', '−');
  const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(size))));
  return value.toFixed(digits).replace('-', '−');
}
function milliseconds(value) {
  if (!isNumber(value)) return '–';
  return value >= 100 ? value.toFixed(0) : value >= 10 ? value.toFixed(1) : value.toFixed(2);
}
function memory(bytes) {
  if (!isNumber(bytes)) return '–';
  return bytes >= 1e9 ? `${(bytes / 1e9).toFixed(2)} GB` : `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB`;
}

const titleOf = (metric) => metric.name.replace(/_/g, ' ');
const withUnit = (metric) => (metric.unit ? `${titleOf(metric)} (${metric.unit})` : titleOf(metric));
/** An axis title; axes point so that better is up, but for values that are best at 0. */
const upward = (metric) => (metric.better === 'zero' ? `${withUnit(metric)}, best at 0` : `${withUnit(metric)}, better is up`);
const direction = {lower: 'less is better', higher: 'more is better', zero: 'nearer to 0 is better'};

/** How bad a value is: the smaller the better, whichever way the metric points. */
function badness(metric, value) {
  if (typeof value !== 'number') return Infinity;
  if (metric.better === 'higher') return -value;
  return metric.better === 'zero' ? Math.abs(value) : value;
}

const totalCost = (cost) => (cost && cost.length > 0 ? cost.reduce((sum, stage) => sum + (stage.ms ?? 0), 0) : null);

/** JSON spells infinity as text. */
const asNumbers = (scores) => Object.fromEntries(Object.entries(scores ?? {}).map(
  ([name, value]) => [name, value === 'inf' ? Infinity : value === '-inf' ? -Infinity : value]));

report.presets.forEach((preset, index) => {
  preset.scores = asNumbers(preset.scores);
  for (const frame of preset.frames) frame.scores = asNumbers(frame.scores);
  preset.index = index;
  preset.total = totalCost(preset.cost);
  for (const frame of preset.frames) frame.total = totalCost(frame.cost);
});

/** The metric that says most about quality, among those computed. */
function leadingMetric() {
  const wanted = ['psnr', 'ao_rmse', 'ssim', 'ldr_flip', 'ao_correlation', 'flicker_stable', 'ao_flicker_stable'];
  const counts = (name) => metricOf.has(name) && report.presets.some((preset) => isNumber(preset.scores[name]));
  return wanted.find(counts) ?? report.metrics.map((metric) => metric.name).find(counts) ?? report.metrics[0]?.name;
}

/** Which presets the reader has singled out; none means all. */
const focus = {
  pinned: new Set(),
  hovered: null,
  listeners: [],
  active() {
    if (this.hovered !== null) return new Set([this.hovered]);
    return this.pinned;
  },
  changed() { for (const listener of this.listeners) listener(); },
  hover(index) {
    if (this.hovered === index) return;
    this.hovered = index;
    this.changed();
  },
  toggle(index) {
    if (!this.pinned.delete(index)) this.pinned.add(index);
    this.changed();
  },
  clear() {
    this.pinned.clear();
    this.changed();
  },
};

/** A drop-down list of [value, text] pairs; calls `changed` with the value. */
function chooser(label, id, choices, value, changed) {
  const select = el('select', {id, onchange: () => changed(select.value)},
    choices.map(([key, text]) => el('option', {value: key}, text)));
  select.value = String(value);
  return el('label', {class: 'field'}, el('span', {}, label), select);
}

/** Buttons of which one is pressed. */
function segmented(label, id, choices, value, changed) {
  const group = el('div', {class: 'segments', role: 'group', 'aria-label': label, id});
  const press = (key) => {
    for (const button of group.children) button.setAttribute('aria-pressed', String(button.dataset.value === String(key)));
  };
  for (const [key, text] of choices)
    group.append(el('button', {type: 'button', 'data-value': key, onclick: () => { press(key); changed(key); }}, text));
  press(value);
  group.press = press;
  return group;
}

/** A button that is on or off. */
function toggleButton(text, id, on, changed) {
  const button = el('button', {type: 'button', id, class: 'toggle', 'aria-pressed': String(on), onclick: () => {
    const pressed = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', String(pressed));
    changed(pressed);
  }}, text);
  return button;
}

const metricChoices = () => report.metrics.map((metric) => [metric.name, withUnit(metric)]);
