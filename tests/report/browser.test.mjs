// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Opens the sample pages in headless Chromium, at a laptop's and a phone's width, light and dark, and fails on whatever
// a reader would stumble over: an error in the console, a request to anywhere, an empty chart, a page that is wider than
// the window, a string of the data that became markup.
//
//   node browser.test.mjs CHROMIUM FOLDER    FOLDER holds the pages; pictures of them are left there
import assert from 'node:assert/strict';
import { readFileSync, readdirSync, statSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { unreadable } from './unreadable.mjs';

const [executablePath, folder] = process.argv.slice(2);
const widths = [1366, 390];
let browser;

before(async () => {
  browser = await chromium.launch({ executablePath, headless: true, args: ['--no-sandbox', '--disable-gpu'] });
});
after(() => browser?.close());

/** Opens a page and hears everything it says; `complaints` and `requests` are complete once it is drawn. */
async function opened(file, { width = 1366, javaScriptEnabled = true } = {}) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, javaScriptEnabled,
    isMobile: width < 600, hasTouch: width < 600, deviceScaleFactor: width < 600 ? 2 : 1 });
  const page = await context.newPage();
  await page.addInitScript(pixelReader);
  const complaints = [];
  const requests = [];
  page.on('console', (message) => complaints.push(`${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => complaints.push(`page error: ${error.message}`));
  page.on('dialog', (dialog) => { complaints.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(pathToFileURL(join(folder, file)).href);
  if (javaScriptEnabled) await page.waitForSelector('html[data-drawn]', { timeout: 30_000 });
  return { page, complaints, requests, close: () => context.close() };
}

/** Puts `pixelsOf(plot)` into the page: what a chart shows, all its layers together. It reads a copy, because Chromium
 * complains in the console of reading the original. */
const pixelReader = () => {
  window.pixelsOf = (plot) => {
    const layers = [...plot.querySelectorAll('canvas')];
    const [{ width, height }] = layers;
    const copy = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
    for (const layer of layers) copy.drawImage(layer, 0, 0);
    return copy.getImageData(0, 0, width, height).data;
  };
};

/** For each chart, how many of its pixels are not transparent. */
function inkOfCharts(page) {
  return page.$$eval('.plot', (plots) => plots.map((plot) => {
    const data = window.pixelsOf(plot);
    let inked = 0;
    for (let i = 3; i < data.length; i += 4) if (data[i] > 0) inked++;
    return { inked, title: plot.closest('figure').querySelector('h3').textContent };
  }));
}

/** How many pixels of the chart with this title have a colour close to the custom property `name`. */
function pixelsLike(page, title, name) {
  return page.evaluate(([wanted, property]) => {
    const figure = [...document.querySelectorAll('figure')].find((one) => one.querySelector('h3').textContent === wanted);
    const hex = getComputedStyle(document.documentElement).getPropertyValue(property).trim();
    const colour = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
    const data = window.pixelsOf(figure.querySelector('.plot'));
    let like = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 200 && colour.every((part, c) => Math.abs(part - data[i + c]) < 24)) like++;
    }
    return like;
  }, [title, name]);
}

const charts = { 'every_part.html': 9, 'identification.html': 8, 'empty.html': 0, 'diagnosis.html': null,
  'fleet.html': null };

for (const [file, expected] of Object.entries(charts)) {
  for (const width of widths) {
    test(`${file} at ${width} px, light and then dark`, async () => {
      const { page, complaints, requests, close } = await opened(file, { width });
      for (const colorScheme of ['light', 'dark']) {
        await page.emulateMedia({ colorScheme });
        const ink = await inkOfCharts(page);
        if (expected === null) assert.ok(ink.length >= 6, `${ink.length} charts`);  // as many as the record has axes
        else assert.equal(ink.length, expected, 'every chart has its canvas');
        // Axes, labels and grid alone come to a few thousand pixels; a blank canvas has none.
        for (const { inked, title } of ink) assert.ok(inked > 1000, `${title} is drawn (${inked} pixels)`);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
        assert.ok(wide <= 0, `the page is ${wide} px wider than the window`);
        await page.screenshot({ path: join(folder, `${file}.${width}.${colorScheme}.png`), fullPage: true });
      }
      assert.deepEqual(complaints, []);
      assert.deepEqual(requests.filter((url) => !url.startsWith('data:')), [pathToFileURL(join(folder, file)).href]);
      await close();
    });
  }
}

const kinds = ['identification.html', 'diagnosis.html', 'fleet.html', 'experiment/report.html',
  ...readdirSync(join(folder, 'kinds')).filter((name) => name.endsWith('.html')).map((name) => `kinds/${name}`)];

for (const file of kinds) {
  for (const width of [1400, 390]) {
    test(`${file} at ${width} px is readable: no table cuts a number, no label lies over another`, async () => {
      const { page, complaints, close } = await opened(file, { width });
      const { found, charts: drawn } = await page.evaluate(unreadable);
      assert.deepEqual(found, []);
      assert.equal(drawn, await page.locator('figure').count());
      assert.deepEqual(complaints, []);
      await close();
    });
  }
}

test('every kind of page that the command writes was made', () => assert.ok(kinds.length >= 4 + 14, kinds.join(', ')));

test('a change to dark redraws the charts in the dark colours', async () => {
  const { page, close } = await opened('identification.html');
  const dark = '#e9eef3';  // --measured in style.css; none of the light colours is near it on a chart
  await page.emulateMedia({ colorScheme: 'dark' });
  await page.waitForTimeout(200);
  assert.equal(await page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue('--measured').trim()), dark);
  assert.ok(await pixelsLike(page, 'Angle', '--measured') > 1000);
  await close();
});

test('lines, bands, strips and bars carry their meaning\'s colour', async () => {
  const { page, close } = await opened('every_part.html');
  const long = 'A long series with gaps, a band and states';
  for (const name of ['--measured', '--stiffness', '--state-valid', '--state-fault']) {
    assert.ok(await pixelsLike(page, long, name) > 200, `${name} in the long chart`);
  }
  assert.ok(await pixelsLike(page, 'Bars with intervals', '--model') > 500, 'bars of the model');
  assert.equal(await pixelsLike(page, 'A cloud', '--damping'), 0, 'a colour that is not in use does not occur');
  await close();
});

test('strings of the data stay text', async () => {
  const { page, close } = await opened('every_part.html');
  assert.equal(await page.locator('img').count(), 0);
  const heading = await page.locator('h1').textContent();
  assert.ok(heading.includes('</script><img src=x onerror=alert(1)> & <!-- " \' ` ${x} \u2028 \ufffd'), heading);
  assert.ok(heading.endsWith('$& \\u003c'), heading);
  assert.equal(await page.title(), heading);
  await close();
});

