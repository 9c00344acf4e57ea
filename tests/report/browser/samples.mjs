// What the pages of make_report must do, to the pixel.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {canvasPixel, close, openPage, settled, texts} from './session.mjs';

const press = (page, selector) => page.click(selector);

/** Canvas position of the middle of the region's pixel (x, y). */
async function placeOf(page, x, y) {
  return page.evaluate(([px, py]) => {
    const canvas = document.getElementById('viewer-canvas'), zoom = Number(canvas.dataset.zoom);
    const size = Number(document.getElementById('viewer').dataset.regionSize ?? 160) * zoom;
    const left = Math.round((canvas.clientWidth - size) / 2), top = Math.round((canvas.clientHeight - size) / 2);
    return [left + (px + 0.5) * zoom, top + (py + 0.5) * zoom];
  }, [x, y]);
}

async function select(page, a, b, mode) {
  await page.selectOption('#viewer-a', String(a));
  await page.selectOption('#viewer-b', String(b));
  await press(page, `#viewer-mode [data-value=${mode}]`);
  await settled(page);
}

/** Every picture of every frame, rebuilt from differences, has its exact colour at the region's pixel (5, 7). */
async function checkPixels(page, expected) {
  for (const [frame, colours] of Object.entries(expected)) {
    await press(page, `#viewer-frames [data-frame="${frame}"]`);
    for (const [index, colour] of colours.entries()) {
      await select(page, index, 0, 'a');
      assert.deepEqual(await canvasPixel(page, ...await placeOf(page, 5, 7)), colour, `picture ${index} of frame ${frame}`);
    }
  }
}

async function checkDifference(page, expected) {
  const [frame, colours] = Object.entries(expected)[0];
  await press(page, `#viewer-frames [data-frame="${frame}"]`);
  await select(page, 0, 3, 'difference');
  for (const factor of [1, 10, 100]) {
    await press(page, `#viewer-gain [data-value="${factor}"]`);
    await settled(page);
    const wanted = colours[0].map((value, c) => Math.min(255, Math.abs(value - colours[3][c]) * factor));
    assert.deepEqual(await canvasPixel(page, ...await placeOf(page, 5, 7)), wanted, `difference x${factor}`);
  }
}

/** The handle dragged left and right of the pixel shows B or A there; arrow keys move it. */
async function checkWipe(page, expected) {
  const [frame, colours] = Object.entries(expected)[0];
  await press(page, `#viewer-frames [data-frame="${frame}"]`);
  await select(page, 0, 3, 'wipe');
  const place = await placeOf(page, 5, 7), box = await page.locator('.stage').boundingBox();
  const dragTo = async (x) => {
    const handle = await page.locator('#wipe-handle').boundingBox();
    await page.mouse.move(handle.x + handle.width / 2, handle.y + handle.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + x, box.y + 60, {steps: 3});
    await page.mouse.up();
    return canvasPixel(page, ...place);
  };
  assert.deepEqual(await dragTo(place[0] - 20), colours[3], 'right of the handle is B');
  assert.deepEqual(await dragTo(place[0] + 60), colours[0], 'left of the handle is A');
  const value = async () => Number(await page.getAttribute('#wipe-handle', 'aria-valuenow'));
  const before = await value();
  await page.locator('#wipe-handle').press('ArrowRight');
  assert.equal(await value(), before + 1);
  await press(page, '#viewer-swap');
  await settled(page);
  assert.deepEqual(await canvasPixel(page, ...place), colours[3], 'swapped');
  await press(page, '#viewer-swap');
}

