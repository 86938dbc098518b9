// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Colours live in style.css as custom properties, once for light and once for dark; charts read them from there.
import type { Meaning } from './document';

export type Theme = {
  font: string; ink: string; soft: string; faint: string; grid: string; surface: string;
  meaning(meaning: Meaning): string;
  state(state: string): string;
  property(name: string): string;
};

/** As the page is shown now. */
export function theme(): Theme {
  const style = getComputedStyle(document.documentElement);
  return themeOf((name) => style.getPropertyValue(name).trim(), getComputedStyle(document.body).fontFamily);
}

/** For paper and for files, which are light whatever the screen is: the first block of style.css. */
export function lightTheme(css: string): Theme {
  const block = /:root\s*\{([^}]*)\}/.exec(css)?.[1] ?? '';
  const values = new Map([...block.matchAll(/(--[\w-]+)\s*:\s*([^;]+)/g)].map((hit) => [hit[1], hit[2].trim()]));
  return themeOf((name) => values.get(name) ?? '', 'Helvetica, Arial, sans-serif');
}

function themeOf(property: (name: string) => string, font: string): Theme {
  return {
    font,
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
