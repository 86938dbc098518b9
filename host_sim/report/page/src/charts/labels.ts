// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Names of categories in the room they have: on several lines, never cut short. A chart's height follows from them, so
// their width is reckoned from a mean letter and not measured.

const letter = 6.8;  // CSS pixels, the mean of the page's font at 12 px
export const lineHeight = 14;  // CSS pixels

export const widthOf = (name: string) => letter * name.length;

/** The lines of `name` in `room` pixels; a word that is longer than a line goes on in the next one. */
export function lines(name: string, room: number): string[] {
  const most = Math.max(4, Math.floor(room / letter));
  const made: string[] = [''];
  for (const word of name.split(/(?<=[ _,/-])/)) {
    let rest = word;
    if (made[made.length - 1].length + rest.trimEnd().length > most && made[made.length - 1] !== '') made.push('');
    while (rest.trimEnd().length > most) {
      made[made.length - 1] = rest.slice(0, most);
      rest = rest.slice(most);
      made.push('');
    }
    made[made.length - 1] += rest;
  }
  return made.map((line) => line.trimEnd());
}

/** The height in pixels of the tallest name. */
export function tallest(names: string[], room: number): number {
  return lineHeight * names.reduce((most, name) => Math.max(most, lines(name, room).length), 1);
}
