// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A table: units under the column heads, numbers right-aligned, states as badges, the first column as row heads.
import type { Cell, Column, Table } from './document';
import { badge, element, link } from './dom';
import { number } from './format';

export function table(part: Table): HTMLElement {
  return element('section', { class: 'card', 'aria-label': part.title, ...(part.key ? { id: part.key } : {}) },
    element('h3', {}, part.title),
    part.caption && element('p', { class: 'caption' }, part.caption),
    scrolling(part.title, grid(part.columns, part.rows)));
}

/** A box that scrolls sideways by touch and by keyboard, so that a wide table never widens the page. */
export function scrolling(label: string, content: HTMLElement): HTMLElement {
  return element('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': label }, content);
}

export function grid(columns: Column[], rows: Cell[][]): HTMLElement {
  const heads = columns.map((column) => element('th', { scope: 'col', class: column.numeric ? 'numeric' : 'words' },
    column.label, column.unit && element('span', { class: 'unit' }, column.unit)));
  const lines = rows.map((row) => element('tr', {}, ...row.map((cell, i) => entry(cell, columns[i], i === 0))));
  return element('table', {}, element('thead', {}, element('tr', {}, ...heads)), element('tbody', {}, ...lines));
}

function entry(cell: Cell, column: Column, first: boolean): HTMLElement {
  const content = cell === null || typeof cell === 'number' ? number(cell, column.digits)
    : typeof cell === 'string' ? cell : 'state' in cell ? badge(cell.state) : link(cell);
  const kind = { class: column.numeric ? 'numeric' : 'words' };
  return first && !column.numeric ? element('th', { scope: 'row', ...kind }, content) : element('td', kind, content);
}
