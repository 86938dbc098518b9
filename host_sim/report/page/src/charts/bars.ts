// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Level bars, one row a category, each with its interval: names stay readable however long they are. On a log axis a
// bar's length means nothing, since it begins anywhere: a dot stands there instead.
import type { BarSeries, Bars, Meaning } from '../document';
import { element, inUnit } from '../dom';
import { resolved, withEnds } from '../format';
import type { Theme } from '../theme';
import { base, categoryAxis, colourName, marksKeys, marksSeries, tip, tooltip, xAxis, type TipRow } from './axes';
import type { CustomSeriesOption, EChartsOption } from './echarts';
import { narrow, type Figure, type Key } from './frame';
import { tallest, widthOf } from './labels';

/** Series beside each other that mean nothing in particular still have to be told apart. */
const DISTINCT: Meaning[] = ['reference', 'model', 'measured', 'residual', 'torque_driver', 'torque_motor'];

export function bars(given: Bars): Figure {
  const plain = given.series.length > 1 && given.series.every(({ meaning }) => meaning === 'plain');
  const part = plain ? { ...given, series: given.series.map((series, i) => ({ ...series, meaning: DISTINCT[i % DISTINCT.length] })) } : given;
  const thickness = (width: number) => Math.max(14 * part.series.length + 14, tallest(part.categories, roomFor(part, width)) + 8);
  return {
    title: part.title, caption: part.caption,
    height: (width) => 84 + Math.max(1, part.categories.length) * thickness(width),
    summary: `${part.value.label} of ${part.categories.length} categories: ${part.series.map(({ name }) => name).join(', ')}.`,
    keys: part.series.map((series): Key => ({ name: series.name, colour: colourName(series.meaning),
      look: part.value.log ? 'points' : 'block', toggles: part.series.length > 1 })).concat(marksKeys(part.marks)),
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

/** Pixels for the names of the categories. */
function roomFor(part: Bars, width: number): number {
  const longest = Math.max(0, ...part.categories.map(widthOf));
  return narrow(width) ? Math.min(0.4 * width, Math.max(60, longest + 8)) : Math.min(320, Math.max(180, longest + 8));
}

function option(part: Bars, colours: Theme, width: number): EChartsOption {
  const room = roomFor(part, width);
  return {
    ...base(colours), grid: { left: room + 10, right: 24, top: 22, bottom: 46 },
    xAxis: { ...xAxis(part.value, colours), scale: part.value.log === true, splitLine: { show: true, lineStyle: { color: colours.grid } } },
    yAxis: { ...categoryAxis(part.categories, colours, room), inverse: true },
    legend: { show: false, data: part.series.map((series) => series.name) },
    tooltip: tooltip(colours, 'axis', (hits) => tipOf(part, hits as { dataIndex: number }[], colours)),
    series: [
      ...(part.value.log ? [] : part.series.map((series) => ({ type: 'bar' as const, name: series.name, data: series.values, barMaxWidth: 16,
        barGap: '15%', itemStyle: { color: colours.meaning(series.meaning), borderRadius: 2 } }))),
      ...part.series.flatMap((series, i) => (hasIntervals(series) || part.value.log ? [whiskers(part, series, i, colours)] : [])),
      ...marksSeries(part.marks, [], colours),
    ],
  } as EChartsOption;
}

function tipOf(part: Bars, hits: { dataIndex: number }[], colours: Theme): HTMLElement | string {
  if (hits.length === 0) return element('div');
  const i = hits[0].dataIndex;
  const amount = resolved(part.value, [0, ...part.series.flatMap(({ values }) => values)]);
  return tip(part.categories[i], part.series.map((series): TipRow => ({ name: series.name, colour: colours.meaning(series.meaning),
    amount: hasIntervals(series) ? withEnds(series.values[i], series.low[i], series.high[i], part.value.unit)
      : inUnit(amount(series.values[i]), part.value.unit) })));
}

/** The interval of each value, and on a log axis the value itself as a dot. */
function whiskers(part: Bars, series: BarSeries, index: number, colours: Theme): CustomSeriesOption {
  const renderItem: CustomSeriesOption['renderItem'] = (params, api) => {
    const box = params.coordSys as unknown as { x: number; width: number };
    const value = series.values[params.dataIndex];
    const low = series.low[params.dataIndex] ?? null;
    const high = series.high[params.dataIndex] ?? null;
    if (value === null && (low === null || high === null)) return null;
    const slots = api.barLayout!({ count: part.series.length, barMaxWidth: 16, barGap: '15%' } as never);
    const middle = slots?.[index]?.offsetCenter ?? 0;
    const row = api.coord([part.value.log ? 1 : 0, params.dataIndex])[1];
    const y = row + middle;
    const across = (at: number) => (part.value.log && at <= 0 ? box.x : Math.min(Math.max(api.coord([at, 0])[0], box.x), box.x + box.width));
    const dot = part.value.log && value !== null && value > 0 ? [{ type: 'circle' as const, shape: { cx: across(value), cy: y, r: 5 },
      style: { fill: colours.meaning(series.meaning) } }] : [];
    if (low === null || high === null) return { type: 'group', children: dot };
    const left = across(low);
    const right = across(high);
    const style = { stroke: colours.ink, lineWidth: 1.4, fill: 'none' };
    const stroke = (x1: number, y1: number, x2: number, y2: number) => ({ type: 'line' as const, shape: { x1, y1, x2, y2 }, style });
    return { type: 'group', children: [stroke(left, y, right, y), stroke(left, y - 4, left, y + 4), stroke(right, y - 4, right, y + 4), ...dot] };
  };
  const shown = (value: number | null | undefined) => (value === undefined || (part.value.log && value !== null && value <= 0) ? null : value);
  return { type: 'custom', name: series.name, renderItem, silent: true, z: 5, tooltip: { show: part.value.log === true },
    encode: { x: [0, 1, 2], y: 3 },
    data: series.values.map((value, i) => [shown(value), shown(series.low[i]), shown(series.high[i]), i]) as number[][] };
}
