// The worst frames: any two of presets, reference and input, wiped, subtracted, zoomed, played.

const viewer = (() => {
  const sources = report.presets.map((preset) => preset.name);
  if (report.reference !== null) sources.push(`reference: ${referenceName()}`);
  sources.push('input');
  const referenceIndex = report.reference === null ? -1 : report.presets.length;
  const state = {shown: 0, kind: 'whole', a: 0, b: 0, mode: 'wipe', gain: 1, playing: false};
  let view = null, images = [null, null], drawing = 0, onFrame = () => {};

  const hasPicture = (index) => shownFrames.some((frame) => frame.whole[index]);
  const frame = () => shownFrames[state.shown];
  const detailed = () => shownFrames.some((shown) => shown.detail !== null);
  const setOf = () => (state.kind === 'detail' && frame().detail ? 'detail' : 'whole');

  /** What the outline of the region is within the whole picture; nothing where the region is all of it. */
  function outline() {
    if (setOf() !== 'whole' || !frame().detail) return null;
    const {display} = report, {region} = frame();
    return {x: (region.x - display.x) / display.width, y: (region.y - display.y) / display.height,
      width: region.width / display.width, height: region.height / display.height};
  }

  /** Loads what is chosen and shows it; of several calls at once the last one wins. */
  async function update() {
    const ticket = ++drawing, kind = setOf();
    const loaded = await Promise.all([pictures.get(state.shown, kind, state.a), pictures.get(state.shown, kind, state.b)]);
    if (ticket !== drawing) return;
    images = loaded;
    const [a, b] = images, missing = byId('viewer-missing');
    const needed = {wipe: [a, b], difference: [a, b], a: [a], b: [b]}[state.mode];
    missing.hidden = needed.every((image) => image !== null);
    missing.textContent = `There is no picture of ${a === null ? sources[state.a] : sources[state.b]} in frame ${frame().frame}.`;
    if (!missing.hidden) view.show(null, null);
    else if (state.mode === 'difference') view.show(pictures.canvasOf(pictures.difference(a, b, state.gain)), null, outline());
    else if (state.mode === 'wipe') view.show(pictures.canvasOf(a), pictures.canvasOf(b), outline());
    else view.show(pictures.canvasOf(state.mode === 'a' ? a : b), null, outline());
    tellState();
  }

  function tellState() {
    const {mode} = state, both = mode === 'wipe' || mode === 'difference';
    byId('label-a').textContent = mode === 'difference' ? `|A − B| × ${state.gain}: ${sources[state.a]}, ${sources[state.b]}`
      : mode === 'b' ? `B  ${sources[state.b]}` : `A  ${sources[state.a]}`;
    byId('label-b').textContent = `B  ${sources[state.b]}`;
    byId('label-b').hidden = mode !== 'wipe';
    byId('viewer-gain').hidden = mode !== 'difference';
    for (const button of byId('viewer-frames').children)
      button.setAttribute('aria-pressed', String(Number(button.dataset.shown) === state.shown));
    const {region} = frame();
    byId('viewer-where').textContent = setOf() === 'detail' || frame().detail === null
      ? `Frame ${frame().frame}, pixels ${region.x}, ${region.y} to ${region.x + region.width - 1}, ${region.y + region.height - 1}`
      : `Frame ${frame().frame}, whole, ${frame().whole.find((p) => p)?.width ?? 0} px of ${report.display.width} wide; the outline is the worst region`;
    view.canvas.setAttribute('aria-label', `frame ${frame().frame}: ${both ? `${sources[state.a]} and ${sources[state.b]}` : sources[mode === 'a' ? state.a : state.b]}`);
    onFrame(frame().frame);
  }

  const triple = (image, x, y) => (image ? [...image.data.slice(4 * (y * image.width + x), 4 * (y * image.width + x) + 3)] : null);
  function tellPixel(x, y) {
    const readout = byId('viewer-readout');
    if (x === undefined) {
      readout.replaceChildren(el('span', {class: 'hint'}, 'Point at a pixel to read it.'));
      return;
    }
    const [a, b] = images.map((image) => triple(image, x, y)), {display} = report, {region} = frame();
    const place = setOf() === 'detail' ? [region.x + x, region.y + y]
      : [display.x + Math.floor(((x + 0.5) * display.width) / view.left.width), display.y + Math.floor(((y + 0.5) * display.height) / view.left.height)];
    const value = (name, rgb) => rgb && [el('span', {class: 'pixel'}, el('i', {style: `background-color:rgb(${rgb})`}), `${name} ${rgb.join(' ')}`)];
    readout.replaceChildren(el('span', {class: 'pixel'}, `x ${place[0]}  y ${place[1]}`), ...(value('A', a) ?? []), ...(value('B', b) ?? []),
      a && b ? el('span', {class: 'pixel'}, `B − A ${b.map((v, c) => (v > a[c] ? `+${v - a[c]}` : String(v - a[c]).replace('-', '−'))).join(' ')}`) : '');
  }

  function go(shown) {
    state.shown = (shown + shownFrames.length) % shownFrames.length;
    return update();
  }

  async function play(on) {
    state.playing = on;
    byId('viewer-play').setAttribute('aria-pressed', String(on));
    byId('viewer-play').textContent = on ? 'Pause' : 'Play';
    while (state.playing) {
      const wait = new Promise((resolve) => setTimeout(resolve, 250));
      const next = (state.shown + 1) % shownFrames.length;
      await Promise.all([pictures.get(next, setOf(), state.a), pictures.get(next, setOf(), state.b), wait]);
      if (state.playing) await go(next);
    }
  }

  function pictureChooser(label, key) {
    const choices = sources.map((name, index) => [index, name]).filter(([index]) => hasPicture(index));
    return chooser(label, `viewer-${key}`, choices, state[key], (value) => { state[key] = Number(value); update(); });
  }

  function swap() {
    [state.a, state.b] = [state.b, state.a];
    byId('viewer-a').value = state.a;
    byId('viewer-b').value = state.b;
    update();
  }

  function setMode(mode) {
    state.mode = mode;
    byId('viewer-mode').press(mode);
    update();
  }

  function controls() {
    const top = el('div', {class: 'bar'}, pictureChooser('A', 'a'),
      el('button', {type: 'button', id: 'viewer-swap', title: 'swap A and B (S)', onclick: swap}, '⇄'), pictureChooser('B', 'b'),
      segmented('What to show', 'viewer-mode', [['wipe', 'Wipe'], ['difference', 'Difference'], ['a', 'A'], ['b', 'B']], state.mode, setMode),
      segmented('Difference factor', 'viewer-gain', [[1, '×1'], [10, '×10'], [100, '×100']], 1, (gain) => { state.gain = gain; update(); }));
    const bottom = el('div', {class: 'bar'});
    if (detailed())
      bottom.append(segmented('Part of the frame', 'viewer-kind', [['whole', 'Whole frame'], ['detail', 'Worst region']], state.kind,
        (kind) => { state.kind = kind; view.zoom = null; update(); }));
    bottom.append(el('div', {class: 'segments', role: 'group', 'aria-label': 'Zoom'},
      el('button', {type: 'button', id: 'zoom-out', title: 'smaller (−)', onclick: () => view.zoomBy(-1)}, '−'),
      el('button', {type: 'button', id: 'zoom-fit', title: 'as large as fits (0)', onclick: () => view.zoomTo(null)}, 'Fit'),
      el('button', {type: 'button', id: 'zoom-one', title: 'a pixel is a pixel', onclick: () => view.zoomTo(1)}, '1:1'),
      el('button', {type: 'button', id: 'zoom-in', title: 'larger (+)', onclick: () => view.zoomBy(1)}, '+')),
    el('span', {id: 'viewer-zoom', class: 'figure'}));
    return [top, bottom];
  }

  function strip() {
    const buttons = shownFrames.map((shown, index) => el('button', {type: 'button', 'data-shown': index, 'data-frame': shown.frame,
      title: `error ${formatted(shown.error)}`, onclick: () => go(index)}, String(shown.frame)));
    const bar = el('div', {class: 'bar'}, el('span', {class: 'field'}, el('span', {}, 'Frame')),
      el('div', {class: 'segments wrap', role: 'group', 'aria-label': 'Frame', id: 'viewer-frames'}, buttons));
    if (shownFrames.length > 1)
      bar.append(el('button', {type: 'button', id: 'viewer-play', class: 'toggle', 'aria-pressed': 'false', title: 'through these frames (space)',
        onclick: () => play(!state.playing)}, 'Play'));
    return bar;
  }

  function onKey(event) {
    if (event.target.closest('select') || event.ctrlKey || event.metaKey || event.altKey) return;
    const button = event.target.closest('button');
    if (event.key === ',' || event.key === '.') go(state.shown + (event.key === '.' ? 1 : -1));
    else if (event.key === ' ' && !button && shownFrames.length > 1) play(!state.playing);
    else if (event.key === 's') swap();
    else if (event.key === 'a' || event.key === 'b' || event.key === 'w' || event.key === 'd')
      setMode({a: 'a', b: 'b', w: 'wipe', d: 'difference'}[event.key]);
    else return;
    event.preventDefault();
  }

  /** Shows the frame with this number if its pictures are here. */
  function showFrame(number) {
    const index = shownFrames.findIndex((shown) => shown.frame === number);
    if (index < 0) return;
    go(index);
    byId('viewer').scrollIntoView({block: 'nearest'});
  }

  function start(onFrameShown) {
    const body = byId('viewer-body');
    if (shownFrames.length === 0) {
      body.append(el('p', {class: 'empty'}, 'This report has no pictures.'));
      return;
    }
    onFrame = onFrameShown;
    const available = sources.map((_, index) => index).filter(hasPicture);
    state.a = available[0] ?? 0;
    state.b = available.includes(referenceIndex) ? referenceIndex : available[1] ?? state.a;
    state.shown = shownFrames.reduce((worst, shown, index) => (shown.error > shownFrames[worst].error ? index : worst), 0);
    state.kind = detailed() ? 'detail' : 'whole';
    view = new PictureView(tellPixel, (scale, fits) => {
      byId('viewer-zoom').textContent = `${scale >= 1 ? `${Math.round(scale * 100) / 100}×` : `${Math.round(scale * 100)} %`}${fits ? ', fit' : ''}`;
    });
    view.element.append(el('span', {id: 'label-a', class: 'tag left'}), el('span', {id: 'label-b', class: 'tag right'}),
      el('p', {id: 'viewer-missing', class: 'empty', hidden: true}));
    body.append(...controls(), view.element, el('div', {id: 'viewer-readout', class: 'readout'}), strip(),
      el('p', {class: 'caption'}, el('span', {id: 'viewer-where'}), '. View: ', report.view_transform || 'sRGB', '. ',
        el('span', {class: 'on-screen'}, 'Click the picture, then the wheel or + and − zoom, dragging or arrow keys pan; on the handle arrow keys wipe. Keys: W wipe, D difference, A, B, S swap, comma and point previous and next frame, space play.')));
    const [width, height] = [report.display.width, report.display.height];
    view.element.style.aspectRatio = `${Math.max(width, height)} / ${Math.min(height, width * 0.62)}`;
    byId('viewer').addEventListener('keydown', onKey);
    tellPixel();
    update();
  }
  return {start, showFrame};
})();
