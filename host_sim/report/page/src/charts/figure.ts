// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The frame of every chart: title, legend that works by keyboard, the plot, and the numbers as a table for those who
// cannot see or do not want the picture. It also redraws when the width or the colour scheme changes.
import { element } from '../dom';
import { count } from '../format';
import { fitting, grid } from '../table';
import { lightTheme, onThemeChange, theme } from '../theme';
import { init, type EChartsType } from './echarts';
import type { Figure, Key } from './frame';
import { csv, fileName, svg, type View } from './svg';

const waiting: (() => void)[] = [];

/** Draws the figures made so far: a chart needs its width, which it has only once it stands in the page. */
export function drawAll(): void {
  for (const draw of waiting.splice(0)) draw();
}

export function figure(made: Figure): HTMLElement {
  const plot = element('div', { class: 'plot', role: 'img', 'aria-label': `${made.title}. ${made.summary}` });
  const save = element('span', { class: 'save' });
  const under = element('div', { class: 'under' }, numbersTable(made), save);
  const legend = element('ul', { class: 'legend', 'aria-label': 'Legend' });
  waiting.push(() => {
    const fit = () => { plot.style.height = `${made.height(plot.clientWidth)}px`; };
    fit();
    const chart = init(plot, null, { renderer: 'canvas' });
    const redraw = () => {
      fit();
      chart.resize();
      chart.setOption(made.option(theme(), plot.clientWidth), { notMerge: true });
    };
    for (const key of made.keys) legend.append(element('li', {}, keyItem(key, chart)));
    redraw();
    followWidth(chart, plot, redraw);
    onThemeChange(redraw);
    made.ready?.(chart, under);
    const view = () => viewOf(chart, legend);
    save.append(
      saving('SVG', `${fileName(made.title)}.svg`, 'image/svg+xml', () => svg(made, paper(), plot.clientWidth, view())),
      saving('CSV', `${fileName(made.title)}.csv`, 'text/csv', () => csv(made.numbers)));
    onPrint(plot, () => svg(made, paper(), printedWidth, view()));
  });
  return element('figure', { class: 'card' },
    element('figcaption', {},
      element('h3', {}, made.title),
      made.caption && element('p', { class: 'caption' }, made.caption)),
    made.keys.length > 0 && legend, plot, under);
}

const littleWider = 40;  // CSS pixels: more than a scroll bar

/** Redraws from the option only when the width has changed by more than a scroll bar, so that a zoom survives one. */
function followWidth(chart: EChartsType, plot: HTMLElement, redraw: () => void): void {
  let drawn = plot.clientWidth;
  new ResizeObserver(() => {
    chart.resize();
    if (Math.abs(plot.clientWidth - drawn) <= littleWider) return;
    drawn = plot.clientWidth;
    redraw();
  }).observe(plot);
}

const printedWidth = 680;  // CSS pixels: what A4 and letter have between their margins
const paper = () => lightTheme(document.querySelector('style')?.textContent ?? '');

function viewOf(chart: EChartsType, legend: HTMLElement): View {
  const zoom = (chart.getOption().dataZoom as { start: number; end: number }[] | undefined)?.[0];
  const hidden = [...legend.querySelectorAll('button[aria-pressed="false"]')].map((button) => button.textContent ?? '');
  return { hidden, start: zoom?.start ?? 0, end: zoom?.end ?? 100 };
}

function saving(label: string, name: string, type: string, content: () => string): HTMLElement {
  const button = element('button', { type: 'button', title: `Save as ${name}` }, label);
  button.addEventListener('click', () => {
    const url = URL.createObjectURL(new Blob([content()], { type }));
    element('a', { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 60_000);
  });
  return button;
}

/** Paper gets a picture of lines in the light colours instead of the screen's pixels. As an image, so that no string of
 * the data becomes a part of the page. */
function onPrint(plot: HTMLElement, draw: () => string): void {
  let picture: HTMLElement | undefined;
  addEventListener('beforeprint', () => {
    picture?.remove();
    picture = element('img', { class: 'printed', alt: '', src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(draw())}` });
    plot.after(picture);
  });
  addEventListener('afterprint', () => {
    picture?.remove();
    picture = undefined;
  });
}

function keyItem(key: Key, chart: EChartsType): HTMLElement {
  const content = [element('span', { class: `key ${key.look}` }), key.name];
  const tint = `--tint: var(--${key.colour})`;
  if (!key.toggles) return element('span', { class: 'fixed', style: tint }, ...content);
  const button = element('button', { type: 'button', 'aria-pressed': 'true', style: tint,
    title: 'Show or hide' }, ...content);
  button.addEventListener('click', () => {
    const shown = button.getAttribute('aria-pressed') === 'true';
    button.setAttribute('aria-pressed', String(!shown));
    chart.dispatchAction({ type: shown ? 'legendUnSelect' : 'legendSelect', name: key.name });
  });
  return button;
}

const rowsShown = 25;

function numbersTable(made: Figure): HTMLElement {
  const { columns, rows, row } = made.numbers;
  const shown = Math.min(rows, rowsShown);
  const index = (i: number) => (rows <= rowsShown ? i : Math.round((i * (rows - 1)) / (rowsShown - 1)));
  const details = element('details', {}, element('summary', {}, 'Numbers'));
  // Built when first opened: most readers never do.
  details.addEventListener('toggle', () => {
    if (details.children.length > 1) return;
    if (shown < rows) details.append(element('p', {}, `${shown} of ${count(rows)} rows, evenly spaced.`));
    details.append(fitting(`${made.title}: numbers`,
      grid(columns, Array.from({ length: shown }, (_, i) => row(index(i))))));
  });
  return details;
}
