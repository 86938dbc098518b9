// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Lines over a common x axis, with 95 % bands, marks, regions, a strip of states, and zoom linked within a group.
// Long series are thinned to the plot's pixels by ECharts' LTTB (largest triangle, three buckets), anew at each zoom.
import type { Cell, LineChart, Series } from '../document';
import { element, inUnit } from '../dom';
import { count, extent, number, placeOn, resolved, withInterval, type Resolved } from '../format';
import type { Theme } from '../theme';
import { base, colourName, margins, marksKeys, marksSeries, placed, tip, tooltip, xAxis, yAxis, type TipRow } from './axes';
import { band, coverage } from './band';
import type { EChartsOption, EChartsType } from './echarts';
import type { Figure, Key } from './frame';
import { join, type Linked } from './link';
import { stateAt, stateStrip, stripHeight } from './states';

export function lineChart(part: LineChart, link: Linked): Figure {
  const hidden = new Set<string>();  // names of series that the legend has switched off
  const strip = part.states.length > 0 ? stripHeight + 8 : 0;
  const height = part.height + strip + (link.slider ? 28 : 0);
  return {
    title: part.title, caption: part.caption, summary: summary(part), height: () => height, keys: keys(part),
    numbers: numbers(part),
    option: (colours, width) => option(part, link, colours, width, hidden),
    ready: (chart, under) => ready(chart, under, part, hidden),
  };
}

function option(part: LineChart, link: Linked, colours: Theme, width: number, off: Set<string>): EChartsOption {
  const hasStates = part.states.length > 0;
  const amount = resolved(part.y, part.series.flatMap(({ y }) => y));
  const bottom = 46 + (link.slider ? 28 : 0);
  const plot = { ...margins(width), bottom: bottom + (hasStates ? stripHeight + 8 : 0) };
  const x = { ...xAxis({ ...part.x, range: link.range }, colours) };
  const hidden = { ...x, show: false };
  const lower = { type: 'value' as const, gridIndex: 1, min: 0, max: 1, show: false };
  return {
    ...base(colours),
    grid: hasStates ? [plot, { left: plot.left, right: plot.right, bottom, height: stripHeight }] : [plot],
    // With a strip, the labels stand below it and the plot above keeps its own axis without them.
    xAxis: hasStates ? [{ ...hidden, gridIndex: 0, axisPointer: { show: true } }, { ...x, gridIndex: 1 }] : [x],
    yAxis: hasStates ? [yAxis(part.y, colours, width), lower] : [yAxis(part.y, colours, width)],
    legend: { show: false, data: part.series.map((series) => series.name) },
    dataZoom: zooms(link, colours, plot, hasStates),
    tooltip: tooltip(colours, 'axis', (params) => tipOf(part, link.range, amount, params as Hit[], colours, off)),
    series: [
      ...part.series.flatMap((series) => band(series, colours)),
      ...part.series.map((_, i) => line(part, i, colours)),
      ...marksSeries(part.marks, part.regions, colours),
      ...(hasStates ? [stateStrip(part.states, colours)] : []),
    ],
  } as EChartsOption;
}

/** A line that later ones may lie on is drawn wider than they are, so that it is seen on both sides of them. */
function widthOf(part: LineChart, index: number): number {
  const over = part.series.slice(index + 1).filter(({ drawn }) => drawn === 'line').length;
  return 1.6 + 0.7 * Math.min(2, over);
}

function line(part: LineChart, index: number, colours: Theme) {
  const series = part.series[index];
  const colour = colours.meaning(series.meaning);
  const points = series.drawn === 'points';
  return {
    type: 'line' as const, name: series.name, sampling: points ? undefined : ('lttb' as const), clip: true, z: 3,
    data: series.x.map((x, i) => [placed(part.x, x), placed(part.y, series.y[i]), series.sd?.[i] ?? null]),
    encode: { x: 0, y: 1 }, dimensions: ['x', 'y', 'sd'], showSymbol: points, symbol: 'circle', symbolSize: 5,
    lineStyle: { width: points ? 0 : widthOf(part, index), type: series.drawn === 'dashed' ? ('dashed' as const) : ('solid' as const) },
    itemStyle: { color: colour }, color: colour, emphasis: { disabled: true },
  };
}

function zooms(link: Linked, colours: Theme, plot: { left: number; right: number }, hasStates: boolean) {
  const both = { xAxisIndex: hasStates ? [0, 1] : [0], filterMode: 'weakFilter' as const };
  // Plain wheel and drag belong to the page: zooming wants the control key, moving the shift key, or two fingers.
  const inside = { type: 'inside' as const, ...both, zoomOnMouseWheel: 'ctrl' as const, moveOnMouseMove: 'shift' as const };
  if (!link.slider) return [inside];
  return [inside, { type: 'slider' as const, ...both, left: plot.left, right: plot.right, bottom: 4, height: 16,
    showDetail: false, showDataShadow: false, brushSelect: false, borderColor: colours.grid, backgroundColor: 'transparent',
    fillerColor: 'rgba(128,140,152,0.22)', handleSize: '130%', handleStyle: { color: colours.surface, borderColor: colours.faint },
    moveHandleSize: 0 }];
}

