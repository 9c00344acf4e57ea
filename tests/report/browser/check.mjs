// node check.mjs --browser CHROMIUM (--samples FOLDER | --page REPORT.html) --screenshots FOLDER
import path from 'node:path';
import {checkAnyPage} from './any_page.mjs';
import {checkSamples} from './samples.mjs';
import {openBrowser} from './session.mjs';

const options = {};
for (let i = 2; i < process.argv.length; i += 2) options[process.argv[i].slice(2)] = process.argv[i + 1];

const browser = await openBrowser(options.browser);
try {
  if (options.samples) {
    await checkSamples(browser, options.samples);
    for (const name of ['full', 'bare', 'plain', 'many']) await checkAnyPage(browser, `${options.samples}/${name}.html`, name, options.screenshots);
  } else {
    await checkAnyPage(browser, options.page, path.basename(options.page, '.html'), options.screenshots);
  }
  console.log(`report pages work in ${browser.version()}; screenshots are in ${options.screenshots}`);
} finally {
  await browser.close();
}
