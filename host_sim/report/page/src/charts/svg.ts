// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A chart as a file of its own: SVG with its legend inside, and its numbers as CSV.
import { withUnit } from '../dom';
import type { Cell } from '../document';
import type { Theme } from '../theme';
import { init, type EChartsOption } from './echarts';
import type { Figure, Key, Numbers } from './frame';

/** What a reader has made of a chart: which lines are hidden, and the stretch of the x axis in percent. */
export type View = { hidden: string[]; start: number; end: number };

const font = 12;
const letter = 0.55 * font;  // the mean width of a letter; the renderer has no fonts to measure
const row = 20;

type Grid = { top?: number; height?: number };

/** `width` in CSS pixels; the height is the chart's own and the legend's. */
export function svg(made: Figure, theme: Theme, width: number, view?: View): string {
  const legend = legendOf(made.keys.filter(({ name }) => !view?.hidden.includes(name)), theme, width);
  const option = made.option(theme, width) as Record<string, any>;
  const lower = (grid: Grid) => (grid.top === undefined ? grid : { ...grid, top: grid.top + legend.height });
  const chart = init(null, null, { renderer: 'svg', ssr: true, width, height: made.height(width) + legend.height });
  chart.setOption({
    ...option, tooltip: undefined, graphic: legend.elements,
    grid: Array.isArray(option.grid) ? option.grid.map(lower) : lower(option.grid),
    ...(option.visualMap ? { visualMap: { ...option.visualMap, top: legend.height } } : {}),
    ...(option.legend && view ? { legend: { ...option.legend, selected: Object.fromEntries(view.hidden.map((name) => [name, false])) } } : {}),
    dataZoom: option.dataZoom && view ? [{ ...option.dataZoom[0], start: view.start, end: view.end }] : [],
  } as EChartsOption);
  const text = chart.renderToSVGString();
  chart.dispose();
  return text;
}

/** The same on paper: as wide as `millimetres`, drawn for `width` pixels, so that 12 px are 12 / width of it. */
export function svgOnPaper(made: Figure, theme: Theme, width: number, millimetres: number): string {
  const sized = (pixels: string) => `${(Number(pixels) * millimetres / width).toFixed(2)}mm`;
  return svg(made, theme, width).replace(/^<svg width="([\d.]+)" height="([\d.]+)"/,
    (_, w, h) => `<svg width="${sized(w)}" height="${sized(h)}"`);
}

function legendOf(keys: Key[], theme: Theme, width: number): { height: number; elements: object[] } {
  if (keys.length === 0) return { height: 0, elements: [] };
  let x = 4;
  let line = 0;
  const elements = keys.flatMap((key) => {
    const wide = 26 + letter * key.name.length + 12;
    if (x > 4 && x + wide > width) {
      x = 4;
      line++;
    }
    const at = { x, y: 6 + row * line };
    x += wide;
    return [symbol(key, theme, at),
      { type: 'text', silent: true, x: at.x + 26, y: at.y, style: { text: key.name, fill: theme.ink, font: `${font}px ${theme.font}` } }];
  });
  return { height: row * (line + 1), elements };
}

function symbol({ look, colour }: Key, theme: Theme, at: { x: number; y: number }): object {
  const fill = theme.property(`--${colour}`);
  const middle = at.y + font / 2;
  switch (look) {
    case 'line':
    case 'dashed':
      return { type: 'line', silent: true, shape: { x1: at.x, y1: middle, x2: at.x + 20, y2: middle },
        style: { stroke: fill, lineWidth: 2.5, lineDash: look === 'dashed' ? [5, 3] : undefined } };
    case 'points':
      return { type: 'circle', silent: true, shape: { cx: at.x + 10, cy: middle, r: 4 }, style: { fill } };
    default:
      return { type: 'rect', silent: true, shape: { x: at.x + 2, y: at.y, width: 16, height: font },
        style: { fill, opacity: look === 'band' ? 0.3 : 1 } };
  }
}

/** RFC 4180: a header with units, and every row in full precision. */
export function csv(numbers: Numbers): string {
  const lines = [numbers.columns.map(({ label, unit }) => quoted(withUnit(label, unit))).join(',')];
  for (let i = 0; i < numbers.rows; i++) lines.push(numbers.row(i).map(written).join(','));
  return `${lines.join('\n')}\n`;
}

function written(cell: Cell): string {
  if (cell === null) return '';
  if (typeof cell === 'number') return String(cell);
  if (typeof cell === 'string') return quoted(cell);
  return quoted('state' in cell ? cell.state : cell.text);
}

function quoted(text: string): string {
  return /[",\r\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

/** What a file of this title is called, without its ending. */
export function fileName(title: string): string {
  return title.toLowerCase().replace(/[^a-z0-9]+/g, '_').replace(/^_|_$/g, '').slice(0, 60) || 'chart';
}
