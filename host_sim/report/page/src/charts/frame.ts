// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a chart is before anybody draws it: on a page (figure.ts) or as a file (svg.ts).
import type { Cell, Column } from '../document';
import type { Theme } from '../theme';
import type { EChartsOption, EChartsType } from './echarts';

export type Key = { name: string; colour: string; look: 'line' | 'dashed' | 'points' | 'band' | 'block'; toggles: boolean };
export type Numbers = { columns: Column[]; rows: number; row(index: number): Cell[] };
export type Figure = {
  title: string; caption?: string; summary: string;
  /** In CSS pixels, for a plot of this width. */
  height(width: number): number;
  keys: Key[]; numbers: Numbers;
  option(theme: Theme, width: number): EChartsOption;
  /** Called once with the chart and the line under it, for zoom and links. */
  ready?(chart: EChartsType, under: HTMLElement): void;
};

export function narrow(width: number): boolean {
  return width < 560;
}
