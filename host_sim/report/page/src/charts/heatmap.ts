// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A matrix as colours, the number in each cell where it fits. Diverging matrices have their middle at zero.
import type { Heatmap } from '../document';
import { inUnit, withUnit } from '../dom';
import { number } from '../format';
import type { Theme } from '../theme';
import { base, categoryAxis, tip, tooltip } from './axes';
import type { EChartsOption } from './echarts';
import { narrow, type Figure } from './frame';

export function heatmap(part: Heatmap): Figure {
  return {
    title: part.title, caption: part.caption, height: 140 + Math.max(2, part.rows.length) * 30,
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

function option(part: Heatmap, colours: Theme, width: number): EChartsOption {
  const room = narrow(width) ? 84 : 150;
  const cell = (width - room - 20) / Math.max(1, part.columns.length);
  const { min, max } = limits(part);
  const longest = Math.max(...part.values.flat().map((value) => number(value, part.digits).length));
  // Where the colour is strong, the number on it is written in the surface's colour.
  const strong = (value: number | null) => value !== null && (part.diverging ? Math.abs(value) > 0.6 * max : value > (min + max) / 2);
  const cells = part.values.flatMap((row, y) => row.map((value, x) => ({
    value: [x, y, value], label: { color: strong(value) ? colours.surface : colours.ink } })));
  const tilted = part.columns.some((name) => name.length * 7 > cell);
  const x = categoryAxis(part.columns, colours, tilted ? 90 : cell);
  return {
    ...base(colours), grid: { left: room, right: 20, top: 56, bottom: tilted ? 88 : 46 },
    xAxis: { ...x, axisLabel: { ...x.axisLabel, rotate: tilted ? 40 : 0 },
      name: part.x_label, nameLocation: 'middle', nameGap: tilted ? 70 : 28 },
    yAxis: { ...categoryAxis(part.rows, colours, room - 10), inverse: true,
      name: part.y_label, nameLocation: 'start', nameGap: 8, nameTextStyle: { color: colours.soft, align: 'right', padding: [0, 8, 0, 0] } },
    visualMap: { type: 'continuous', min, max, dimension: 2, orient: 'horizontal', left: 0, top: 0, itemWidth: 12,
      itemHeight: narrow(width) ? 110 : 180, calculable: false, textStyle: { color: colours.soft },
      text: ['', withUnit(part.value.label, part.value.unit)],
      inRange: { color: part.diverging ? ['--below', '--middle', '--above'].map(colours.property) : ['--low', '--high'].map(colours.property) } },
    tooltip: tooltip(colours, 'item', (hit) => {
      const [column, row, value] = (hit as { value: [number, number, number | null] }).value;
      const { color } = hit as { color?: string };
      return tip(`${part.rows[row]}, ${part.columns[column]}`, [{ name: part.value.label, colour: typeof color === 'string' ? color : undefined,
        amount: inUnit(number(value, part.digits), part.value.unit) }]);
    }),
    series: [{ type: 'heatmap', data: cells, itemStyle: { borderColor: colours.surface, borderWidth: 1 },
      label: { show: cell > 6.4 * longest + 4, fontSize: 11,
        formatter: (hit: unknown) => number((hit as { value: (number | null)[] }).value[2], part.digits) },
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
