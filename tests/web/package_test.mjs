// The JavaScript package in Node: ownership of handles, structs read back, setPoses and other calls.
// Usage: node --experimental-wasm-relaxed-simd package_test.mjs PACKAGE. Exit status 1: a test failed.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = path.resolve(process.argv[2]);
const { FEATURES, METHODS, MobilError, STATES, constants: c, load } = await import(pathToFileURL(path.join(folder, 'mobil.js')));
const mobil = await load(new Uint8Array(readFileSync(path.join(folder, 'mobil.wasm'))), true);

// Blocks of the library's memory that JavaScript allocated and has not released.
const live = new Set();
const { library } = mobil, { allocate, release } = library;
let wrongly = 0;
library.allocate = (bytes) => {
  const at = allocate.call(library, bytes);
  live.add(at);
  return at;
};
library.release = (at) => {
  if (at === 0) return;
  if (live.delete(at)) release.call(library, at);
  else ++wrongly;
};
const spawned = (world, count = 5, more = {}) => world.spawn(Array.from({ length: count }, (_, i) => ({ height_m: 1.8, mass_kg: 80, speed_m_s: 1.2, place: [2 * i, 0, 0], ...more })));
const refused = (line, code) => (error) => error instanceof MobilError && !error.message.includes('\n') && line.test(error.message) && (code === undefined || error.code === code);
const gone = refused(/despawned or forgotten/, c.MOBIL_STALE);

test('typical people can be spawned', () => {
  const world = mobil.world(), child = mobil.typicalPerson(1, 8), tall = mobil.typicalPerson(0, 40, 2);
  assert.ok(child.height_m > 1.2 && child.height_m < 1.35 && tall.height_m > 1.85 && child.speed_m_s < tall.speed_m_s);
  assert.equal(world.spawn([child, tall]).count, 2);
  assert.throws(() => mobil.typicalPerson(1, 3), refused(/6 to 95 years/, c.MOBIL_REFUSED));
});

test('a slice owns nothing, and what has gone is refused', () => {
  const world = mobil.world(), before = live.size, people = spawned(world);
  assert.equal(live.size, before + 1);
  const some = people.slice(2);
  world.tick();
  world.matrices(some);
  world.despawn(some);
  assert.throws(() => world.matrices(some), gone);
  assert.throws(() => world.despawn(some), gone);
  assert.throws(() => some.slice(0), gone);
  assert.throws(() => world.matrices(people), refused(/gone|stale|person 2/i, c.MOBIL_STALE));
  assert.equal(world.read(c.MOBIL_CENTRE, people.slice(0, 2)).length, 6);
  world.despawn(people.slice(0, 2));
  assert.equal(world.read(c.MOBIL_CENTRE, people.slice(3, 5)).length, 6);
  const others = spawned(world, 3);  // wrongly freed handles would be reused here
  const last = people.slice(3, 5);
  world.despawn(last);
  people.forget();
  people.forget();
  assert.throws(() => people.slice(0), gone);
  assert.throws(() => world.despawn(people), gone);
  assert.equal(world.matrices(others).length, 3 * 576);
  const view = others.slice(0), of_view = others.slice(0, 2).slice(1);
  world.despawn(others);
  assert.throws(() => world.despawn(others), gone);
  for (const old of [view, of_view]) assert.throws(() => world.matrices(old), gone);
  for (const call of [() => world.walk(view), () => world.surfaces(view), () => world.avoidance.setDesiredVelocity(others, [[1, 0], [1, 0], [1, 0]]), () => world.enable(others, FEATURES.fat)]) assert.throws(call, gone);
  others.forget();
  assert.equal(live.size, before);
  assert.equal(wrongly, 0);
  world.destroy();
});

test('reading many slices takes no memory', () => {
  const world = mobil.world(), people = spawned(world, 20);
  world.tick();
  const all = world.read(c.MOBIL_CENTRE, people).slice(), before = live.size;
  for (let i = 0; i < 20; ++i) assert.deepEqual([...world.read(c.MOBIL_CENTRE, people.slice(i))], [...all.subarray(3 * i, 3 * i + 3)]);
  world.matrices(people.slice(0, 7));
  assert.equal(live.size, before);
  people.forget();
  assert.equal(live.size, before - 2);
  world.destroy();
});

test('slices lie within those whom they are of', () => {
  const world = mobil.world(), people = spawned(world, 3);
  for (const [begin, end] of [[-1], [4], [2, 1], [0.5], [NaN]]) assert.throws(() => people.slice(begin, end), refused(/no slice from/, c.MOBIL_REFUSED));
  assert.equal(people.slice(1, 99).count, 2);
  for (const call of [(nobody) => world.place(nobody, [0, 0, 0], 0), (nobody) => world.walk(nobody), (nobody) => world.surfaces(nobody)]) {
    assert.throws(() => call(people.slice(3)), refused(/nobody among these/));
  }
  world.despawn(people);
  world.destroy();
});