test('a gap in the data is a gap in the document and a dash in a table', async () => {
  const { page, close } = await opened('every_part.html');
  const series = await page.evaluate(() => JSON.parse(document.getElementById('document').textContent)
    .parts.find((part) => part.kind === 'line_chart').series[0]);
  assert.equal(series.samples, 100_000);
  assert.equal(series.x.length, 20_000);
  // 4,000 of 100,000 samples are missing in one run: as many of the 20,000 that are kept, give or take the run's ends.
  const missing = series.y.filter((value) => value === null).length;
  assert.ok(missing >= 799 && missing <= 801, `${missing} gaps`);
  assert.equal(await page.locator('table').first().locator('tbody tr').nth(2).locator('td').first().textContent(), '\u2013');
  await close();
});

test('a zoom of one chart is a zoom of its group, and one button shows all again', async () => {
  const { page, complaints, close } = await opened('every_part.html');
  const [first, second] = [0, 1].map((i) => page.locator('figure').nth(i));
  const pixels = async () => (await inkOfCharts(page)).map(({ inked }) => inked).slice(0, 2);
  const whole = await pixels();
  await first.locator('.plot').scrollIntoViewIfNeeded();
  const box = await first.locator('.plot').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + 100);
  await page.keyboard.down('Control');
  for (let i = 0; i < 12; i++) await page.mouse.wheel(0, -240);
  await page.keyboard.up('Control');
  await page.waitForTimeout(400);
  assert.equal(await first.locator('.reset').isVisible(), true);
  assert.equal(await second.locator('.reset').isVisible(), true);
  const zoomed = await pixels();
  assert.notDeepEqual(zoomed, whole);
  await page.mouse.move(0, 0);
  await second.locator('.reset').click();
  await page.waitForTimeout(400);
  assert.equal(await first.locator('.reset').isVisible(), false);
  assert.deepEqual(await pixels(), whole);
  assert.deepEqual(complaints, []);
  await close();
});

