// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Counts between edges, which need not be evenly spaced, and the counts that were expected as points over them.
import type { Histogram } from '../document';
import { inUnit } from '../dom';
import { number } from '../format';
import type { Theme } from '../theme';
import { base, colourName, margins, marksKeys, marksSeries, tip, tooltip, xAxis, yAxis } from './axes';
import type { CustomSeriesOption, EChartsOption } from './echarts';
import type { Figure, Key } from './frame';

export function histogram(part: Histogram): Figure {
  const total = part.counts.reduce((a, b) => a + b, 0);
  const expected: Key[] = part.expected ? [{ name: part.expected_name ?? 'expected', colour: 'reference', look: 'points', toggles: false }] : [];
  const column = (label: string, unit?: string) => ({ label, unit, digits: 5, numeric: true });
  return {
    title: part.title, caption: part.caption, height: () => 300,
    summary: `Histogram of ${part.x.label}, ${total} values in ${part.counts.length} bins.`,
    keys: [{ name: part.name, colour: colourName(part.meaning), look: 'block', toggles: false }, ...expected, ...marksKeys(part.marks)],
    numbers: {
      columns: [column('From', part.x.unit), column('To', part.x.unit), column('Count'), ...(part.expected ? [column('Expected')] : [])],
      rows: part.counts.length,
      row: (i) => [part.edges[i], part.edges[i + 1], part.counts[i], ...(part.expected ? [part.expected[i]] : [])],
    },
    option: (colours, width) => option(part, colours, width),
  };
}

function option(part: Histogram, colours: Theme, width: number): EChartsOption {
  const middles = part.counts.map((_, i) => (part.edges[i] + part.edges[i + 1]) / 2);
  const reach: [number, number] = [part.edges[0] ?? 0, part.edges[part.edges.length - 1] ?? 1];
  return {
    ...base(colours), grid: { ...margins(width), bottom: 46 },
    xAxis: xAxis({ range: reach, ...part.x }, colours),
    yAxis: { ...yAxis({ label: 'count' }, colours, width), min: 0 },
    tooltip: tooltip(colours, 'item', (hit) => {
      const i = (hit as { dataIndex: number }).dataIndex;
      return tip(`${part.x.label} ${inUnit(`${number(part.edges[i])} to ${number(part.edges[i + 1])}`, part.x.unit)}`, [
        { name: part.name, amount: String(part.counts[i]) },
        ...(part.expected ? [{ name: part.expected_name ?? 'expected', amount: number(part.expected[i]) }] : [])]);
    }),
    series: [
      columns(part, colours),
      ...(part.expected ? [{ type: 'scatter' as const, name: 'expected', symbolSize: 7, z: 4, itemStyle: { color: colours.meaning('reference') },
        data: part.expected.map((value, i) => [middles[i], value]) }] : []),
      ...marksSeries(part.marks, [], colours),
    ],
  } as EChartsOption;
}

function columns(part: Histogram, colours: Theme): CustomSeriesOption {
  const renderItem: CustomSeriesOption['renderItem'] = (params, api) => {
    const i = params.dataIndex;
    const [left, top] = api.coord([part.edges[i], part.counts[i]]);
    const [right, bottom] = api.coord([part.edges[i + 1], 0]);
    return { type: 'rect', shape: { x: left + 0.5, y: top, width: Math.max(1, right - left - 1), height: Math.max(0, bottom - top) },
      style: { fill: colours.meaning(part.meaning), opacity: 0.8 } };
  };
  return { type: 'custom', name: part.name, renderItem, clip: true, encode: { x: [0, 1], y: 2 },
    data: part.counts.map((count, i) => [part.edges[i], part.edges[i + 1], count]) };
}