test('surfaces are dropped once', () => {
  const world = mobil.world(), people = spawned(world, 1), before = live.size;
  const surfaces = world.surfaces(people, { bones: 1, muscles: 0 });
  world.tick();
  assert.ok(surfaces.write(people).length > 0);
  assert.equal(surfaces.tissue.length, 4 * surfaces.vertices);
  assert.ok(surfaces.tissue.every((byte) => byte === 0));  // bones
  surfaces.drop();
  surfaces.drop();
  assert.throws(() => surfaces.write(people), refused(/were dropped/));
  assert.equal(live.size, before);
  assert.equal(wrongly, 0);
  world.destroy();
});

test('fields that hold several numbers come back as arrays', () => {
  const world = mobil.world(), people = world.spawn([{ height_m: 1.8, mass_kg: 80 }], { method: METHODS.modal, modes: 8, control_points: 1 });
  const method = world.method(people, 1);
  assert.equal(method.method, METHODS.modal);
  assert.ok(method.modal_cells.length === 3 && method.modal_cells.every((n) => n > 0), `${method.modal_cells}`);
  world.tick(5);
  const before = world.hash();
  world.setMethod(people, 1, method);
  assert.deepEqual(world.method(people, 1), method);
  assert.equal(world.hash(), before);
  assert.throws(() => world.setMethod(people, 1, { ...method, modal_cells: [4] }), refused(/modal_cells.*3 numbers/));
  world.destroy();
});

test('events say where feet strike', () => {
  const world = mobil.world(), people = spawned(world, 1);
  world.enable(people, FEATURES.stepEvents);
  const places = [];
  for (let i = 0; i < 120; ++i) {
    world.tick();
    for (const { kind, place } of world.events()) if (kind === c.MOBIL_HEEL_STRIKE) places.push(place);
  }
  assert.ok(places.length >= 2 && places.every((p) => p.length === 3));
  assert.ok(places.every((p, i) => i === 0 || p[2] > places[i - 1][2] + 0.3));
  world.destroy();
});

test('posed people take the poses of a walker', () => {
  const world = mobil.world(), walker = spawned(world, 1), posed = spawned(world, 2, { posed: 1, speed_m_s: undefined });
  world.tick(20);
  const pose = world.poses(walker).slice();
  assert.equal(pose.length, 7 * 48);
  world.setPoses(posed, [...pose, ...pose]);
  world.tick();
  const got = world.poses(posed);
  for (let i = 0; i < got.length; ++i) assert.ok(Math.abs(got[i] - pose[i % pose.length]) < 1e-5, `float ${i}: ${got[i]} is not ${pose[i % pose.length]}`);
  world.setPoses(posed.slice(0), world.poses(walker), true);  // a view of the library's memory
  world.tick();
  assert.ok(Math.abs(world.poses(posed.slice(0))[2] - world.poses(posed.slice(1))[2]) > 0.005);
  const before = world.hash();
  assert.throws(() => world.setPoses(posed, pose), refused(/poses: 672 numbers are wanted, and there are 336/));
  assert.throws(() => world.setPoses(walker, pose), refused(/./));
  assert.equal(world.hash(), before);
  world.destroy();
});

test('muscles of the host pull as they are told', () => {
  const world = mobil.world(), people = world.spawn([0, 1].map((i) => ({ height_m: 1.8, mass_kg: 80, place: [i, 0, 0] })), { method: METHODS.explicit_central, activation: c.MOBIL_BY_HOST });
  const excitation = () => Array.from({ length: 2 }, (_, i) => world.readMuscle(c.MOBIL_ACTIVATION, people.slice(i), c.MOBIL_QUADRICEPS)[0]);
  world.setExcitation(people, c.MOBIL_QUADRICEPS, c.MOBIL_RIGHT, [0.25, 0.75]);
  world.tick();
  assert.deepEqual(excitation(), [0.25, 0.75]);
  world.setExcitation(people, c.MOBIL_QUADRICEPS, c.MOBIL_RIGHT, 0.5);
  world.tick();
  assert.deepEqual(excitation(), [0.5, 0.5]);
  assert.throws(() => world.setExcitation(people, c.MOBIL_QUADRICEPS, c.MOBIL_RIGHT, [0.5]), refused(/excitations: 2 numbers/));
  world.destroy();
});

test('a walk is read back as it is asked for', () => {
  const world = mobil.world(), style = mobil.style.map((n) => n.usual), toes = mobil.style.findIndex((n) => n.name === 'toe_out_deg');
  style[toes] = 12;
  const people = spawned(world, 2, { style });
  world.changeWalk(people, { heading_rad: 0.5 });
  const walk = world.walk(people.slice(1));
  assert.equal(walk.heading_rad, 0.5);
  assert.ok(Math.abs(walk.speed_m_s - 1.2) < 1e-6 && walk.step_length_m > 0.4 && walk.step_length_m < 0.9);
  assert.equal(walk.style.length, mobil.style.length);
  assert.equal(walk.style[toes], 12);
  world.changeWalk(people.slice(1), { speed_m_s: 1.5 });
  world.changeWalk(people.slice(1), walk);
  assert.deepEqual(world.walk(people.slice(1)), walk);
  const posed = spawned(world, 1, { posed: 1, speed_m_s: undefined });
  assert.throws(() => world.walk(posed), refused(/does not walk/, c.MOBIL_MISSING));
  world.destroy();
});

