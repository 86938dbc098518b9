// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The parts made of words: headline, section and note.
import type { Headline, KeyNumber, Note, Section } from './document';
import { badge, element } from './dom';

export function headline(part: Headline): HTMLElement {
  return element('section', { class: `card headline ${part.tone}`, 'aria-label': 'Verdict' },
    element('p', { class: 'verdict' }, part.verdict),
    part.numbers.length > 0 && element('dl', { class: 'numbers' }, ...part.numbers.map(keyNumber)));
}

function keyNumber(entry: KeyNumber): HTMLElement {
  const aside = entry.note || entry.state;
  return element('div', entry.meaning ? { style: `--tint: var(--${entry.meaning.replace('_', '-')})` } : {},
    element('dt', {}, entry.label),
    element('dd', {},
      element('div', { class: 'value' }, entry.value,
        entry.unit && element('span', { class: 'unit' }, `\u00a0${entry.unit}`)),
      aside && element('div', { class: 'aside' }, entry.note, entry.state && badge(entry.state))));
}

export function section(part: Section, id?: string): HTMLElement {
  return element('header', {},
    element('h2', id ? { id } : {}, part.title),
    part.lead && element('p', { class: 'lead' }, part.lead));
}

export function note(part: Note): HTMLElement {
  return element('aside', { class: `card note ${part.tone}` },
    part.title && element('h3', {}, part.title),
    ...part.paragraphs.map((text) => element('p', {}, text)));
}
