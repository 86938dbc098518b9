// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Numbers for people: a fixed number of significant digits, a true minus sign, no exponent within the usual range.

const minus = '\u2212';

export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  if (value === 0) return '0';
  const size = Math.abs(value);
  const text = size >= 1e-4 && size < 1e7 ? plain(value, digits) : exponent(value, digits);
  return text.replace('-', minus);
}

function plain(value: number, digits: number): string {
  const before = Math.floor(Math.log10(Math.abs(Number(value.toPrecision(digits))))) + 1;  // 99.97 in three digits is 100
  return value.toFixed(Math.min(12, Math.max(0, digits - before)));
}

function exponent(value: number, digits: number): string {
  const [mantissa, power] = value.toExponential(Math.max(0, digits - 1)).split('e');
  return `${mantissa}e${Number(power)}`;
}

/** The same with trailing zeros taken off: tick labels. */
export function tick(value: number): string {
  const [mantissa, power] = number(value, 6).split('e');
  const short = mantissa.includes('.') ? mantissa.replace(/\.?0+$/, '') : mantissa;
  return power === undefined ? short : `${short}e${power}`;
}

/** In so many decimals, with a true minus sign. */
export function fixed(value: number | null | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  return value.toFixed(decimals).replace(/^-(?=0(\.0*)?$)/, '').replace('-', minus);
}

/** "22.70 ± 0.18": the interval in two digits, the value in the same decimals. Without an interval five digits. */
export function withInterval(value: number | null | undefined, reach: number | null | undefined): string {
  if (value === null || value === undefined || !reach || !(reach > 0)) return number(value, 5);
  const small = number(reach, 2);
  const decimals = small.includes('e') ? undefined : (small.split('.')[1] ?? '').length;
  const large = decimals === undefined || Math.abs(value) >= 1e7 ? number(value, 5) : value.toFixed(decimals).replace('-', minus);
  return `${large} \u00b1 ${small}`;
}

/** "12.2 % (10.8 to 13.4 %)": all in the decimals that give the interval two digits. */
export function withEnds(value: number | null, low: number | null, high: number | null, unit?: string): string {
  const end = unit ? ` ${unit}` : '';
  if (low === null || high === null || !(high > low)) return `${number(value, 3)}${end}`;
  const decimals = Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(high - low))));
  return `${fixed(value, decimals)}${end} (${fixed(low, decimals)} to ${fixed(high, decimals)}${end})`;
}

/** In as many decimals as tell two points apart that lie a two thousandth of `range` from each other. */
export function placeOn(range: number, value: number): string {
  if (!(range > 0) || Math.abs(value) >= 1e12) return number(value, 6);
  const decimals = Math.max(0, Math.ceil(-Math.log10(range / 2000)));
  return decimals > 9 ? number(value, 6) : fixed(value, decimals);
}

/** As many digits as a reader sees on an axis: decimals by the extent of a linear one, three digits on a log one. */
export type Resolved = (value: number | null | undefined) => string;

export function resolved(axis: { log?: boolean; range?: [number, number] }, values: (number | null)[]): Resolved {
  const [low, high] = axis.range ?? extent(values);
  return (value) => (value === null || value === undefined || !Number.isFinite(value) ? '\u2013'
    : axis.log || !(high > low) ? number(value, 3) : placeOn(4 * (high - low), value));
}

/** Least and largest of what is known. */
export function extent(values: (number | null)[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value === null) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return [low, high];
}

export function count(value: number): string {
  return value.toLocaleString('en-US');
}
