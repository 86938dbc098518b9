// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The JSON document of a page: what host_sim/report/parts.hpp writes. A number that is not finite arrives as null.

/** What a line stands for; its colour follows from this alone, so that it is the same in every report. */
export type Meaning =
  | 'measured' | 'model' | 'residual' | 'inertia' | 'damping' | 'stiffness'
  | 'torque_driver' | 'torque_motor' | 'torque_rim' | 'reference' | 'plain';
export type Tone = 'good' | 'caution' | 'bad' | 'neutral';
export type Value = number | null;
export type Badge = { state: string };
export type Link = { text: string; href: string };
export type Cell = string | Value | Badge | Link;

export type Axis = { label: string; unit?: string; log?: boolean; range?: [number, number] };
export type Interval = { from: number; to: number; state: string };
export type Mark = { axis: 'x' | 'y'; at: number; label: string; meaning: Meaning };
export type Region = { from: number; to: number; label: string };

export type KeyNumber = { label: string; value: string; unit?: string; note?: string; state?: string; meaning?: Meaning };
export type Headline = { kind: 'headline'; verdict: string; tone: Tone; numbers: KeyNumber[] };
export type Section = { kind: 'section'; title: string; lead?: string };
export type Note = { kind: 'note'; title?: string; paragraphs: string[]; tone: Tone };
export type Column = { label: string; unit?: string; digits: number; numeric: boolean };
export type Table = { kind: 'table'; title: string; caption?: string; columns: Column[]; rows: Cell[][]; key?: string };

type Chart = { title: string; caption?: string };
export type Drawn = 'line' | 'dashed' | 'points';
export type Series = {
  name: string; meaning: Meaning; drawn: Drawn;
  x: number[]; y: Value[]; sd?: Value[];
  samples: number;
};
export type LineChart = Chart & {
  kind: 'line_chart'; x: Axis; y: Axis; group?: string; height: number;
  series: Series[]; states: Interval[]; marks: Mark[]; regions: Region[];
};
export type Cloud = { name: string; meaning: Meaning; x: Value[]; y: Value[]; labels: string[]; hrefs?: string[] };
export type Scatter = Chart & { kind: 'scatter'; x: Axis; y: Axis; identity: boolean; clouds: Cloud[]; marks: Mark[] };
export type Heatmap = Chart & {
  kind: 'heatmap'; x_label: string; y_label: string; columns: string[]; rows: string[];
  values: Value[][]; value: Axis; diverging: boolean; digits: number;
};
export type BarSeries = { name: string; meaning: Meaning; values: Value[]; low: Value[]; high: Value[] };
export type Bars = Chart & { kind: 'bars'; categories: string[]; value: Axis; series: BarSeries[]; marks: Mark[] };
export type Histogram = Chart & {
  kind: 'histogram'; x: Axis; name: string; meaning: Meaning; edges: number[]; counts: number[];
  expected_name?: string; expected?: Value[]; marks: Mark[];
};

export type Part = Headline | Section | Note | Table | LineChart | Scatter | Heatmap | Bars | Histogram;
export type Document = { schema: string; title: string; subtitle?: string; footer?: string; parts: Part[] };
