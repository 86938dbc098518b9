// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The diagnosis on wheels that MuJoCo simulates: no line of its physics is ours.
//
//   node records.test.mjs STEERID FOLDER [EACH]    EACH of every kind, 1; STEERID_SEED: of all that is drawn
//
// FOLDER gets cases/, key.json and answers/; `steerid diagnose` can be tried on any of them by itself.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { rmSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { writeCases } from './cases.mjs';
import { counted, judged } from './judged.mjs';

const [steerid, folder, each = '1'] = process.argv.slice(2);
const seed = Number(process.env.STEERID_SEED ?? 504);

/** The most that may be wrong of `count`, each with this chance: more are once in twenty seeds. */
function mostWrong(count, chance) {
  let probability = (1 - chance) ** count;
  let sum = probability;
  let wrong = 0;
  while (sum < 0.95) {
    probability *= ((count - wrong) / (wrong + 1)) * (chance / (1 - chance));
    wrong += 1;
    sum += probability;
  }
  return wrong;
}

console.log(`STEERID_SEED=${seed}`);
rmSync(folder, { recursive: true, force: true });
const key = writeCases(folder, seed, Number(each));
const answers = join(folder, 'answers');
execFileSync(steerid, ['diagnose', '--batch', join(folder, 'cases'), '--no-report', '--out', answers],
  { stdio: ['ignore', 'ignore', 'inherit'] });
const all = judged(key, answers);
for (const one of all) console.log(one.text);
console.table(counted(all));

/** Of these the design allows so many wrong: docs/gap_diagnosis.md has the figures on many records. */
function holds(name, of, isWrong, chance) {
  test(name, () => {
    const wrong = of.filter(isWrong);
    assert.ok(of.length > 0);
    assert.ok(wrong.length <= mostWrong(of.length, chance), wrong.map((one) => one.text).join('\n'));
  });
}
const kind = (...kinds) => all.filter((one) => kinds.includes(one.kind));
holds('one missing effect is named', kind('single'), (one) => !one.right, 0.024);
holds('no change is named that is not so', all, (one) => one.isFalse, 0.05);
holds('exact simulations are left alone', kind('none', 'exact', 'parameters'), (one) => !one.right, 0.02);
holds('sizes are corrected, what is superfluous is removed', kind('resized', 'superfluous'), (one) => !one.right, 0.1);
holds('several are named', kind('beside', 'pair'), (one) => !one.right, 0.12);
