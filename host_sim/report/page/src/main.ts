// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Reads the document that stands in the page and draws its parts, one below the other.
import type { Document, Part } from './document';
import { element } from './dom';
import { headline, note, section } from './prose';
import { table } from './table';
import { anchor, contents } from './contents';
import { chartOf } from './charts/chart';
import { drawAll, figure } from './charts/figure';

function drawn(part: Part, parts: Part[]): HTMLElement {
  switch (part.kind) {
    case 'headline': return headline(part);
    case 'section': return section(part, anchor(part, parts));
    case 'note': return note(part);
    case 'table': return table(part);
    default: return figure(chartOf(part, parts)!);
  }
}

function draw(page: HTMLElement, content: Document): void {
  page.append(element('header', {},
    element('h1', {}, content.title),
    content.subtitle && element('p', { class: 'subtitle' }, content.subtitle)));
  const { parts } = content;
  const answer = parts[0]?.kind === 'headline' ? 1 : 0;
  const drawnParts = parts.map((part) => drawn(part, parts));
  page.append(...drawnParts.slice(0, answer), contents(parts) ?? '', ...drawnParts.slice(answer));
  if (content.footer) page.append(element('footer', {}, content.footer));
  drawAll();
}

draw(document.getElementById('page')!, JSON.parse(document.getElementById('document')!.textContent!) as Document);
// The browser test waits for this.
document.documentElement.dataset.drawn = 'yes';
