// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Makes one file, page.html: the template with the bundled script and style inside. What is left open are the two
// marks that page.cpp fills in, the title and the document.
//
// Beside it goes OUT.figures.cjs, which draws a document's charts as files; node runs it.
//
//   node bundle.mjs OUT.html
import { build } from 'esbuild';
import { readFile, writeFile } from 'node:fs/promises';

const out = process.argv[2] ?? 'page.html';

async function bundled(entry) {
  const result = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    format: 'iife',
    target: ['chrome100', 'firefox100', 'safari15'],
    legalComments: 'none',
    charset: 'ascii',
    // ECharts reads process.env.NODE_ENV in its development warnings only.
    define: { 'process.env.NODE_ENV': '"production"' },
    write: false,
    logLevel: 'warning',
  });
  if (result.warnings.length > 0) throw new Error(`${entry}: warnings are errors`);
  return result.outputFiles[0].text.trim();
}

const [template, style, script] = await Promise.all([
  readFile('src/template.html', 'utf8'),
  bundled('src/style.css'),
  bundled('src/main.ts'),
]);

// Functions as replacements: a string would give a meaning to every $& in the script.
const page = template
  .replace('@STEERID_STYLE@', () => style)
  .replace('@STEERID_SCRIPT@', () => script);

for (const mark of ['@STEERID_TITLE@', '@STEERID_DOCUMENT@']) {
  if (page.split(mark).length !== 2) throw new Error(`${mark} must occur exactly once in the page`);
}
if (/<\/(script|style)/i.test(script) || /<\/style/i.test(style)) throw new Error('the bundle would close its own tag');
await writeFile(out, page);

const figures = await build({
  entryPoints: ['src/figures_main.mjs'],
  bundle: true,
  minify: true,
  platform: 'node',
  format: 'cjs',
  target: 'node18',
  legalComments: 'none',
  charset: 'ascii',
  loader: { '.css': 'text' },
  define: { 'process.env.NODE_ENV': '"production"' },
  outfile: `${out}.figures.cjs`,
  logLevel: 'warning',
});
if (figures.warnings.length > 0) throw new Error('src/figures_main.mjs: warnings are errors');
