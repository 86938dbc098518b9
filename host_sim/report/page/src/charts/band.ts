// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A band around a line, value -+ 1.96 sd, as one polygon. ECharts has stacked areas only, and those part from the line
// once it is thinned. Of all the points that fall on one pixel column the lowest and the highest bound count, so a
// thinned band is never narrower than the true one.
import type { Series } from '../document';
import type { Theme } from '../theme';
import type { CustomSeriesOption } from './echarts';

export const coverage = 1.96;  // 95 % of a normal distribution

type Bounds = { x: number[]; low: number[]; high: number[] };

function bounds(series: Series): Bounds {
  const made: Bounds = { x: [], low: [], high: [] };
  series.x.forEach((x, i) => {
    const y = series.y[i];
    const sd = series.sd?.[i];
    if (y === null || sd === null || sd === undefined) return;
    made.x.push(x);
    made.low.push(y - coverage * sd);
    made.high.push(y + coverage * sd);
  });
  return made;
}

export function band(series: Series, colours: Theme): CustomSeriesOption[] {
  if (!series.sd) return [];
  const all = bounds(series);
  if (all.x.length < 2) return [];
  const renderItem: CustomSeriesOption['renderItem'] = (params, api) => {
    const box = params.coordSys as unknown as { x: number; y: number; width: number; height: number };
    const points = outline(all, box, (x, y) => api.coord([x, y]) as [number, number]);
    return { type: 'polygon', shape: { points }, silent: true,
      style: { fill: colours.meaning(series.meaning), opacity: 0.18 } };
  };
  return [{ type: 'custom', name: series.name, renderItem, silent: true, clip: true, z: 1,
    data: [[all.x[0], all.x[all.x.length - 1]]], encode: { x: [0, 1], y: [] }, tooltip: { show: false } }];
}

type Box = { x: number; y: number; width: number; height: number };

function outline(all: Bounds, box: Box, coord: (x: number, y: number) => [number, number]): [number, number][] {
  const upper: [number, number][] = [];
  const lower: [number, number][] = [];
  let column = NaN;
  for (let i = 0; i < all.x.length; i++) {
    const [px, top] = coord(all.x[i], all.high[i]);
    if (px < box.x - box.width || px > box.x + 2 * box.width) continue;
    const bottom = coord(all.x[i], all.low[i])[1];
    const last = upper.length - 1;
    if (Math.round(px) === column) {
      upper[last][1] = Math.min(upper[last][1], top);
      lower[last][1] = Math.max(lower[last][1], bottom);
    } else {
      column = Math.round(px);
      upper.push([px, top]);
      lower.push([px, bottom]);
    }
  }
  const kept = (y: number) => Math.min(Math.max(y, box.y - box.height), box.y + 2 * box.height);
  return [...upper, ...lower.reverse()].map(([x, y]) => [x, kept(y)]);
}
