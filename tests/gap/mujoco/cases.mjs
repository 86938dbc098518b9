// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Records of MuJoCo's wheel, each with a simulation that is wrong in a known way.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Random } from './random.mjs';
import { drawTorques } from './torques.mjs';
import { drive } from './wheel.mjs';

/** Sizes at which an effect matters to one who drives such a wheel; `arm` is the wheel's. */
const SIZES = {
  coulomb_friction: (random) => ({ friction_nm: random.between(0.25, 1.0), settling_s: random.one([0.02, 0.004]) }),
  quadratic_damping: (random, arm) => ({
    quadratic_damping_nms2_per_rad2: arm.damping_nms_per_rad * random.between(0.3, 0.9) }),
  cubic_stiffness: (random, arm) => ({
    cubic_stiffness_nm_per_rad3: arm.stiffness_nm_per_rad * random.between(0.15, 0.6) }),
  gravity_imbalance: (random) => ({ weight_torque_nm: random.between(0.6, 2), phase_rad: random.between(0.4, 1.3) }),
  torque_bias: (random) => ({ bias_nm: random.sign() * random.between(0.25, 0.6) }),
  compliance: (random) => ({ grip_stiffness_nm_per_rad: random.between(40, 150),
    grip_damping_nms_per_rad: random.between(0.2, 0.6), wheel_inertia_share: random.between(0.25, 0.4),
    wheel_damping_share: random.between(0.05, 0.15) }),
  backlash: (random) => ({ half_gap_rad: random.between(0.015, 0.04), wheel_inertia_share: random.between(0.25, 0.4),
    wheel_damping_share: random.between(0.05, 0.15) }),
  lag: (random) => ({ time_constant_s: random.between(0.01, 0.04) }),
  delay: (random) => ({ delay_s: random.between(0.008, 0.03) }),
  torque_saturation: (random, arm, peak_nm) => ({ limit_nm: peak_nm * random.between(0.6, 0.8) }),
  time_varying_stiffness: (random, arm, peak_nm, duration_s) => ({
    stiffness_ratio: random.between(1.3, 1.7), time_s: duration_s * random.between(0.3, 0.7) }),
  periodic_disturbance: (random) => ({ amplitude_nm: random.between(0.3, 0.8), frequency_hz: random.between(1.5, 6),
    phase_rad: random.between(0, 6) }),
  end_stop: (random) => ({ stop_rad: random.between(0.05, 0.1), settling_s: random.between(0.08, 0.15) }),
  clutch: (random, arm) => ({ inertia_kgm2: arm.inertia_kgm2 * random.between(0.3, 0.6),
    friction_nm: random.between(0.25, 0.6) }),
};
const UNKNOWN = ['end_stop', 'clutch'];
const KNOWN = Object.keys(SIZES).filter((id) => !UNKNOWN.includes(id));
/** Those whose numbers a simulation can have as they are, and that stand beside each other. */
const TOGETHER = ['coulomb_friction', 'gravity_imbalance', 'delay', 'torque_bias', 'cubic_stiffness', 'compliance',
  'quadratic_damping', 'periodic_disturbance'];

const round = (value, digits) => Number(value.toPrecision(digits));

/** A simulation's numbers of an effect: MuJoCo's own ones left out. */
function described(id, numbers, factor = 1) {
  const { settling_s, ...parameters } = numbers;
  const first = Object.keys(parameters)[0];
  return { effect: id, parameters: { ...parameters, [first]: round(parameters[first] * factor, 6) } };
}