type Hit = { seriesName: string; seriesType: string; value: (number | null)[]; axisValue: number };

/** The sample of a series at `at`, or nearest to it; nothing beyond its ends. */
function sampleAt(series: Series, at: number): number | undefined {
  const [low, high] = extent(series.x);
  const beyond = (high - low) / Math.max(1, series.x.length - 1);
  if (!(at >= low - beyond && at <= high + beyond)) return undefined;
  return series.x.reduce((best, x, i) => (Math.abs(x - at) < Math.abs(series.x[best] - at) ? i : best), 0);
}

/** Every series that is seen: of those that are thinned each in its own way ECharts finds the nearest one only. */
function tipOf(part: LineChart, range: [number, number], shown: Resolved, hits: Hit[], colours: Theme,
  off: Set<string>): HTMLElement | string {
  const hit = hits.find(({ seriesType, value }) => seriesType === 'line' && Array.isArray(value));
  if (!hit) return '';
  const at = hit.value[0]!;
  const rows = part.series.flatMap((series): TipRow[] => {
    const i = off.has(series.name) ? undefined : sampleAt(series, at);
    if (i === undefined) return [];
    const sd = series.sd?.[i];
    const amount = sd ? withInterval(series.y[i], coverage * sd) : shown(series.y[i]);
    return [{ name: series.name, amount: inUnit(amount, part.y.unit), colour: colours.meaning(series.meaning) }];
  });
  const state = stateAt(part.states, at);
  if (state) rows.push({ name: 'state', amount: state, colour: colours.state(state) });
  return tip(`${part.x.label} ${inUnit(part.x.log ? number(at, 4) : placeOn(range[1] - range[0], at), part.x.unit)}`, rows);
}

function keys(part: LineChart): Key[] {
  const lines = part.series.map((series): Key => ({ name: series.name, colour: colourName(series.meaning),
    look: series.drawn, toggles: part.series.length > 1 }));
  const banded = part.series.find((series) => series.sd);
  const bands: Key[] = banded ? [{ name: '95 % band', colour: colourName(banded.meaning), look: 'band', toggles: false }] : [];
  const states = [...new Set(part.states.map(({ state }) => state))].map((state): Key => ({
    name: state, colour: `state-${state.replace(/[^a-z]+/gi, '-').toLowerCase()}`, look: 'block', toggles: false }));
  return [...lines, ...bands, ...marksKeys(part.marks, part.regions), ...states];
}

function summary(part: LineChart): string {
  const spans = part.series.map(({ name, y, samples }) => {
    const [low, high] = extent(y);
    return !(low <= high) ? `${name}: no values` : `${name}: ${count(samples)} samples, ${number(low)} to ${number(high)} ${part.y.unit ?? ''}`;
  });
  return `${part.y.label} over ${part.x.label}. ${spans.join('; ')}.`;
}

function numbers(part: LineChart) {
  const longest = part.series.reduce((a, b) => (b.x.length > a.x.length ? b : a), part.series[0]);
  const column = (label: string, unit?: string) => ({ label, unit, digits: 5, numeric: true });
  // Series on the same x share a row; others have columns of their own.
  const columns = part.series.flatMap((series) => [
    ...(series === longest ? [] : sameX(series, longest) ? [] : [column(part.x.label, part.x.unit)]),
    column(series.name, part.y.unit), ...(series.sd ? [column(`${series.name}, sd`, part.y.unit)] : [])]);
  const row = (i: number): Cell[] => [longest.x[i], ...part.series.flatMap((series) => [
    ...(series === longest || sameX(series, longest) ? [] : [series.x[i] ?? null]),
    series.y[i] ?? null, ...(series.sd ? [series.sd[i] ?? null] : [])])];
  return { columns: [column(part.x.label, part.x.unit), ...columns], rows: longest?.x.length ?? 0, row };
}

function sameX(a: Series, b: Series): boolean {
  const last = b.x.length - 1;
  return a.x.length === b.x.length && a.x[0] === b.x[0] && a.x[last] === b.x[last] && a.x[last >> 1] === b.x[last >> 1];
}

function ready(chart: EChartsType, under: HTMLElement, part: LineChart, hidden: Set<string>): void {
  chart.on('legendselected', (event) => { hidden.delete((event as { name: string }).name); });
  chart.on('legendunselected', (event) => { hidden.add((event as { name: string }).name); });
  const thinned = part.series.find((series) => series.samples > series.x.length);
  if (thinned) under.prepend(element('span', {}, `${count(thinned.samples)} samples, ${count(thinned.x.length)} drawn.`));
  const reset = element('button', { type: 'button', class: 'reset', hidden: '' }, 'Show all');
  reset.addEventListener('click', () => chart.dispatchAction({ type: 'dataZoom', start: 0, end: 100 }));
  under.append(reset);
  join(chart, part.group, (whole) => { reset.hidden = whole; });
}