test('the origin moves, and rows have the length that the library reads', () => {
  const world = mobil.world(), people = spawned(world, 2);
  world.avoidance.manage(people);
  world.shiftOrigin([64, 0, 0]);
  const roots = world.roots(people);
  assert.deepEqual([roots[0], roots[4]], [-64, -62]);
  const before = world.hash();
  for (const call of [() => world.shiftOrigin([1, 2]), () => world.place(people, [1, 2, 3, 4], 0), () => world.avoidance.setDesiredVelocity(people, [[1], [1, 0, 0]]),
    () => world.avoidance.setWalls([[0, 0, 0]]), () => world.avoidance.setDiscs([[0, 0, 0, 0]]), () => world.changeWalk(people, { speed_m_s: 1, nothing: 2 })]) {
    assert.throws(call, refused(/number|has no/, c.MOBIL_REFUSED));
  }
  assert.equal(world.hash(), before);
  world.avoidance.setDesiredVelocity(people, [new Float32Array([1, 0]), [1, 0]]);
  world.destroy();
});

test('one advance a frame chooses, steers and asks for the ground', () => {
  const world = mobil.world(), people = spawned(world);
  world.lod.setOptions({ machine_factor: 1 });
  world.lod.setScene({ tolerance_m: 0.002 });
  world.lod.manage(people.slice(0, 2));
  world.avoidance.manage(people);
  world.terrain.setHeights((places, count) => Float32Array.from({ length: 4 * count }, (_, i) => (i % 4 === 0 ? 0.1 * places[3 * (i >> 2) + 2] : [0, 0, 1, -0.1][i % 4])));
  world.terrain.manage(people);
  const sums = { looked: 0, chose: 0, places: 0 };
  for (let frame = 0; frame < 40; ++frame) {
    assert.ok([2, 3].includes(world.advance(0.04).count));
    sums.looked += world.lod.report.looked_at;
    sums.chose += world.avoidance.report.chose;
    sums.places += world.terrain.report.places;
  }
  assert.ok(Object.values(sums).every((n) => n > 0), JSON.stringify(sums));
  assert.ok(world.matrices(people.slice(4))[7] > 1.05);  // on level ground hips are below 1 m
  const { unusable } = world.terrain.report;
  assert.equal(unusable, 0);
  world.terrain.setHeights(() => { throw new RangeError('away'); });
  assert.throws(() => world.tick(60), RangeError);
  world.terrain.setHeights(null);
  world.tick(10);
  assert.equal(world.terrain.report.places, 0);
  world.destroy();
});

test('integers are whole and in range, numbers are numbers', () => {
  const world = mobil.world(), people = spawned(world, 2), state = world.hash();
  for (const call of [
    () => world.spawn([{ height_m: [1.7, 1.8] }]), () => world.spawn([{ height_m: NaN }]), () => world.spawn([{ sex: 0.5 }]),
    () => world.spawn([{ sex: 'woman' }]), () => world.spawn([{ sex: 2 ** 40 }]), () => world.spawn([{ place: [0, 0, 'x'] }]),
    () => world.tick(1.5), () => world.tick(-1), () => world.tick(2 ** 32), () => world.tick(NaN), () => world.advance(NaN),
    () => world.enable(people, 0.5), () => world.setState(people, 'asleep'), () => world.read(null, people),
    () => world.setMuscles(people, { method: '' + METHODS.modal + 'x' }), () => world.setMuscles(people, { modes: 4.5 }),
  ]) assert.throws(call, refused(/give an? (integer|number)|out of range/, c.MOBIL_REFUSED));
  assert.equal(world.hash(), state);
  world.spawn([{ height_m: 1.7, sex: true, mass_kg: undefined }]).forget();
});

test('states, and old names', () => {
  const world = mobil.world(), people = spawned(world, 4);
  world.tick(120);
  assert.equal(world.setState(people.slice(0, 2), STATES.asleep), 2);
  assert.equal(world.state(people.slice(1)), STATES.asleep);
  assert.equal(world.compact(people.slice(2, 4)), 2);
  world.expand(people);
  assert.equal(world.state(people.slice(3)), STATES.full);
  world.setForces(people);
  world.startAvoidance();
  world.avoid(people);
  world.tick();
  assert.equal(world.steer().people, 4);
  assert.equal(world.read(c.MOBIL_GROUND, people).length, 48);
  world.destroy();
});
