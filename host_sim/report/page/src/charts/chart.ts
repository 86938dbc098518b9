// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The parts that are charts, each by its own module.
import type { Part } from '../document';
import { bars } from './bars';
import type { Figure } from './frame';
import { heatmap } from './heatmap';
import { histogram } from './histogram';
import { lineChart } from './line_chart';
import { linked } from './link';
import { scatter } from './scatter';

/** Nothing of a part that is no chart. `slider` is false where nobody can move one. */
export function chartOf(part: Part, parts: Part[], slider = true): Figure | undefined {
  switch (part.kind) {
    case 'line_chart': {
      const link = linked(part, parts);
      return lineChart(part, { ...link, slider: slider && link.slider });
    }
    case 'scatter': return scatter(part);
    case 'heatmap': return heatmap(part);
    case 'bars': return bars(part);
    case 'histogram': return histogram(part);
    default: return undefined;
  }
}