test('works by keyboard: a legend entry hides its line, a table holds the numbers', async () => {
  const { page, complaints, close } = await opened('every_part.html');
  const long = 'A long series with gaps, a band and states';
  const entry = page.getByRole('button', { name: 'wave' });
  const shown = await pixelsLike(page, long, '--measured');
  await entry.focus();
  await page.keyboard.press('Enter');
  assert.equal(await entry.getAttribute('aria-pressed'), 'false');
  await page.waitForTimeout(200);
  assert.ok(await pixelsLike(page, long, '--measured') < shown / 4);
  const summary = page.locator('figure').first().locator('summary');
  await summary.focus();
  await page.keyboard.press('Enter');
  const rows = page.locator('figure').first().locator('details tbody tr');
  await rows.first().waitFor();
  assert.equal(await rows.count(), 25);
  assert.equal(await page.locator('.plot:not([aria-label])').count(), 0);
  assert.deepEqual(complaints, []);
  await close();
});

test('a tooltip says value and interval', async () => {
  const { page, complaints, close } = await opened('identification.html');
  const plot = page.locator('figure', { hasText: 'Stiffness C' }).locator('.plot').first();
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.4);
  const tip = plot.locator('.tip');
  await tip.waitFor();
  // C settles at 22.7 -+ 0.4 % and its band is 1.96 times that: 0.18.
  assert.match(await tip.textContent(), /Time 3\d\.\d+ s.*22\.\d+ \u00b1 0\.18.*valid/s);
  assert.deepEqual(complaints, []);
  await close();
});

test('a tooltip names every line that is seen, also where each is thinned in its own way', async () => {
  const { page, complaints, close } = await opened('diagnosis.html');
  const figure = page.locator('figure', { hasText: 'Measured less simulated' });
  const plot = figure.locator('.plot').first();
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  const rows = async (share) => {
    await page.mouse.move(box.x + box.width * share, box.y + box.height * 0.4);
    await plot.locator('.tip').waitFor();
    await page.waitForTimeout(200);
    return plot.locator('.tip .row').count();
  };
  const entries = figure.getByRole('button', { pressed: true });
  const lines = await entries.count();
  assert.ok(lines >= 2, `${lines} lines tell nothing apart`);
  for (const share of [0.3, 0.47, 0.55, 0.71]) assert.equal(await rows(share), lines);
  await entries.first().click();
  assert.equal(await rows(0.52), lines - 1);
  assert.deepEqual(complaints, []);
  await close();
});

test('a diagnosis answers on its first screen', async () => {
  for (const width of widths) {
    const { page, complaints, close } = await opened('diagnosis.html', { width });
    const verdict = await page.locator('.verdict').boundingBox();
    assert.ok(verdict.y + verdict.height < 450, 'the sentence stands in the upper half of the window');
    assert.match(await page.locator('.verdict').textContent(), /gap/);
    assert.ok((await page.locator('.numbers').boundingBox()).y < 700);
    assert.deepEqual(complaints, []);
    await close();
  }
});

/** What a button under the first chart of this title saves. */
async function saved(page, title, button) {
  const [download] = await Promise.all([page.waitForEvent('download'),
    page.locator('figure', { hasText: title }).first().getByRole('button', { name: button, exact: true }).click()]);
  return { name: download.suggestedFilename(), text: readFileSync(await download.path(), 'utf8') };
}

test('a chart saves as SVG as it is shown, in the light colours, and its numbers as CSV', async () => {
  const { page, complaints, close } = await opened('every_part.html');
  await page.emulateMedia({ colorScheme: 'dark' });
  const long = 'A long series with gaps, a band and states';
  await page.getByRole('button', { name: 'slow' }).first().click();  // hides it
  const picture = await saved(page, long, 'SVG');
  assert.equal(picture.name, 'a_long_series_with_gaps_a_band_and_states.svg');
  const parsed = await page.evaluate((text) => {
    const svg = new DOMParser().parseFromString(text, 'image/svg+xml');
    return { root: svg.documentElement.nodeName, words: [...svg.querySelectorAll('text')].map((one) => one.textContent),
      strokes: [...svg.querySelectorAll('[stroke]')].map((one) => one.getAttribute('stroke')) };
  }, picture.text);
  assert.equal(parsed.root, 'svg');
  for (const word of ['Time (s)', 'Value (rad)', 'wave']) assert.ok(parsed.words.includes(word), `${word} in ${parsed.words}`);
  assert.ok(!parsed.words.includes('slow'), 'what is hidden is not in the legend');
  assert.ok(parsed.strokes.includes('#16202b'), '--measured of style.css, light');
  const table = await saved(page, long, 'CSV');
  const lines = table.text.trimEnd().split('\n');
  // Each line is thinned by itself, so that each has stamps of its own.
  assert.equal(lines[0], 'Time (s),wave (rad),Time (s),slow (rad),"slow, sd (rad)"');
  assert.equal(lines.length, 1 + 20_000);
  assert.ok(lines.some((line) => /^\d+\.?\d*,,/.test(line)), 'a gap is an empty cell');
  assert.deepEqual(complaints, []);
  await close();
});

