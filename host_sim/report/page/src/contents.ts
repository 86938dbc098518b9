// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The table of contents of a page that has several sections, in the page's own order.
import type { Part } from './document';
import { element } from './dom';

const few = 3;  // sections that are found without one

/** What a link to the part leads to; nothing where no link does. */
export function anchor(part: Part, parts: Part[]): string | undefined {
  if (part.kind !== 'section') return undefined;
  const number = parts.slice(0, parts.indexOf(part)).filter(({ kind }) => kind === 'section').length + 1;
  return `section-${number}`;
}

/** Stands below the answer; nothing on a short page. */
export function contents(parts: Part[]): HTMLElement | undefined {
  const sections = parts.filter((part) => part.kind === 'section');
  if (sections.length < few) return undefined;
  return element('nav', { class: 'contents card', 'aria-label': 'Contents' },
    element('ol', {}, ...sections.map((part) => element('li', {},
      element('a', { href: `#${anchor(part, parts)}` }, part.title)))));
}
