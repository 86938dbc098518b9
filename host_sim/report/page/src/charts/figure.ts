// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The frame of every chart: title, legend that works by keyboard, the plot, and the numbers as a table for those who
// cannot see or do not want the picture. It also redraws when the width or the colour scheme changes.
import type { Cell, Column } from '../document';
import { element } from '../dom';
import { count } from '../format';
import { grid, scrolling } from '../table';
import { onThemeChange, theme, type Theme } from '../theme';
import { init, type EChartsOption, type EChartsType } from './echarts';

export type Key = { name: string; colour: string; look: 'line' | 'dashed' | 'points' | 'band' | 'block'; toggles: boolean };
export type Numbers = { columns: Column[]; rows: number; row(index: number): Cell[] };
export type Figure = {
  title: string; caption?: string; summary: string; height: number;
  keys: Key[]; numbers: Numbers; remark?: string;
  option(theme: Theme, width: number): EChartsOption;
  /** Called once with the chart and the line under it, for zoom and links. */
  ready?(chart: EChartsType, under: HTMLElement): void;
};

const waiting: (() => void)[] = [];

/** Draws the figures made so far: a chart needs its width, which it has only once it stands in the page. */
export function drawAll(): void {
  for (const draw of waiting.splice(0)) draw();
}

export function figure(made: Figure): HTMLElement {
  const plot = element('div', { class: 'plot', role: 'img', 'aria-label': `${made.title}. ${made.summary}`,
    style: `height:${made.height}px` });
  const under = element('div', { class: 'under' }, numbersTable(made));
  const legend = element('ul', { class: 'legend', 'aria-label': 'Legend' });
  waiting.push(() => {
    const chart = init(plot, null, { renderer: 'canvas' });
    const redraw = () => chart.setOption(made.option(theme(), plot.clientWidth), { notMerge: true });
    for (const key of made.keys) legend.append(element('li', {}, keyItem(key, chart)));
    redraw();
    followWidth(chart, plot, redraw);
    onThemeChange(redraw);
    made.ready?.(chart, under);
  });
  return element('figure', { class: 'card' },
    element('figcaption', {},
      element('h3', {}, made.title),
      made.caption && element('p', { class: 'caption' }, made.caption)),
    made.keys.length > 0 && legend, plot, under);
}

/** Redraws from the option only when a breakpoint is crossed, so that a zoom survives a turn of the phone's scroll bar. */
function followWidth(chart: EChartsType, plot: HTMLElement, redraw: () => void): void {
  let drawnNarrow = narrow(plot.clientWidth);
  new ResizeObserver(() => {
    chart.resize();
    if (narrow(plot.clientWidth) === drawnNarrow) return;
    drawnNarrow = !drawnNarrow;
    redraw();
  }).observe(plot);
}

export function narrow(width: number): boolean {
  return width < 560;
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
    details.append(scrolling(`${made.title}: numbers`,
      grid(columns, Array.from({ length: shown }, (_, i) => row(index(i))))));
  });
  return details;
}
