// What holds on every report page, whatever it compares.
import assert from 'node:assert/strict';
import {canvasPixel, close, openPage, settled, texts} from './session.mjs';

/** Number of elements of a kind. */
const count = (page, selector) => page.locator(selector).count();

async function checkTable(page, presets) {
  assert.equal(await count(page, '#results tbody tr'), presets, 'a row per preset');
  const sorted = await page.locator('#results thead th[aria-sort] .sort').getAttribute('data-sort');
  await page.locator('#results .sort').last().click();
  assert.ok(['ascending', 'descending'].includes(await page.locator('#results thead th').last().getAttribute('aria-sort')));
  await page.locator(`#results [data-sort="${sorted}"]`).click();
}

async function checkCharts(page) {
  for (const [select, plot] of [['#chart-metric', '#chart-plot'], ['#frames-metric', '#frames-plot']]) {
    if (await count(page, select) === 0) continue;
    const values = await page.locator(`${select} option`).evaluateAll((options) => options.map((option) => option.value));
    const before = await page.locator(select).inputValue(), seen = new Set();
    for (const value of values) {
      await page.selectOption(select, value);
      seen.add(await page.locator(plot).innerHTML());
      assert.ok(!(await page.locator(plot).innerHTML()).includes('NaN'), `${plot} of ${value} has no broken coordinates`);
    }
    assert.equal(seen.size, values.length, `each metric has its own picture in ${plot}`);
    await page.selectOption(select, before);
  }
}

/** Wipe to the left shows B, to the right A; a difference with itself is black. */
async function checkViewer(page) {
  if (await count(page, '#viewer-canvas') === 0) return;
  await page.locator('#viewer').scrollIntoViewIfNeeded();
  await settled(page);
  const sources = await page.locator('#viewer-a option').evaluateAll((options) => options.map((option) => option.value));
  const middle = await page.evaluate(() => {
    const canvas = document.getElementById('viewer-canvas');
    return [canvas.clientWidth / 2, canvas.clientHeight / 2];
  });
  const wipe = async (key) => { await page.locator('#wipe-handle').press(key); return canvasPixel(page, ...middle); };
  const onlyOf = async (letter) => {
    await page.click(`#viewer-mode [data-value=${letter}]`);
    await settled(page);
    return canvasPixel(page, ...middle);
  };
  const a = await onlyOf('a'), b = await onlyOf('b');
  await page.click('#viewer-mode [data-value=wipe]');
  await settled(page);
  assert.deepEqual(await wipe('Home'), b, 'the wipe at the left end shows B');
  assert.deepEqual(await wipe('End'), a, 'the wipe at the right end shows A');
  await page.selectOption('#viewer-b', sources[0]);
  await page.selectOption('#viewer-a', sources[0]);
  await page.click('#viewer-mode [data-value=difference]');
  await settled(page);
  assert.deepEqual(await canvasPixel(page, ...middle), [0, 0, 0], 'nothing differs from itself');
  await page.click('#viewer-mode [data-value=wipe]');
  await page.selectOption('#viewer-b', sources[sources.length > 2 ? sources.length - 2 : sources.length - 1]);
  for (let i = 0; i < 5; ++i) await page.locator('#wipe-handle').press('Shift+ArrowLeft');
  await settled(page);
}

async function noSidewaysScroll(page, what) {
  const [inner, outer] = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
  assert.ok(inner <= outer, `${what}: the page is ${inner} px wide in a window of ${outer}`);
}

/** Checks a page and leaves screenshots NAME-light.png, -dark, -narrow and NAME.pdf's picture -print. */
export async function checkAnyPage(browser, file, name, folder) {
  const page = await openPage(browser, file);
  const presets = await page.evaluate(() => JSON.parse(document.getElementById('data').textContent).presets.length);
  await checkTable(page, presets);
  await checkCharts(page);
  await checkViewer(page);
  await noSidewaysScroll(page, 'wide');
  assert.equal((await texts(page, 'h2')).length, 6);
  await page.evaluate(() => { document.activeElement.blur(); window.scrollTo(0, 0); });
  await page.screenshot({path: `${folder}/${name}-light.png`, fullPage: true});
  await page.emulateMedia({media: 'print'});
  await page.setViewportSize({width: 800, height: 1130});
  await settled(page);
  await page.screenshot({path: `${folder}/${name}-print.png`, fullPage: true});
  await noSidewaysScroll(page, 'paper');
  const bars = await page.locator('.bar:visible').count();
  assert.equal(bars, 0, 'no controls on paper');
  await close(page);

  const dark = await openPage(browser, file, {colorScheme: 'dark'});
  const background = await dark.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
  assert.ok(background.slice(0, 3).every((value) => value < 60), `dark background, not ${background}`);
  await settled(dark);
  await dark.screenshot({path: `${folder}/${name}-dark.png`, fullPage: true});
  await close(dark);

  const narrow = await openPage(browser, file, {width: 390, height: 844});
  await noSidewaysScroll(narrow, 'narrow');
  await settled(narrow);
  await narrow.screenshot({path: `${folder}/${name}-narrow.png`, fullPage: true});
  await close(narrow);
}