async function checkZoom(page, expected) {
  const [frame, colours] = Object.entries(expected)[0];
  await press(page, `#viewer-frames [data-frame="${frame}"]`);
  await select(page, 0, 3, 'a');
  const zoom = () => page.getAttribute('#viewer-canvas', 'data-zoom').then(Number);
  const fit = await zoom();
  await press(page, '#zoom-one');
  assert.equal(await zoom(), 1);
  for (let i = 0; i < 8; ++i) await press(page, '#zoom-in');
  assert.equal(await zoom(), 32, 'no more than 32 times');
  await press(page, '#zoom-fit');
  assert.equal(await zoom(), fit);
  // The wheel zooms about the pointer: the pixel below it stays, and is as large as the zoom, of one colour.
  const box = await page.locator('#viewer-canvas').boundingBox(), [x, y] = await placeOf(page, 5, 7);
  await page.mouse.click(box.x + x, box.y + y);
  for (let i = 0; i < 8; ++i) await page.mouse.wheel(0, -120);
  await page.waitForFunction(() => document.getElementById('viewer-canvas').dataset.zoom === '32');
  assert.deepEqual(await canvasPixel(page, x, y), colours[0], 'the pixel under the pointer stays');
  const row = await page.evaluate(([cx, cy]) => {
    const canvas = document.getElementById('viewer-canvas');
    return [...canvas.getContext('2d').getImageData(Math.floor(cx) - 40, Math.floor(cy), 80, 1).data];
  }, [x, y]);
  const changes = [];
  for (let i = 1; i < 80; ++i) if ([0, 1, 2].some((c) => row[4 * i + c] !== row[4 * i - 4 + c])) changes.push(i);
  assert.ok(changes.length >= 1 && changes.length <= 3, `pixels are squares: changes at ${changes}`);
  if (changes.length > 1) assert.equal(changes[1] - changes[0], 32);
  await page.mouse.move(box.x + x + 1, box.y + y);
  const readout = (await texts(page, '#viewer-readout')).join(' ');
  assert.ok(readout.includes(`A ${colours[0].join(' ')}`), `${readout} reads ${colours[0]}`);
  const before = await canvasPixel(page, x, y);
  await page.mouse.down();
  await page.mouse.move(box.x + x + 33, box.y + y, {steps: 2});
  await page.mouse.up();
  assert.deepEqual(await canvasPixel(page, x + 32, y), before, 'panning moves the picture with the pointer');
  await page.keyboard.press('0');
  assert.equal(await zoom(), fit);
}

async function checkPlay(page) {
  const shown = () => page.locator('#viewer-frames [aria-pressed=true]').textContent();
  const first = await shown();
  await press(page, '#viewer-play');
  await page.waitForFunction((number) => document.querySelector('#viewer-frames [aria-pressed=true]').textContent !== number, first);
  await press(page, '#viewer-play');
  assert.equal(await page.getAttribute('#viewer-play', 'aria-pressed'), 'false');
  await page.waitForTimeout(400);
  const stopped = await shown();
  await page.waitForTimeout(600);
  assert.equal(await shown(), stopped, 'paused');
  await page.locator('#viewer-canvas').press('.');
  await page.waitForFunction((number) => document.querySelector('#viewer-frames [aria-pressed=true]').textContent !== number, stopped);
}

/** The front that the page draws is that of all pairs compared. */
async function checkFront(page) {
  for (const metric of ['psnr', 'ldr_flip', 'ao_bias']) {
    await page.selectOption('#chart-metric', metric);
    const points = await page.locator('#chart-plot .point').evaluateAll((elements) => elements.map((element) => element.dataset));
    const bad = (p) => (metric === 'psnr' ? -p.value : Math.abs(p.value));
    for (const p of points) {
      const beaten = points.some((q) => bad(q) <= bad(p) && Number(q.cost) <= Number(p.cost) && (bad(q) < bad(p) || Number(q.cost) < Number(p.cost)));
      assert.equal(p.front, beaten ? 'no' : 'yes', `${metric} of preset ${p.preset}`);
    }
    assert.equal(points.length, 4);
  }
  const place = () => page.locator('#chart-plot .point').first().getAttribute('transform');
  const log = await place();
  await press(page, '#chart-scale [data-value=linear]');
  assert.notEqual(await place(), log, 'a linear axis is another one');
  await page.selectOption('#chart-metric', 'ao_correlation');
  assert.match((await texts(page, '#chart-plot')).join(' '), /no value/);
  await page.selectOption('#chart-metric', 'psnr');
}

