// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether an answer is right: every change that is so and no other; `none` of a simulation that is exact, `parameters`
// of one in which only J, B and C differ, `unknown` of what the vocabulary does not have.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const WITHOUT_CHANGES = { none: 'none', exact: 'none', parameters: 'parameters', unknown: 'unknown' };
const NOT_SINGLE = ['none', 'parameters', 'unknown', 'exact', 'resized', 'superfluous', 'beside', 'pair', 'triple'];

/** Changes as "effect change", sorted. Coulomb friction beside an offset is asymmetric friction by another name. */
function listed(changes) {
  const all = changes.map(({ effect, change }) => `${effect} ${change}`);
  const both = ['coulomb_friction add', 'torque_bias add'];
  if (!both.every((one) => all.includes(one))) return all.sort();
  return [...all.filter((one) => !both.includes(one)), 'asymmetric_friction add'].sort();
}

/** [{name, label, kind, right, isFalse, text}]: `isFalse` where a change is named that is not so. */
export function judged(key, answers) {
  return Object.entries(key).map(([name, truth]) => {
    const answer = JSON.parse(readFileSync(join(answers, name, 'diagnosis.json')));
    const named = answer.surrogate ? [] : listed(answer.causes);
    const wanted = listed(truth.changes);
    const verdict = WITHOUT_CHANGES[truth.label];
    const right = verdict ? named.length === 0 && answer.verdict === verdict : String(named) === String(wanted);
    return { name, label: truth.label, kind: NOT_SINGLE.includes(truth.label) ? truth.label : 'single', right,
      isFalse: named.some((change) => !wanted.includes(change)),
      text: `${name} ${truth.task.padEnd(7)} ${truth.label}: ${wanted.join(', ') || verdict}` +
        (right ? '' : ` -> ${named.join(', ') || answer.verdict}`) };
  });
}

/** {kind: {right, of, false}} */
export function counted(all) {
  const table = {};
  for (const one of all) {
    const row = (table[one.kind] ??= { right: 0, of: 0, false: 0 });
    row.right += one.right;
    row.of += 1;
    row.false += one.isFalse;
  }
  return table;
}
