// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel and an arm in MuJoCo, whose authors knew nothing of this project:
//
//   J th'' + B th' + C th = torque, a hinge. All else that a wheel may have is MuJoCo's own:
//
//   coulomb_friction        `frictionloss` of the hinge, a constraint that is a little soft
//   quadratic_damping       `damping` with a second coefficient
//   cubic_stiffness         `stiffness` with a third coefficient
//   gravity_imbalance       a mass beside the hinge, and gravity
//   torque_bias             `biasprm` of the driver's actuator: it makes another torque than it is asked for
//   compliance              the arm is a body of its own, on a second hinge with a spring and a damper
//   backlash                so, but the second hinge turns freely within its `range`: the arm is only pushed
//   lag                     actuators with `dyntype="filter"`
//   delay                   `delay` of the angle's sensor
//   time_varying_stiffness  the hinge's stiffness becomes another one while it runs
//   periodic_disturbance    a torque of no actuator
//   torque_saturation       what is written down of the torques is clipped
//   end_stop                the hinge's `range` ends in a soft contact on one side; no vocabulary has it
//   clutch                  a mass that dry friction carries along; nor this
//
// Runge and Kutta's steps of fourth order with the torque of a step's middle: MuJoCo's other integrators take damping
// implicitly, which adds B step/2 to the inertia, half a percent of it here.
import loadMujoco from '@mujoco/mujoco';

const mujoco = await loadMujoco();
const STEP_S = 0.0005;
const STEPS_A_SAMPLE = 20;
const LEAD_IN_S = 6;
const GRAVITY_M_S2 = 9.81;

const inertial = (kgm2, at = '0 0 0', kg = 1) =>
  `<inertial pos="${at}" mass="${kg}" diaginertia="${kgm2} ${kgm2} ${kgm2}"/>`;

/** The wheel's mass: in its axis, or beside it so that it weighs m g r sin(th + phi). */
function wheelMass(inertia_kgm2, weight) {
  if (!weight) return inertial(inertia_kgm2);
  const radius_m = 0.05;
  const mass_kg = weight.weight_torque_nm / (GRAVITY_M_S2 * radius_m);
  const at = `0 ${radius_m * Math.sin(weight.phase_rad)} ${-radius_m * Math.cos(weight.phase_rad)}`;
  return inertial(inertia_kgm2 - mass_kg * radius_m ** 2, at, mass_kg);
}

/** What hangs on the wheel by a hinge of its own. */
function hungBody(name, joint, inertia_kgm2) {
  return `<body><joint name="${name}" axis="1 0 0" ${joint}/>${inertial(inertia_kgm2)}</body>`;
}

