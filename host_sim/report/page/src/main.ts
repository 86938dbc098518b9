// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Reads the document that stands in the page and draws its parts, one below the other.
import type { Document, Part } from './document';
import { element } from './dom';
import { headline, note, section } from './prose';
import { table } from './table';
import { lineChart } from './charts/line_chart';
import { scatter } from './charts/scatter';
import { heatmap } from './charts/heatmap';
import { bars } from './charts/bars';
import { histogram } from './charts/histogram';
import { linked } from './charts/link';
import { drawAll } from './charts/figure';

function drawn(part: Part, parts: Part[]): HTMLElement {
  switch (part.kind) {
    case 'headline': return headline(part);
    case 'section': return section(part);
    case 'note': return note(part);
    case 'table': return table(part);
    case 'line_chart': return lineChart(part, linked(part, parts));
    case 'scatter': return scatter(part);
    case 'heatmap': return heatmap(part);
    case 'bars': return bars(part);
    case 'histogram': return histogram(part);
  }
}

function draw(page: HTMLElement, content: Document): void {
  page.append(element('header', {},
    element('h1', {}, content.title),
    content.subtitle && element('p', { class: 'subtitle' }, content.subtitle)));
  for (const part of content.parts) page.append(drawn(part, content.parts));
  if (content.footer) page.append(element('footer', {}, content.footer));
  drawAll();
}

draw(document.getElementById('page')!, JSON.parse(document.getElementById('document')!.textContent!) as Document);
// The browser test waits for this.
document.documentElement.dataset.drawn = 'yes';
