// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Run by node: writes the charts of DOCUMENT.json into FOLDER and says the files' names, a line each.
//
//   node figures.cjs DOCUMENT.json FOLDER
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import css from './style.css';
import { figures } from './figures.ts';

const [source, folder] = process.argv.slice(2);
for (const { name, text } of figures(JSON.parse(readFileSync(source, 'utf8')), css)) {
  writeFileSync(join(folder, name), text);
  console.log(name);
}
