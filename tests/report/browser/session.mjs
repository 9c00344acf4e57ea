// A browser, its pages, and what must hold on every one of them.
import assert from 'node:assert/strict';
import path from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

export async function openBrowser(executablePath) {
  // Root may not use Chromium's sandbox; the pages are our own.
  return chromium.launch({executablePath, headless: true, args: ['--no-sandbox', '--disable-dev-shm-usage', '--force-color-profile=srgb']});
}

/** Opens a file as a page; `troubles` collects console errors, exceptions and requests other than for the file itself. */
export async function openPage(browser, file, {width = 1440, height = 900, colorScheme = 'light'} = {}) {
  const context = await browser.newContext({viewport: {width, height}, colorScheme});
  const page = await context.newPage();
  const address = pathToFileURL(path.resolve(file)).href, troubles = [];
  page.on('console', (message) => {
    const ours = message.text().includes('willReadFrequently');  // the tests look at the canvas, the page does not
    if (['error', 'warning'].includes(message.type()) && !ours) troubles.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => troubles.push(`exception: ${error.stack ?? error}`));
  page.on('request', (request) => { if (request.url() !== address) troubles.push(`request: ${request.url().slice(0, 120)}`); });
  page.on('dialog', (dialog) => { troubles.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'yes', null, {timeout: 30000});
  page.troubles = troubles;
  return page;
}

export async function close(page) {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve, 50))));
  assert.deepEqual(page.troubles, [], 'console errors, exceptions and network requests');
  await page.context().close();
}

/** The colour on the viewer's canvas at a CSS position within it. */
export function canvasPixel(page, x, y) {
  return page.evaluate(([cx, cy]) => {
    const canvas = document.getElementById('viewer-canvas'), ratio = canvas.width / canvas.clientWidth;
    return [...canvas.getContext('2d').getImageData(Math.floor(cx * ratio), Math.floor(cy * ratio), 1, 1).data.slice(0, 3)];
  }, [x, y]);
}

/** The viewer's pictures are loaded without a signal: wait until the canvas stays the same for two looks. */
export async function settled(page) {
  const look = () => page.evaluate(() => {
    const canvas = document.getElementById('viewer-canvas');
    if (!canvas) return 0;
    const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    let sum = canvas.width;
    for (let i = 0; i < data.length; i += 41) sum = (sum * 31 + data[i]) % 1000003;
    return sum;
  });
  for (let before = -1, now = await look(), tries = 0; tries < 40 && before !== now; ++tries) {
    await page.waitForTimeout(80);
    [before, now] = [now, await look()];
  }
}

export const texts = (page, selector) => page.locator(selector).allTextContents();
