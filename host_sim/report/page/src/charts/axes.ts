// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What all charts share: axes, grid margins, the tooltip's frame and marks.
import type { Axis, Mark, Meaning, Region } from '../document';
import { element, withUnit } from '../dom';
import { tick } from '../format';
import type { Theme } from '../theme';
import { narrow, type Key } from './frame';
import { lineHeight, lines } from './labels';

export function margins(width: number) {
  return { left: narrow(width) ? 50 : 64, right: narrow(width) ? 12 : 20, top: 30 };
}

export function base(colours: Theme) {
  return {
    animation: false,
    backgroundColor: 'transparent',
    textStyle: { fontFamily: colours.font, color: colours.soft },
    aria: { enabled: false },
  };
}

function ticks(colours: Theme) {
  return {
    axisLine: { show: true, onZero: false, lineStyle: { color: colours.faint } },
    axisTick: { show: true, lineStyle: { color: colours.faint } },
    axisLabel: { color: colours.soft, fontSize: 12, hideOverlap: true },
    splitLine: { show: true, lineStyle: { color: colours.grid } },
    nameTextStyle: { color: colours.soft, fontSize: 12 },
  };
}

/** Labels for ticks; the end of a range that was given keeps its label only when it is a round number. */
function labelled(axis: Axis) {
  const ends: number[] = axis.range ?? [];
  return (value: number) => {
    const text = tick(value);
    return ends.includes(value) && text.replace(/[^1-9]*(.*?)[0.]*$/, '$1').replace('.', '').length > 2 ? '' : text;
  };
}

const bounds = (axis: Axis) => (axis.range ? { min: axis.range[0], max: axis.range[1] } : {});
const scale = (axis: Axis) => ({ type: axis.log ? ('log' as const) : ('value' as const), scale: true });

export function xAxis(axis: Axis, colours: Theme) {
  const common = ticks(colours);
  return { ...scale(axis), ...common, ...bounds(axis), splitLine: { show: false },
    axisLabel: { ...common.axisLabel, formatter: labelled(axis) },
    name: withUnit(axis.label, axis.unit), nameLocation: 'middle' as const, nameGap: 28 };
}

/** The name stands above the axis, level, so that it is read without turning the head and costs no width. */
export function yAxis(axis: Axis, colours: Theme, width: number) {
  const common = ticks(colours);
  return { ...scale(axis), ...common, ...bounds(axis), axisTick: { show: false },
    axisLine: { show: false, onZero: false }, axisLabel: { ...common.axisLabel, formatter: labelled(axis) },
    name: withUnit(axis.label, axis.unit), nameLocation: 'end' as const, nameGap: 12,
    nameTextStyle: { color: colours.soft, fontSize: 12, align: 'left' as const,
      padding: [0, 0, 0, -margins(width).left + 4] } };
}

/** Names of rows, on as many lines as they need in `room` pixels. */
export function categoryAxis(names: string[], colours: Theme, room: number) {
  const common = ticks(colours);
  return { type: 'category' as const, data: names, ...common, splitLine: { show: false }, axisTick: { show: false },
    axisLabel: { ...common.axisLabel, hideOverlap: false, interval: 0, lineHeight,
      formatter: (name: string) => lines(name, room).join('\n') } };
}

/** A number from a log axis' series must be positive; what is not has no place on it. */
export function placed(axis: Axis, value: number | null): number | null {
  return axis.log && value !== null && value <= 0 ? null : value;
}

export type TipRow = { name: string; amount: string; colour?: string };

export function tip(head: string, rows: TipRow[]): HTMLElement {
  return element('div', { class: 'tip' }, head && element('div', {}, head), ...rows.map((row) =>
    element('div', { class: 'row' },
      element('span', {}, row.colour && element('span', { class: 'dot', style: `--tint: ${row.colour}` }), row.name),
      element('span', { class: 'amount' }, row.amount))));
}

export function tooltip(colours: Theme, trigger: 'axis' | 'item', formatter: (params: unknown) => HTMLElement | string) {
  return { trigger, confine: true, backgroundColor: colours.surface, borderColor: colours.grid, padding: [8, 10],
    textStyle: { color: colours.ink }, axisPointer: { lineStyle: { color: colours.faint } }, formatter };
}

/** What marks and regions are called stands in the legend, where it lies over nothing. */
export function marksKeys(marks: Mark[], regions: Region[] = []): Key[] {
  const meanings = [...new Set(marks.map(({ meaning }) => meaning))];
  const dashes = meanings.map((meaning): Key => ({ colour: colourName(meaning), look: 'dashed', toggles: false,
    name: marks.filter((mark) => mark.meaning === meaning).map(({ label }) => label).join(', ') }));
  const shades = [...new Set(regions.map(({ label }) => label))].filter((label) => label !== '')
    .map((name): Key => ({ name, colour: 'faint', look: 'band', toggles: false }));
  return [...dashes, ...shades];
}

/** Marks and regions ride on a series of their own without data: hiding another series does not take them along. */
export function marksSeries(marks: Mark[], regions: Region[], colours: Theme) {
  if (marks.length + regions.length === 0) return [];
  const line = (mark: Mark) => ({
    ...(mark.axis === 'x' ? { xAxis: mark.at } : { yAxis: mark.at }),
    lineStyle: { color: colours.meaning(mark.meaning), type: 'dashed' as const, width: 1.5 },
    label: { show: false },
  });
  const area = (region: Region) => [{ xAxis: region.from, label: { show: false } }, { xAxis: region.to }] as [object, object];
  return [{
    type: 'line' as const, name: '\u200bmarks', data: [], silent: true, z: 4,
    markLine: { silent: true, symbol: 'none', animation: false, precision: 15, data: marks.map(line) },
    markArea: { silent: true, animation: false, itemStyle: { color: colours.faint, opacity: 0.13 }, data: regions.map(area) },
  }];
}

export const colourName = (meaning: Meaning) => meaning.replace('_', '-');
