// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Colours live in style.css as custom properties, once for light and once for dark; charts read them from there.
import type { Meaning } from './document';

export type Theme = {
  ink: string; soft: string; faint: string; grid: string; surface: string;
  meaning(meaning: Meaning): string;
  state(state: string): string;
  property(name: string): string;
};

export function theme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const property = (name: string) => style.getPropertyValue(name).trim();
  return {
    ink: property('--ink'), soft: property('--soft'), faint: property('--faint'), grid: property('--grid'),
    surface: property('--surface'),
    meaning: (meaning) => property(`--${meaning.replace('_', '-')}`) || property('--plain'),
    state: (state) => property(`--state-${state.replace(/[^a-z]+/gi, '-').toLowerCase()}`) || property('--state-starting'),
    property,
  };
}

/** Calls `draw` whenever the reader's system changes between light and dark. */
export function onThemeChange(draw: () => void): void {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
}
