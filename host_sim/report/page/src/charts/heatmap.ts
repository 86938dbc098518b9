// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A matrix as colours, the number in each cell where few do and they fit. Diverging matrices have their middle at zero.
import type { Heatmap } from '../document';
import { inUnit, withUnit } from '../dom';
import { fixed } from '../format';
import type { Theme } from '../theme';
import { base, categoryAxis, tip, tooltip } from './axes';
import type { EChartsOption } from './echarts';
import { narrow, type Figure } from './frame';
import { tallest, widthOf } from './labels';

const mostNumbers = 60;  // in cells; of more nobody reads them, and colours and tooltips tell

export function heatmap(part: Heatmap): Figure {
  const row = (width: number) => Math.max(30, tallest(part.rows, roomFor(part, width)) + 6);
  return {
    title: part.title, caption: part.caption,
    height: (width) => 94 + Math.max(2, part.rows.length) * row(width) + below(part, width),
    summary: `${part.value.label} by ${part.y_label} and ${part.x_label}, ${part.rows.length} by ${part.columns.length} cells.`,
    keys: [],
    numbers: {
      columns: [{ label: part.y_label, digits: 4, numeric: false },
        ...part.columns.map((label) => ({ label, unit: part.value.unit, digits: part.digits, numeric: true }))],
      rows: part.rows.length, row: (i) => [part.rows[i], ...part.values[i]],
    },
    option: (colours, width) => option(part, colours, width),
  };
}

/** Pixels for the names of the rows. */
function roomFor(part: Heatmap, width: number): number {
  const most = narrow(width) ? 96 : 190;
  return Math.min(most, Math.max(48, ...part.rows.map((name) => widthOf(name) + 4)));
}

const cellWidth = (part: Heatmap, width: number) => (width - roomFor(part, width) - 30) / Math.max(1, part.columns.length);
const upright = (part: Heatmap, width: number) => part.columns.some((name) => widthOf(name) + 6 > cellWidth(part, width));

const mostBelow = 180;  // pixels for a column's name that stands upright

/** Pixels below the cells: the names of the columns, level or upright, and of the axis. */
function below(part: Heatmap, width: number): number {
  return upright(part, width) ? Math.min(mostBelow, Math.max(...part.columns.map(widthOf))) + 40 : 46;
}

/** Every cell in the same decimals: those in which the largest has `digits` digits, none where all are whole. */
function decimalsOf(part: Heatmap): number {
  const known = part.values.flat().filter((value): value is number => value !== null);
  const most = [...known, ...(part.value.range ?? [])].reduce((a, b) => Math.max(a, Math.abs(b)), 0);
  if (most === 0 || known.every(Number.isInteger)) return 0;
  return Math.min(12, Math.max(0, part.digits - Math.ceil(Math.log10(most))));
}

function option(part: Heatmap, colours: Theme, width: number): EChartsOption {
  const room = roomFor(part, width);
  const cell = cellWidth(part, width);
  const { min, max } = limits(part);
  const decimals = decimalsOf(part);
  const written = (value: number | null) => fixed(value, decimals);
  const known = part.values.flat().filter((value) => value !== null);
  const longest = Math.max(...known.map((value) => written(value).length));
  // Where the colour is strong, the number on it is written in the surface's colour.
  const strong = (value: number | null) => value !== null && (part.diverging ? Math.abs(value) > 0.6 * max : value > (min + max) / 2);
  const cells = part.values.flatMap((row, y) => row.map((value, x) => ({
    value: [x, y, value], label: { color: strong(value) ? colours.surface : colours.ink } })));
  const tall = upright(part, width);
  const scale = [written(max), `${withUnit(part.value.label, part.value.unit)}  ${written(min)}`];
  const x = categoryAxis(part.columns, colours, tall ? mostBelow : cell);
  return {
    ...base(colours), grid: { left: room + 10, right: 20, top: 56, bottom: below(part, width) },
    xAxis: { ...x, axisLabel: { ...x.axisLabel, rotate: tall ? 90 : 0 },
      name: part.x_label, nameLocation: 'middle', nameGap: below(part, width) - 18 },
    yAxis: { ...categoryAxis(part.rows, colours, room), inverse: true,
      name: part.y_label, nameLocation: 'start', nameGap: 8, nameTextStyle: { color: colours.soft, align: 'left', padding: [0, 0, 0, -room] } },
    visualMap: { type: 'continuous', min, max, dimension: 2, orient: 'horizontal', left: 0, top: 0, itemWidth: 12,
      itemHeight: Math.min(180, width - 80 - widthOf(scale.join(''))), calculable: false, textStyle: { color: colours.soft },
      text: scale, formatter: (value: unknown) => written(value as number),
      inRange: { color: part.diverging ? ['--below', '--middle', '--above'].map(colours.property) : ['--low', '--high'].map(colours.property) } },
    tooltip: tooltip(colours, 'item', (hit) => {
      const [column, row, value] = (hit as { value: [number, number, number | null] }).value;
      const { color } = hit as { color?: string };
      const place = (label: string, name: string) => (label ? `${label}: ${name}` : name);
      return tip(`${place(part.y_label, part.rows[row])}; ${place(part.x_label, part.columns[column])}`, [{ name: part.value.label, colour: typeof color === 'string' ? color : undefined,
        amount: inUnit(written(value), part.value.unit) }]);
    }),
    series: [{ type: 'heatmap', data: cells, itemStyle: { borderColor: colours.surface, borderWidth: 1 },
      label: { show: known.length <= mostNumbers && cell > 6.4 * longest + 4, fontSize: 11,
        formatter: (hit: unknown) => written((hit as { value: (number | null)[] }).value[2]) },
      emphasis: { itemStyle: { borderColor: colours.ink } } }],
  } as EChartsOption;
}

function limits(part: Heatmap): { min: number; max: number } {
  if (part.value.range) return { min: part.value.range[0], max: part.value.range[1] };
  const known = part.values.flat().filter((value): value is number => value !== null);
  const low = known.reduce((a, b) => Math.min(a, b), Infinity);
  const high = known.reduce((a, b) => Math.max(a, b), -Infinity);
  if (known.length === 0) return { min: 0, max: 1 };
  if (!part.diverging) return low < high ? { min: low, max: high } : { min: low - 0.5, max: low + 0.5 };
  const reach = Math.max(Math.abs(low), Math.abs(high)) || 1;
  return { min: -reach, max: reach };
}
