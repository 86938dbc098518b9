// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Level bars, one row a category, each with its interval: names stay readable however long they are.
import type { BarSeries, Bars, Meaning } from '../document';
import { element, inUnit } from '../dom';
import { number } from '../format';
import type { Theme } from '../theme';
import { base, categoryAxis, colourName, marksSeries, tip, tooltip, xAxis, type TipRow } from './axes';
import type { CustomSeriesOption, EChartsOption } from './echarts';
import { narrow, type Figure } from './frame';

/** Series beside each other that mean nothing in particular still have to be told apart. */
const DISTINCT: Meaning[] = ['reference', 'model', 'measured', 'residual', 'torque_driver', 'torque_motor'];

export function bars(given: Bars): Figure {
  const plain = given.series.length > 1 && given.series.every(({ meaning }) => meaning === 'plain');
  const part = plain ? { ...given, series: given.series.map((series, i) => ({ ...series, meaning: DISTINCT[i % DISTINCT.length] })) } : given;
  const thickness = 14 * part.series.length + 14;
  return {
    title: part.title, caption: part.caption, height: 84 + Math.max(1, part.categories.length) * thickness,
    summary: `${part.value.label} of ${part.categories.length} categories: ${part.series.map(({ name }) => name).join(', ')}.`,
    keys: part.series.map((series) => ({ name: series.name, colour: colourName(series.meaning), look: 'block', toggles: part.series.length > 1 })),
    numbers: {
      columns: [{ label: 'Category', digits: 4, numeric: false }, ...part.series.flatMap((series) => columns(series, part.value.unit))],
      rows: part.categories.length,
      row: (i) => [part.categories[i], ...part.series.flatMap((series) => [series.values[i], ...(hasIntervals(series) ? [series.low[i], series.high[i]] : [])])],
    },
    option: (colours, width) => option(part, colours, width),
  };
}

const hasIntervals = (series: BarSeries) => series.low.length > 0;
const columns = (series: BarSeries, unit?: string) =>
  [series.name, ...(hasIntervals(series) ? [`${series.name}, low`, `${series.name}, high`] : [])]
    .map((label) => ({ label, unit, digits: 4, numeric: true }));

function option(part: Bars, colours: Theme, width: number): EChartsOption {
  const longest = Math.max(0, ...part.categories.map((name) => name.length));
  const room = narrow(width) ? Math.min(0.45 * width, Math.max(60, 7 * longest + 16)) : Math.min(320, Math.max(190, 7 * longest + 16));
  return {
    ...base(colours), grid: { left: room, right: 24, top: 22, bottom: 46 },
    xAxis: { ...xAxis(part.value, colours), scale: false, splitLine: { show: true, lineStyle: { color: colours.grid } } },
    yAxis: { ...categoryAxis(part.categories, colours, room - 10), inverse: true },
    legend: { show: false, data: part.series.map((series) => series.name) },
    tooltip: tooltip(colours, 'axis', (hits) => tipOf(part, hits as { dataIndex: number }[], colours)),
    series: [
      ...part.series.map((series) => ({ type: 'bar' as const, name: series.name, data: series.values, barMaxWidth: 16,
        barGap: '15%', itemStyle: { color: colours.meaning(series.meaning), borderRadius: 2 } })),
      ...part.series.flatMap((series, i) => (hasIntervals(series) ? [whiskers(part, series, i, colours)] : [])),
      ...marksSeries(part.marks, [], colours),
    ],
  } as EChartsOption;
}

function tipOf(part: Bars, hits: { dataIndex: number }[], colours: Theme): HTMLElement | string {
  if (hits.length === 0) return element('div');
  const i = hits[0].dataIndex;
  return tip(part.categories[i], part.series.map((series): TipRow => ({ name: series.name, colour: colours.meaning(series.meaning),
    amount: inUnit(number(series.values[i]), part.value.unit) + (hasIntervals(series) ? ` (${number(series.low[i])} to ${number(series.high[i])})` : '') })));
}

function whiskers(part: Bars, series: BarSeries, index: number, colours: Theme): CustomSeriesOption {
  const renderItem: CustomSeriesOption['renderItem'] = (params, api) => {
    const low = series.low[params.dataIndex];
    const high = series.high[params.dataIndex];
    if (low === null || high === null) return null;
    const slots = api.barLayout!({ count: part.series.length, barMaxWidth: 16, barGap: '15%' } as never);
    const middle = slots?.[index]?.offsetCenter ?? 0;
    const [left, row] = api.coord([low, params.dataIndex]);
    const right = api.coord([high, params.dataIndex])[0];
    const y = row + middle;
    const style = { stroke: colours.ink, lineWidth: 1.4, fill: 'none' };
    const stroke = (x1: number, y1: number, x2: number, y2: number) => ({ type: 'line' as const, shape: { x1, y1, x2, y2 }, style });
    return { type: 'group', children: [stroke(left, y, right, y), stroke(left, y - 4, left, y + 4), stroke(right, y - 4, right, y + 4)] };
  };
  return { type: 'custom', name: series.name, renderItem, silent: true, z: 5, tooltip: { show: false },
    encode: { x: [0, 1], y: 2 }, data: series.low.map((low, i) => [low, series.high[i], i]) as number[][] };
}
