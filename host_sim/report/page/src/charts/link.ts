// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Charts of one group show the same stretch of the x axis: they share their full range, and a zoom of one is a zoom of all.
import type { LineChart, Part } from '../document';
import type { EChartsType } from './echarts';

export type Linked = {
  /** The x range of all charts of the group together. */
  range: [number, number];
  /** The last of a run of charts carries the slider for the run. */
  slider: boolean;
};

const isMember = (part: Part | undefined, group: string | undefined): part is LineChart =>
  part?.kind === 'line_chart' && group !== undefined && part.group === group;

export function linked(part: LineChart, parts: Part[]): Linked {
  const members = parts.filter((other): other is LineChart => other === part || isMember(other, part.group));
  return { range: extent(members), slider: !isMember(parts[parts.indexOf(part) + 1], part.group) };
}

function extent(charts: LineChart[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const chart of charts) {
    if (chart.x.range) return chart.x.range;
    for (const { x } of chart.series) {
      for (const value of x) {
        if (value === null || (chart.x.log && value <= 0)) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
  }
  return low < high ? [low, high] : [Number.isFinite(low) ? low - 0.5 : 0, Number.isFinite(low) ? low + 0.5 : 1];
}

type Window = { startValue: number; endValue: number };
const groups = new Map<string, { chart: EChartsType; onZoom(whole: boolean): void }[]>();
let passingOn = false;

/** Joins `chart` to its group; `onZoom` hears after each change whether the whole range is shown. */
export function join(chart: EChartsType, group: string | undefined, onZoom: (whole: boolean) => void): void {
  const members = group === undefined ? [] : groups.get(group) ?? [];
  if (group !== undefined) groups.set(group, members);
  const self = { chart, onZoom };
  members.push(self);
  chart.on('datazoom', () => {
    const zoom = (chart.getOption().dataZoom as (Window & { start: number; end: number })[])[0];
    self.onZoom(zoom.start <= 0 && zoom.end >= 100);
    if (passingOn) return;
    passingOn = true;
    for (const other of members) {
      if (other !== self) other.chart.dispatchAction({ type: 'dataZoom', startValue: zoom.startValue, endValue: zoom.endValue });
    }
    passingOn = false;
  });
}
