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
  const before = Math.floor(Math.log10(Math.abs(value))) + 1;
  return value.toFixed(Math.min(12, Math.max(0, digits - before)));
}

function exponent(value: number, digits: number): string {
  const [mantissa, power] = value.toExponential(Math.max(0, digits - 1)).split('e');
  return `${mantissa}e${Number(power)}`;
}

/** The same with trailing zeros taken off: tick labels. */
export function tick(value: number): string {
  const text = number(value, 6);
  return text.includes('e') || !text.includes('.') ? text : text.replace(/\.?0+$/, '');
}

/** "22.70 ± 0.18": the interval in two digits, the value in the same decimals. Without an interval five digits. */
export function withInterval(value: number | null | undefined, reach: number | null | undefined): string {
  if (value === null || value === undefined || !reach || !(reach > 0)) return number(value, 5);
  const small = number(reach, 2);
  const decimals = small.includes('e') ? undefined : (small.split('.')[1] ?? '').length;
  const large = decimals === undefined || Math.abs(value) >= 1e7 ? number(value, 5) : value.toFixed(decimals).replace('-', minus);
  return `${large} \u00b1 ${small}`;
}

/** In as many decimals as tell two points apart that lie a two thousandth of `range` from each other. */
export function placeOn(range: number, value: number): string {
  if (!(range > 0) || Math.abs(value) >= 1e12) return number(value, 6);
  const decimals = Math.max(0, Math.ceil(-Math.log10(range / 2000)));
  return decimals > 9 ? number(value, 6) : value.toFixed(decimals).replace('-', minus);
}

export function count(value: number): string {
  return value.toLocaleString('en-US');
}