/** MuJoCo's model. `arm` {inertia_kgm2, damping_nms_per_rad, stiffness_nm_per_rad}; `effects` {id: numbers by name}. */
function mjcf(arm, effects) {
  const { coulomb_friction: friction, quadratic_damping: quadratic, cubic_stiffness: cubic, gravity_imbalance: weight,
    compliance, backlash, torque_bias: bias, lag, delay, end_stop: stop, clutch } = effects;
  const split = compliance ?? backlash;
  const wheel = { inertia_kgm2: arm.inertia_kgm2 * (split?.wheel_inertia_share ?? 1),
    damping_nms_per_rad: arm.damping_nms_per_rad * (split?.wheel_damping_share ?? 1) };

  const hinge = [
    `stiffness="${split ? 0 : arm.stiffness_nm_per_rad} 0 ${cubic?.cubic_stiffness_nm_per_rad3 ?? 0}"`,
    `damping="${wheel.damping_nms_per_rad} ${quadratic?.quadratic_damping_nms2_per_rad2 ?? 0} 0"`];
  if (friction) hinge.push(`frictionloss="${friction.friction_nm}" solreffriction="${friction.settling_s} 1"`);
  if (stop) {
    hinge.push(`limited="true" range="-9 ${stop.stop_rad}" solreflimit="${stop.settling_s} 0.7"`);
  }

  const hung = [];
  if (split) {
    const grip = compliance
      ? `stiffness="${compliance.grip_stiffness_nm_per_rad}" damping="${compliance.grip_damping_nms_per_rad}"`
      : `limited="true" range="${-backlash.half_gap_rad} ${backlash.half_gap_rad}" solreflimit="0.004 1"`;
    hung.push(hungBody('grip', grip, arm.inertia_kgm2 - wheel.inertia_kgm2));
  }
  if (clutch) {
    const dry = `frictionloss="${clutch.friction_nm}" solreffriction="0.004 1"`;
    hung.push(hungBody('clutch', dry, clutch.inertia_kgm2));
  }
  const armOnGround = split ? `<tendon><fixed stiffness="${arm.stiffness_nm_per_rad}"
    damping="${arm.damping_nms_per_rad - wheel.damping_nms_per_rad}">
    <joint joint="wheel" coef="1"/><joint joint="grip" coef="1"/></fixed></tendon>` : '';

  const dynamics = lag ? `dyntype="filter" dynprm="${lag.time_constant_s}"` : '';
  const offset = bias ? `biastype="affine" biasprm="${-bias.bias_nm}"` : '';
  const actuators = `<general joint="wheel" ${dynamics} ${offset}/><general joint="wheel" ${dynamics}/>`;
  const late = delay
    ? `delay="${delay.delay_s}" nsample="${Math.ceil(delay.delay_s / STEP_S) + 4}" interp="cubic"` : '';
  return `<mujoco>
    <compiler angle="radian"/>
    <option timestep="${STEP_S}" integrator="RK4" gravity="0 0 ${-GRAVITY_M_S2}"/>
    <worldbody><body><joint name="wheel" axis="1 0 0" ${hinge.join(' ')}/>
      ${wheelMass(wheel.inertia_kgm2, weight)}${hung.join('')}</body></worldbody>
    ${armOnGround}
    <actuator>${actuators}</actuator>
    <sensor><jointpos joint="wheel" ${late}/></sensor>
  </mujoco>`;
}

/** What turns the wheel and no actuator makes, Nm, at a time. */
function hiddenTorque({ periodic_disturbance: wave }, unmeasured, time_s) {
  const periodic = wave
    ? wave.amplitude_nm * Math.sin(2 * Math.PI * wave.frequency_hz * time_s + wave.phase_rad) : 0;
  return unmeasured(time_s) + periodic;
}

/**
 * Samples at 100 Hz, {time_s, torque_driver_nm, torque_motor_nm, angle_rad}, without noise. `driver`, `motor` and
 * `unmeasured` give a torque in Nm at a time in s; the motor's counts against the driver's.
 */
export function drive(arm, effects, { driver, motor, unmeasured, duration_s }) {
  const model = mujoco.MjModel.from_xml_string(mjcf(arm, effects));
  const data = new mujoco.MjData(model);
  const change = effects.time_varying_stiffness;
  const limit_nm = effects.torque_saturation?.limit_nm ?? Infinity;
  const written = (torque_nm) => Math.max(-limit_nm, Math.min(limit_nm, torque_nm));
  const samples = [];
  try {
    for (let step = 0; ; ++step) {
      const time_s = step * STEP_S - LEAD_IN_S;
      const sample = step / STEPS_A_SAMPLE - LEAD_IN_S * 100;
      if (sample >= duration_s * 100) break;
      if (change && time_s >= change.time_s) {
        model.jnt_stiffness[0] = arm.stiffness_nm_per_rad * change.stiffness_ratio;
      }
      const middle_s = time_s + STEP_S / 2;
      data.ctrl[0] = driver(middle_s);
      data.ctrl[1] = -motor(middle_s);
      data.qfrc_applied[0] = hiddenTorque(effects, unmeasured, middle_s);
      mujoco.mj_step(model, data);  // leaves what the sensors read at the step's beginning
      if (sample < 0 || step % STEPS_A_SAMPLE !== 0) continue;
      samples.push({ time_s, angle_rad: data.sensordata[0], torque_driver_nm: written(driver(time_s)),
        torque_motor_nm: written(motor(time_s)) });
    }
  } finally {
    data.delete();
    model.delete();
  }
  return samples;
}
