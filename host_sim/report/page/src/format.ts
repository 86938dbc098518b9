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

export function count(value: number): string {
  return value.toLocaleString('en-US');
}