test('strings of the data stay text in a saved picture', async () => {
  const { page, close } = await opened('every_part.html');
  const picture = await saved(page, 'Its companion', 'SVG');
  const found = await page.evaluate((text) => {
    const svg = new DOMParser().parseFromString(text, 'image/svg+xml');
    return { root: svg.documentElement.nodeName, foreign: svg.querySelectorAll('img, script, foreignObject, parsererror').length };
  }, picture.text);
  assert.deepEqual(found, { root: 'svg', foreign: 0 });
  await close();
});

test('a printed page has pictures of lines, dark on white, whatever the screen shows', async () => {
  const { page, complaints, close } = await opened('identification.html');
  await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
  await page.evaluate(() => window.dispatchEvent(new Event('beforeprint')));
  const pictures = page.locator('img.printed');
  assert.equal(await pictures.count(), charts['identification.html']);
  await page.waitForFunction(() => [...document.querySelectorAll('img.printed')].every((one) => one.complete && one.naturalWidth > 600));
  const shown = await page.evaluate(() => ({ plots: [...document.querySelectorAll('.plot')].filter((one) => one.offsetHeight > 0).length,
    ink: getComputedStyle(document.documentElement).getPropertyValue('--ink').trim() }));
  assert.deepEqual(shown, { plots: 0, ink: '#16202b' });
  await page.evaluate(() => window.dispatchEvent(new Event('afterprint')));
  assert.equal(await pictures.count(), 0);
  const pdf = await page.pdf({ format: 'A4', printBackground: true });
  assert.ok(pdf.length > 50_000, `${pdf.length} bytes`);
  assert.deepEqual(complaints, []);
  await close();
});

test('a long page begins with its contents, a short one does not', async () => {
  const { page, close } = await opened('identification.html');
  const targets = await page.locator('nav.contents a').evaluateAll((links) => links.map((link) =>
    [link.textContent, document.querySelector(link.getAttribute('href'))?.textContent]));
  assert.ok(targets.length >= 3);
  for (const [said, found] of targets) assert.equal(found, said);
  await close();
  const short = await opened('empty.html');
  assert.equal(await short.page.locator('nav.contents').count(), 0);
  await short.close();
});

test('a heat map says value and place where the pointer is', async () => {
  const { page, close } = await opened('every_part.html');
  const plot = page.locator('figure', { hasText: 'A difference' }).locator('.plot').first();
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width * 0.35, box.y + 85);
  const tip = plot.locator('.tip');
  await tip.waitFor();
  assert.match(await tip.textContent(), /task: passive; hands: right_3change\u22123\.00 %/);
  assert.equal(await tip.locator('.dot').count(), 1);
  await close();
});

test('every link of a fleet leads to a table of its page or below its own folder', async () => {
  const { page, complaints, close } = await opened('fleet.html');
  const links = await page.locator('table a').evaluateAll((all) => all.map((link) => link.getAttribute('href')));
  assert.ok(links.length > 50, `${links.length} links`);
  const lost = await page.evaluate((hrefs) => hrefs.filter((href) =>
    href.startsWith('#') ? !document.getElementById(href.slice(1)) : !/^\.\.?\//.test(href)), links);
  assert.deepEqual(lost, []);
  assert.match(await page.locator('.verdict').textContent(), /add coulomb_friction, in (2\d|3\d)/);
  assert.ok(await page.locator('#outliers tbody').getByText('VIN077').count() > 0);
  assert.deepEqual(complaints, []);
  await close();
});

test('without JavaScript the page says what is missing', async () => {
  const { page, close } = await opened('empty.html', { javaScriptEnabled: false });
  assert.match(await page.locator('body').innerText(), /JavaScript/);
  await close();
});

test('a page without data stays below 1 MB', () => {
  const bytes = statSync(join(folder, 'empty.html')).size;
  assert.ok(bytes > 300_000 && bytes < 1_000_000, `${bytes} bytes`);
});

test('the report of the experiment draws every chart, at both widths, without a word in the console', async () => {
  for (const width of widths) {
    const { page, complaints, requests, close } = await opened('experiment/report.html', { width });
    const ink = await inkOfCharts(page);
    assert.ok(ink.length >= 18, `${ink.length} charts`);
    for (const { inked, title } of ink) assert.ok(inked > 1000, `${title} is drawn (${inked} pixels)`);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    assert.ok(wide <= 0, `the page is ${wide} px wider than the window`);
    assert.deepEqual(complaints, []);
    assert.equal(requests.filter((url) => !url.startsWith('data:')).length, 1);
    await close();
  }
});
