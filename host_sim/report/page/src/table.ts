// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A table: units under the column heads, numbers right-aligned, states as badges, the first column as row heads. Where it
// is wider than its card, each row becomes a block in which every cell stands under the name of its column: no number is
// cut at an edge, and nobody has to scroll sideways.
import type { Cell, Column, Table } from './document';
import { badge, element, link, withUnit } from './dom';
import { fixed, number } from './format';

export function table(part: Table): HTMLElement {
  return element('section', { class: 'card', 'aria-label': part.title, ...(part.key ? { id: part.key } : {}) },
    element('h3', {}, part.title),
    part.caption && element('p', { class: 'caption' }, part.caption),
    fitting(part.title, grid(part.columns, part.rows)));
}

const blocksShown = 12;  // of a long table whose rows are blocks, until the reader asks for all

/** The table in a box that it fits in, whatever the box's width becomes. */
export function fitting(label: string, content: HTMLTableElement): HTMLElement {
  const box = element('div', { class: 'fitting', role: 'region', 'aria-label': label }, content);
  const rows = content.tBodies[0].rows.length;
  if (rows > blocksShown) {
    const all = element('button', { type: 'button', class: 'all' }, `All ${rows} rows`);
    all.addEventListener('click', () => content.classList.remove('folded'));
    content.classList.add('folded');
    box.append(all);
  }
  let width = -1;
  new ResizeObserver(() => {
    if (box.clientWidth === width) return;  // it was this function that changed the height
    width = box.clientWidth;
    content.classList.remove('stacked');
    content.classList.toggle('stacked', content.scrollWidth > box.clientWidth);
  }).observe(box);
  return box;
}

export function grid(columns: Column[], rows: Cell[][]): HTMLTableElement {
  const heads = columns.map((column) => element('th', { scope: 'col', class: column.numeric ? 'numeric' : 'words' },
    column.label, column.unit && element('span', { class: 'unit' }, column.unit)));
  const shown = columns.map((column, i) => shownAs(column, rows.map((row) => row[i])));
  const lines = rows.map((row) => element('tr', {}, ...row.map((cell, i) => entry(cell, columns[i], shown[i], i === 0))));
  return element('table', {}, element('thead', {}, element('tr', {}, ...heads)), element('tbody', {}, ...lines));
}

type Shown = (value: number | null) => string;

/** Counts as counts: a column of whole numbers has no decimals. */
function shownAs(column: Column, cells: Cell[]): Shown {
  const numbers = cells.filter((cell): cell is number => typeof cell === 'number');
  const whole = numbers.every((value) => Number.isInteger(value) && Math.abs(value) < 1e7);
  return (value) => (whole ? fixed(value, 0) : number(value, column.digits));
}

/** A number and its unit stay on one line. */
const together = (text: string) => text.replace(/(\d) (?=(%|s|ms|h|Hz|Nm|rad|Nm\/rad|1\/h)\b|%)/g, '$1\u00a0');

function entry(cell: Cell, column: Column, shown: Shown, first: boolean): HTMLElement {
  const content = cell === null || typeof cell === 'number' ? shown(cell)
    : typeof cell === 'string' ? together(cell) : 'state' in cell ? badge(cell.state) : link(cell);
  const kind = { class: column.numeric ? 'numeric' : 'words', 'data-label': withUnit(column.label, column.unit) };
  return first && !column.numeric ? element('th', { scope: 'row', ...kind }, content) : element('td', kind, content);
}
