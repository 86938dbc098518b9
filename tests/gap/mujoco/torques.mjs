// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The torques of a drive, functions of time: all of them sums of tones, so that 100 Hz samples lose nothing of them.

/** Tones of equal power at random frequencies and phases, {hz, nm, rad}, of this rms. */
function tones(random, rms_nm, low_hz, high_hz, count) {
  return Array.from({ length: count }, (_, i) => ({
    hz: low_hz + (high_hz - low_hz) * (i + random.share()) / count,
    nm: rms_nm * Math.sqrt(2 / count), rad: random.between(0, 2 * Math.PI) }));
}

/** A triangle of this height, as far as 3 Hz. */
function triangle(height_nm, hz) {
  const all = [];
  for (let n = 1; n * hz < 3; n += 2) {
    all.push({ hz: n * hz, nm: height_nm * 8 / (Math.PI * n) ** 2, rad: Math.PI / 2 });
  }
  return all;
}

const sum = (all) => (time_s) => {
  let torque_nm = 0;
  for (const tone of all) torque_nm += tone.nm * Math.sin(2 * Math.PI * tone.hz * time_s + tone.rad);
  return torque_nm;
};

/** The torque that turns the arm by these tones of angle (`nm` is rad here): each by the arm's stiffness at it. */
function turning(arm, angles) {
  return angles.map(({ hz, nm: rad_, rad }) => {
    const w = 2 * Math.PI * hz;
    const real = arm.stiffness_nm_per_rad - arm.inertia_kgm2 * w * w;
    const imaginary = arm.damping_nms_per_rad * w;
    return { hz, nm: rad_ * Math.hypot(real, imaginary), rad: rad + Math.atan2(imaginary, real) };
  });
}

/** {task, driver, motor, unmeasured, applied_rms_nm} of a task: passive, probe or active, as the paper has them. */
export function drawTorques(random, task, arm) {
  let driver = tones(random, random.between(0.06, 0.2), 0.05, 1.2, 20);
  let motor = tones(random, task === 'probe' ? random.between(1.3, 2.4) : random.between(0.7, 1.6), 0.1,
    random.between(4, 7), 32);
  if (task === 'passive') motor = [...motor, ...triangle(random.between(4, 6), 0.025)];
  if (task === 'active') {
    const swing = tones(random, random.between(0.4, 0.65), 0.2, 0.3, 6);
    driver = [...driver, ...turning(arm, [...swing, ...tones(random, 0.02, 0.4, 1.4, 12)])];
  }
  const power = [...driver, ...motor].reduce((all, tone) => all + tone.nm ** 2 / 2, 0);
  const unmeasured = tones(random, random.between(0, 0.015) * Math.sqrt(power), 0.02, 0.8, 16);
  return { task, driver: sum(driver), motor: sum(motor), unmeasured: sum(unmeasured) };
}