async function checkFramePlot(page) {
  await page.selectOption('#frames-metric', 'ssim');
  const drawing = page.locator('#frames-plot > svg'), box = await drawing.boundingBox();
  await drawing.hover({position: {x: box.width * 0.5, y: box.height * 0.5}});
  const tip = (await texts(page, '#frames-plot .tip')).join(' ');
  assert.match(tip, /frame \d+/);
  assert.match(tip, /offline/);
  const tick = await page.locator('#frames-plot .picture-tick[data-frame="4"]').boundingBox();
  await page.mouse.click(tick.x + tick.width / 2, tick.y - 40);
  await page.waitForFunction(() => document.querySelector('#viewer-frames [aria-pressed=true]').textContent === '4');
  await drawing.focus();
  await page.keyboard.press('Home');
  assert.match((await texts(page, '#frames-plot .tip')).join(' '), /frame 1\D/);
}

async function checkTable(page) {
  const column = async (n) => texts(page, `#results tbody tr > :nth-child(${n})`);
  await press(page, '#results [data-sort=psnr]');
  const direction = () => page.locator('#results thead th:has([data-sort=psnr])').getAttribute('aria-sort');
  const values = (await column(2)).map(Number);
  const sorted = [...values].sort((a, b) => ((a - b) * (values[0] < values[3] ? 1 : -1)));
  assert.deepEqual(values, sorted);
  const was = await direction();
  await press(page, '#results [data-sort=psnr]');
  assert.notEqual(await direction(), was);
  assert.deepEqual((await column(2)).map(Number), [...values].reverse());
  const columns = () => page.locator('#results thead th').count();
  const before = await columns();
  await press(page, '#results-stages');
  assert.ok(await columns() > before, 'a column per stage');
  await press(page, '#results-stages');
  const widths = () => page.locator('#results .cost-bar').evaluateAll((bars) => bars.map((bar) =>
    [...bar.children].reduce((sum, part) => sum + parseFloat(part.style.width), 0)));
  await press(page, '#results-bars [data-value=shares]');
  for (const width of await widths()) assert.ok(Math.abs(width - 100) < 0.01, 'shares add up');
  await press(page, '#results-bars [data-value=scale]');
  assert.ok(Math.abs(Math.max(...await widths()) - 100) < 0.01 && Math.min(...await widths()) < 90, 'bars to scale');
  await press(page, '#results tbody tr:nth-child(2) .preset-name');
  await page.mouse.move(5, 5);
  assert.equal(await page.locator('#chart-plot .point.in-focus').count(), 1, 'singled out in the chart');
  await press(page, '#clear-focus');
}

async function checkParameters(page) {
  const rows = () => page.locator('#parameters tbody tr:not(.stage-row)').count();
  const few = await rows();
  await press(page, '#parameters-all');
  assert.ok(await rows() > few, 'equal parameters are hidden at first');
  await press(page, '#parameters-all');
  assert.equal(await rows(), few);
}

export async function checkSamples(browser, folder) {
  const expected = JSON.parse(readFileSync(`${folder}/full.pixels.json`, 'utf8'));
  const page = await openPage(browser, `${folder}/full.html`);
  await page.locator('#viewer').scrollIntoViewIfNeeded();
  await checkPixels(page, expected);
  await checkDifference(page, expected);
  await checkWipe(page, expected);
  await checkZoom(page, expected);
  await checkPlay(page);
  await checkFront(page);
  await checkFramePlot(page);
  await checkTable(page);
  await checkParameters(page);
  await close(page);

  const bare = await openPage(browser, `${folder}/bare.html`);
  assert.match((await texts(bare, '#viewer')).join(' '), /no pictures/);
  assert.match((await texts(bare, '#chart')).join(' '), /Cost was not measured/);
  await close(bare);

  const many = await openPage(browser, `${folder}/many.html`);
  assert.equal(await many.evaluate(() => window.hacked), undefined, 'names are text');
  assert.ok((await texts(many, '.preset-name')).some((name) => name.startsWith('</script><img')), 'and shown as they are');
  assert.match((await texts(many, '.note')).join(' '), /fit into 2.0 MB/);
  const marks = await many.locator('#results .glyph path').evaluateAll((paths) => paths.map((p) => p.getAttribute('d') + p.getAttribute('style')));
  assert.equal(new Set(marks).size, marks.length, 'each preset has its own mark');
  await close(many);
}
