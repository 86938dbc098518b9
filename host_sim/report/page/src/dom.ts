// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Elements from data. Text always goes in as a text node, so that no string of a record is ever read as markup.

import type { Link } from './document';

type Child = Node | string | undefined | false;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Record<string, string> = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  for (const child of children) if (child) made.append(child);
  return made;
}

/** A state as a badge; its class is the state's name with dashes. */
export function badge(state: string): HTMLElement {
  return element('span', { class: `badge state-${state.replace(/[^a-z]+/gi, '-').toLowerCase()}` }, state);
}

/** Within this page or a file below its folder's parent: a record's name must not become a script or another host. */
export const leadsWithin = (href: string) => href.startsWith('#') || href.startsWith('../') || href.startsWith('./');

export function link({ text, href }: Link): HTMLElement {
  return leadsWithin(href) ? element('a', { href }, text) : element('span', {}, text);
}

/** "22.7 Nm/rad" */
export function inUnit(amount: string, unit?: string): string {
  return unit ? `${amount} ${unit}` : amount;
}

export function withUnit(label: string, unit?: string): string {
  return unit ? `${label} (${unit})` : label;
}
