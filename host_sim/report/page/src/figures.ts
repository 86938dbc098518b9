// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The charts of a document as files for papers, without a browser.
import type { Document } from './document';
import { chartOf } from './charts/chart';
import { csv, fileName, svgOnPaper } from './charts/svg';
import { lightTheme } from './theme';

const column = 88;  // mm: one column of a journal in two
const pixels = 374;  // that it is drawn for, so that letters of 12 pixels are 8 points

export type File = { name: string; text: string };

/** NN_TITLE.svg and NN_TITLE.csv of each chart, numbered in the page's order. */
export function figures(document: Document, css: string): File[] {
  const theme = lightTheme(css);
  const charts = document.parts.map((part) => chartOf(part, document.parts, false)).filter((one) => one !== undefined);
  return charts.flatMap((chart, i) => {
    const name = `${String(i + 1).padStart(2, '0')}_${fileName(chart.title)}`;
    return [{ name: `${name}.svg`, text: svgOnPaper(chart, theme, pixels, column) },
      { name: `${name}.csv`, text: csv(chart.numbers) }];
  });
}
