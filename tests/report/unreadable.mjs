// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

/** What a reader cannot read of a page: tables and cells that are wider than their room, and words of a chart that lie over
 * each other or beyond its edge. A chart is taken as the SVG that it saves, which is drawn from the same options. */
export const unreadable = async () => {
  const found = [];
  if (document.documentElement.scrollWidth > window.innerWidth) found.push('the page scrolls sideways');
  // The experiment's, the longest, has 50,000; a study with a table of hundreds of rows had 97,000 before they were folded.
  const long = document.documentElement.scrollHeight;
  if (long > 60_000) found.push(`the page is ${long} px long`);
  for (const summary of document.querySelectorAll('summary')) summary.click();  // the numbers of the charts are tables, too
  await new Promise((resolve) => { setTimeout(resolve, 300); });
  for (const button of document.querySelectorAll('.all')) button.click();
  for (const box of document.querySelectorAll('.fitting')) {
    if (box.scrollWidth > box.clientWidth + 1) found.push(`table "${box.getAttribute('aria-label')}" is cut`);
    for (const cell of box.querySelectorAll('th, td')) {
      if (cell.scrollWidth > cell.clientWidth + 1 && cell.clientWidth > 0) found.push(`cell "${cell.textContent}" is cut`);
    }
  }

  const saved = [];
  URL.createObjectURL = (blob) => { saved.push(blob); return 'blob:none'; };
  URL.revokeObjectURL = () => {};
  HTMLAnchorElement.prototype.click = () => {};
  const figures = [...document.querySelectorAll('figure')];
  for (const figure of figures) [...figure.querySelectorAll('.save button')].find((one) => one.textContent === 'SVG').click();
  const corners = (text) => {
    const { x, y, width, height } = text.getBBox();
    const to = text.getCTM();
    // A line's box is higher than its letters: a sixth at either end is empty.
    return [[x, y + height / 6], [x + width, y + height / 6], [x + width, y + height * 5 / 6], [x, y + height * 5 / 6]]
      .map(([px, py]) => [to.a * px + to.c * py + to.e, to.b * px + to.d * py + to.f]);
  };
  // Two convex shapes lie apart if a line along one of their edges parts them.
  const apart = (one, other) => [one, other].some((shape) => shape.some((from, i) => {
    const to = shape[(i + 1) % shape.length];
    const along = ([x, y]) => (to[1] - from[1]) * (x - from[0]) - (to[0] - from[0]) * (y - from[1]);
    return Math.min(...one.map(along)) >= Math.max(...other.map(along)) - 1e-6
      || Math.min(...other.map(along)) >= Math.max(...one.map(along)) - 1e-6;
  }));
  for (const [i, blob] of saved.entries()) {
    const title = figures[i].querySelector('h3').textContent;
    const holder = document.createElement('div');
    holder.innerHTML = await blob.text();
    document.body.append(holder);
    const svg = holder.querySelector('svg');
    const [width, height] = ['width', 'height'].map((name) => Number(svg.getAttribute(name)));
    const texts = [...svg.querySelectorAll('text')].filter((one) => one.textContent.trim() !== '')
      .map((one) => ({ words: one.textContent, corners: corners(one) }));
    for (const [k, one] of texts.entries()) {
      const beyond = one.corners.some(([x, y]) => x < -2 || y < -2 || x > width + 2 || y > height + 2);
      if (beyond) found.push(`"${title}": "${one.words}" is cut by the edge`);
      if (one.words.includes('\u2026')) found.push(`"${title}": "${one.words}" is cut short`);
      for (const other of texts.slice(k + 1)) {
        if (!apart(one.corners, other.corners)) found.push(`"${title}": "${one.words}" lies over "${other.words}"`);
      }
    }
    holder.remove();
  }
  return { found, charts: saved.length };
};
