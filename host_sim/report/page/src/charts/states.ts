// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The strip under a chart that shows which state held when. The state's name stands in a segment that has room for it,
// so that the strip does not speak by colour alone.
import type { Interval } from '../document';
import type { Theme } from '../theme';
import type { CustomSeriesOption } from './echarts';

export const stripHeight = 18;

export function stateStrip(states: Interval[], colours: Theme): CustomSeriesOption {
  const renderItem: CustomSeriesOption['renderItem'] = (params, api) => {
    const box = params.coordSys as unknown as { x: number; y: number; width: number; height: number };
    const { from, to, state } = states[params.dataIndex];
    const left = Math.max(box.x, (api.coord([from, 0]) as number[])[0]);
    const right = Math.min(box.x + box.width, (api.coord([to, 0]) as number[])[0]);
    if (right <= left) return null;
    const width = Math.max(1, right - left);
    const roomy = width > state.length * 7 + 8;
    return { type: 'rect', shape: { x: left, y: box.y, width, height: box.height },
      style: { fill: colours.state(state) },
      textContent: roomy ? { type: 'text', style: { text: state, fill: colours.surface, fontSize: 11 } } : undefined,
      textConfig: { position: 'inside' } };
  };
  return { type: 'custom', name: '\u200bstates', renderItem, xAxisIndex: 1, yAxisIndex: 1, clip: true,
    data: states.map(({ from, to }) => [from, to, 0]), encode: { x: [0, 1], y: 2 } };
}

/** The state at `x`, or nothing. */
export function stateAt(states: Interval[], x: number): string | undefined {
  return states.find(({ from, to }) => from <= x && x <= to)?.state;
}