/** One case: {label, effects, changes, arm, numbers, samples, simulation}. */
function drawCase(random, { label, missing = [], beside = [], resized = [], superfluous = [] }) {
  const duration_s = 80;
  const arm = { inertia_kgm2: random.between(0.07, 0.16), damping_nms_per_rad: random.between(0.7, 2),
    stiffness_nm_per_rad: random.between(10, 35) };
  const steered = [...missing, ...beside, ...resized].some(
    (id) => ['quadratic_damping', 'cubic_stiffness', 'gravity_imbalance'].includes(id));
  const torques = drawTorques(random, steered ? 'active' : random.one(['passive', 'probe', 'active']), arm);
  let peak_nm = 0;
  for (let t = 0; t < duration_s; t += 0.01) {
    peak_nm = Math.max(peak_nm, Math.abs(torques.driver(t)), Math.abs(torques.motor(t)));
  }
  const sized = (id) => [id, SIZES[id](random, arm, peak_nm, duration_s)];
  const wheel = Object.fromEntries([...missing, ...beside, ...resized].map(sized));
  const samples = drive(arm, wheel, { ...torques, duration_s });

  const torqueNoise_nm = random.between(0.01, 0.03);
  const angleNoise_rad = random.between(0.0002, 0.001);
  for (const sample of samples) {
    sample.angle_rad += angleNoise_rad * random.normal();
    for (const channel of ['torque_driver_nm', 'torque_motor_nm']) sample[channel] += torqueNoise_nm * random.normal();
  }
  const off = { none: 0, exact: 0, parameters: random.between(0.2, 0.5) }[label] ?? 0.06;
  const simulation = Object.fromEntries(Object.entries(arm).map(
    ([name, value]) => [name, round(value * (1 + off * random.between(-1, 1)), 5)]));
  if (label === 'parameters') {
    simulation.damping_nms_per_rad = round(arm.damping_nms_per_rad * (1 + random.sign() * off), 5);
  }
  const effects = [...beside.map((id) => described(id, wheel[id])),
    ...resized.map((id) => described(id, wheel[id], random.one([0.5, 2]))),
    ...superfluous.map((id) => described(...sized(id)))];
  if (effects.length > 0) simulation.effects = effects;
  const changes = [...missing.filter((id) => !UNKNOWN.includes(id)).map((effect) => ({ effect, change: 'add' })),
    ...resized.map((effect) => ({ effect, change: 'resize' })),
    ...superfluous.map((effect) => ({ effect, change: 'remove' }))];
  return { label, changes, task: torques.task, arm, wheel, samples, simulation };
}

/** What is drawn: `each` of every single kind, and as many of each kind of several. */
function plan(random, each) {
  const list = [];
  const take = (count, not = []) => {
    const taken = [];
    for (const id of random.shuffled(TOGETHER)) if (taken.length < count && !not.includes(id)) taken.push(id);
    return taken;
  };
  for (let i = 0; i < each; ++i) {
    list.push({ label: 'none' }, { label: 'parameters' });
    for (const id of KNOWN) list.push({ label: id, missing: [id] });
    for (const id of UNKNOWN) list.push({ label: 'unknown', missing: [id] });
    for (let twice = 0; twice < 2; ++twice) {
      list.push({ label: 'exact', beside: take(2) }, { label: 'resized', resized: take(1) },
        { label: 'superfluous', superfluous: take(1) });
      const [missing, beside] = take(2);
      list.push({ label: 'beside', missing: [missing], beside: [beside] });
      list.push({ label: 'pair', missing: take(2) }, { label: 'triple', missing: take(3) });
    }
  }
  return list;
}

/** Writes FOLDER/cases/caseNNN/{log.csv,sim.json} and FOLDER/key.json; returns the key. */
export function writeCases(folder, seed, each) {
  const key = {};
  plan(new Random(seed), each).forEach((kind, i) => {
    const drawn = drawCase(new Random(seed * 10007 + i), kind);
    const name = `case${String(i).padStart(3, '0')}`;
    const place = join(folder, 'cases', name);
    mkdirSync(place, { recursive: true });
    const rows = drawn.samples.map((s) => [s.time_s.toFixed(3), s.torque_driver_nm.toFixed(5),
      s.torque_motor_nm.toFixed(5), s.angle_rad.toFixed(6)].join(','));
    writeFileSync(join(place, 'log.csv'),
      ['time_s,torque_driver_nm,torque_motor_nm,angle_rad', ...rows, ''].join('\n'));
    writeFileSync(join(place, 'sim.json'), JSON.stringify(drawn.simulation, null, 1) + '\n');
    const { label, changes, task, arm, wheel } = drawn;
    key[name] = { label, changes, task, arm, wheel };
  });
  writeFileSync(join(folder, 'key.json'), JSON.stringify(key, null, 1) + '\n');
  return key;
}
