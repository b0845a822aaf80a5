// Computes a walk's inverse dynamics with MuJoCo. Usage: node inverse_dynamics.mjs FOLDER, with walk.xml and
// walk_motion.csv of `mobil walk --muscles single --method none --export walk.xml`, and its motion.csv and muscles.csv.
// Prints a line `NAME VALUE…` per result, in N, N m, mm and parts; the last value of most is the largest one. The
// root's residual is the part that the ground forces leave. Status 2: bad usage or no such file; 77: the npm package
// mujoco-js was not found in MOBIL_NODE_MODULES or the working folder.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const packages = [process.env.MOBIL_NODE_MODULES, join(process.cwd(), 'node_modules')].filter(Boolean);
const found = packages.map((folder) => join(folder, 'mujoco-js/dist/mujoco_wasm.js')).find(existsSync);
const folder = process.argv[2];
if (process.argv.length !== 3) {
  console.error('usage: node inverse_dynamics.mjs FOLDER');
  process.exit(2);
}
if (!found) {
  console.error('mujoco-js is not installed; npm install --prefix FOLDER mujoco-js, then set ' +
                'MOBIL_NODE_MODULES=FOLDER/node_modules');
  process.exit(77);
}

function text(name) {
  try {
    return readFileSync(join(folder, name), 'utf8');
  } catch (error) {
    console.error(`${join(folder, name)}: cannot be read (${error.code})`);
    process.exit(2);
  }
}
function table(name) {
  const [head, ...lines] = text(name).trim().split('\n');
  const columns = head.split(',');
  return lines.map((line) => Object.fromEntries(line.split(',').map((cell, i) => [columns[i], cell])));
}
function starting(row, name) {
  return Object.keys(row).filter((column) => column.startsWith(name)).map((column) => Number(row[column]));
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const minus = (a, b) => a.map((x, i) => x - b[i]);
const rms = (a) => Math.sqrt(a.reduce((sum, x) => sum + x * x, 0) / a.length);
const largest = (a) => a.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
const mean = (a) => a.reduce((sum, x) => sum + x, 0) / a.length;
const series = {};
const add = (name, value) => (series[name] ??= []).push(value);
const print = (name, ...values) => console.log(name, ...values.map((x) => x.toFixed(4)));

const mujoco = await (await import(pathToFileURL(found))).default();
mujoco.FS.writeFile('/walk.xml', text('walk.xml'));
const model = mujoco.MjModel.loadFromXML('/walk.xml'), data = new mujoco.MjData(model);
const motion = table('walk_motion.csv'), own = table('motion.csv');
const BODY = 1, TENDON = 18, SENSORS = 4;
const NO_CONSTRAINT = 1, NO_CONTACT = 1 << 4, LIMIT_OF_JOINT = 3;
const body = (name) => mujoco.mj_name2id(model, BODY, name);
const at = (array, b, width = 3) => Array.from(array.slice(width * b, width * (b + 1)));
const sides = ['right', 'left'];

print('size', model.nq, model.nv, model.nbody, model.nu);
print('mass', Array.from(model.body_mass).reduce((sum, x) => sum + x, 0));
const key = minus(Array.from(model.key_qpos).slice(0, model.nq), starting(motion[0], 'qpos_'));
print('keyframe', largest(key));

model.opt.disableflags = NO_CONTACT;
let limits = 0;
for (const row of motion) {
  data.qpos.set(starting(row, 'qpos_'));
  mujoco.mj_forward(model, data);
  for (const type of Array.from(data.efc_type).slice(0, data.nefc)) limits += type === LIMIT_OF_JOINT ? 1 : 0;
}
print('limits', limits);

// Residual of the root and moments of the legs' joints, when the recorded forces act on the feet.
model.opt.disableflags = NO_CONSTRAINT;
motion.forEach((row, i) => {
  data.qpos.set(starting(row, 'qpos_'));
  data.qvel.set(starting(row, 'qvel_'));
  data.qacc.set(starting(row, 'qacc_'));
  mujoco.mj_inverse(model, data);
  data.xfrc_applied.fill(0);
  for (const side of sides) {
    const foot = body(`foot_${side}`);
    const of = (name, unit) => ['x', 'y', 'z'].map((axis) => Number(row[`${name}_${axis}_${side}_${unit}`]));
    const pull = of('ground_force', 'n'), arm = minus(of('centre_of_pressure', 'm'), at(data.xipos, foot));
    const moment = cross(arm, pull);
    moment[1] += Number(row[`free_moment_${side}_nm`]);
    data.xfrc_applied.set([...pull, ...moment], 6 * foot);
  }
  mujoco.mj_rnePostConstraint(model, data);
  const centre = at(data.subtree_com, body('pelvis'));
  // A joint's force and moment between a body and its parent, at the body's origin, in the world.
  const between = (b) => {
    const [tx, ty, tz, ...force] = at(data.cfrc_int, b, 6);
    const turned = cross(minus(centre, at(data.xpos, b)), force);
    return { force, moment: [tx + turned[0], ty + turned[1], tz + turned[2]] };
  };
  const ahead = sides.map((side) => at(data.xmat, body(`thigh_${side}`), 9)).reduce(
      (sum, m) => [sum[0] + m[2], 0, sum[2] + m[8]], [0, 0, 0]);
  const length = Math.hypot(ahead[0], ahead[2]), facing = ahead.map((x) => x / length);
  const across = [facing[2], 0, -facing[0]];
  sides.forEach((side, k) => {
    const mine = (column) => Number(own[i][`${column}_${side}_nm`]), inward = k === 0 ? 1 : -1;
    const compare = (name, mujocos, mobils) => {
      add(`${name} mujoco`, mujocos);
      add(`${name} mobil`, mobils);
    };
    const hip = between(body(`thigh_${side}`)).moment;
    compare('hip', dot(hip, across), mine('hip_moment'));
    compare('abduction', -inward * dot(hip, facing), mine('hip_abduction'));
    compare('rotation', inward * hip[1], mine('hip_rotation'));
    compare('knee', -dot(between(body(`shank_${side}`)).moment, across), mine('knee_moment'));
    compare('ankle', dot(between(body(`foot_${side}`)).moment, across), mine('ankle_moment'));
  });
  const root = between(body('pelvis'));
  add('force', Math.hypot(...root.force));
  add('pitch', dot(root.moment, across));
  add('yaw', root.moment[1]);
  add('roll', dot(root.moment, facing));
  add('centre', 1000 * Math.hypot(...minus(centre, ['x', 'y', 'z'].map((axis) => Number(own[i][`com_${axis}_m`])))));
});
for (const name of ['hip', 'abduction', 'rotation', 'knee', 'ankle']) {
  const a = series[`${name} mobil`], b = series[`${name} mujoco`];
  print(name, largest(a), largest(b), rms(minus(a, b)), largest(minus(a, b)));
}
for (const name of ['force', 'pitch', 'roll', 'yaw', 'centre']) print(name, rms(series[name]), largest(series[name]));

// Lengths of tendons and of the simulation's lines of action: mean difference, largest difference from it.
const lines = {};
for (const row of table('muscles.csv')) (lines[`${row.group}_${row.side}`] ??= []).push(Number(row.line_length_m));
const names = Object.keys(lines).filter((name) => mujoco.mj_name2id(model, TENDON, name) >= 0);
motion.forEach((row, i) => {
  data.qpos.set(starting(row, 'qpos_'));
  mujoco.mj_forward(model, data);
  for (const name of names)
    add(`tendon ${name}`, 1000 * (data.ten_length[mujoco.mj_name2id(model, TENDON, name)] - lines[name][i]));
});
for (const name of names) {
  const gap = series[`tendon ${name}`];
  print(`tendon_${name}`, mean(gap), largest(gap.map((x) => x - mean(gap))), largest(gap));
}

// A tenth of a second from the keyframe, with contacts: the soles feel the floor.
model.opt.disableflags = 0;
mujoco.mj_resetDataKeyframe(model, data, 0);
let felt = 0;
for (let i = 0; i < 50; ++i) {
  mujoco.mj_step(model, data);
  felt = Math.max(felt, Array.from(data.sensordata).slice(0, SENSORS).reduce((sum, x) => sum + x, 0));
}
print('touch', felt, largest(Array.from(data.qvel)));
