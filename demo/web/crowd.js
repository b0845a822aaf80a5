// A crowd as skins. People walk in lanes with one speed each, or in four directions while they avoid each other.
import * as THREE from 'three';
import { SkinnedPeople } from './skins.js';

const lane_m = 1.1, apart_m = 1.6, length_m = 60, room_m2 = 4;
// sRGB. Parts: skin, legs below the shorts, lips, hair, shirt, shorts, shoes.
const complexions = ['f1cdb4', 'e3b592', 'd09a74', 'ab7650', '7f5236', '553726'], hairs = ['191512', '33241a', '5a3d27', '8d6a43', 'bd9a66', '8a8a8a'];
const shirts = ['f0efe9', '2f3a4a', '8fa6b8', '7a2e2b', '3e5a44', 'c8b48a', '5b5f66', 'a8556b', '2c6478', 'd0a03c', '171a20', '6d5a86'];
const trousers = ['2b3242', '3d4a5f', '1e1f23', '6c6353', '8b8168', '4d4f54', '5c4534'], shoes = ['1c1c1e', '3a2a20', 'dad9d4', '4c5561'];

function random(seed) {
  return () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

/** Returns people who walk together, side by side: one adult, or a parent and a child, who walk at the child's speed.
 *  `family`: the chance of the latter. */
function party(typical, next, family) {
  const z = () => { let sum = -6; for (let i = 0; i < 12; ++i) sum += next(); return Math.max(-2, Math.min(2, sum)); };
  const person = (age_y) => ({ ...typical(Math.floor(2 * next()), age_y, z(), z()), constitution: Math.floor(4 * next()) });
  if (next() >= family) return [person(18 + 67 * next())];
  const child_y = 6 + 10 * next(), both = [person(26 + child_y + 8 * next()), person(child_y)], speed_m_s = Math.min(...both.map((one) => one.speed_m_s));
  return both.map((one) => ({ ...one, speed_m_s }));
}
const abreast_m = 0.35, family_share = 0.25;
const aside = (i, all) => abreast_m * (2 * i - all.length + 1);

/** Returns requests of `count` people on both sides of a walker at x = 0 who heads along z. Everybody in a lane has one
 *  speed; families have lanes of their own. */
function requests(count, typical) {
  const next = random(7), all = [], lanes = Math.max(2, Math.ceil(count / Math.floor(length_m / apart_m)));
  for (let lane = 0; all.length < count; ++lane) {
    const side = lane % 2 ? 1 : -1, x = side * ((side > 0 ? 2.9 : 1.7) + lane_m * Math.floor(lane / 2)), ahead = lane % 4 < 2;
    const families = lane % 4 === 1 || lane % 4 === 2 ? 0.7 : 0, speed_m_s = families ? 1 + 0.05 * next() : 1.05 + 0.5 * next();
    const here = Math.ceil((count - all.length) / Math.max(1, lanes - lane) / (1 + families)), gap = Math.max(apart_m, length_m / here);
    for (let i = 0; i < here && all.length < count; ++i) {
      const ahead_m = gap * (i + 0.3 * next()) - length_m / 2, people = party(typical, next, families).slice(0, count - all.length);
      people.forEach((one, k) => all.push({ ...one, speed_m_s, heading_rad: ahead ? 0 : Math.PI, place: [x + aside(k, people), 0, ahead_m] }));
    }
  }
  return all;
}

/** Returns requests of `count` people on an area `length_m` long, `room_m2` each, who walk in four directions. */
function requestsAllOver(count, from, typical) {
  const next = random(7), broad_m = Math.max(20, (count * room_m2) / length_m), all = [];
  const even = (x) => 2 * Math.ceil(x / 2);  // keeps the middle free for the person
  const parties = count / (1 + family_share), columns = even(Math.sqrt((parties * broad_m) / length_m)), rows = even(parties / columns);
  const within = (cell, cells, all_m) => ((cell + 0.3 + 0.4 * next()) / cells - 0.5) * all_m;
  for (let cell = 0; all.length < count; ++cell) {
    const x = from.x + within(cell % columns, columns, broad_m), z = from.z + within(Math.floor(cell / columns), rows, length_m);
    const heading_rad = [0, Math.PI, Math.PI / 2, -Math.PI / 2][Math.floor(4 * next())], people = party(typical, next, family_share).slice(0, count - all.length);
    people.forEach((one, k) => all.push({
      ...one, heading_rad, place: [x + aside(k, people) * Math.cos(heading_rad), 0, z - aside(k, people) * Math.sin(heading_rad)],
    }));
  }
  return { all, broad_m };
}

export class Crowd {
  /** `typical`: typicalPerson of the library. `skins`: a Skins. `clear`: people avoid each other and start around
   *  `from`. */
  constructor(world, typical, count, skins, parent, clear, from) {
    this.world = world;
    this.clear = clear;
    if (clear) ({ all: this.asked, broad_m: this.broad_m } = requestsAllOver(count, from, typical));
    else this.asked = requests(count, typical);
    // People who avoid each other start standing, because two walkers spawned close together could not stop in time.
    this.people = world.spawn(this.asked.map((r) => (clear ? { ...r, speed_m_s: 0 } : r)));
    if (clear) {
      world.avoidance.manage(this.people);
      world.avoidance.setDesiredVelocity(this.people, this.asked.map((r) => [r.speed_m_s, r.heading_rad]));
    }
    this.texture = new THREE.DataTexture(new Float32Array(576 * count), 144, count, THREE.RGBAFormat, THREE.FloatType);
    this.skins = new SkinnedPeople(skins, this.asked, this.texture, parent.fog, parent);
    this.clothes();
    this.next = 0;
  }
  /** Sets random complexions, hair and clothes; half of the people wear shorts. */
  clothes() {
    const next = random(11);
    const of = (all) => { const hex = all[Math.floor(all.length * next())]; return [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)); };
    for (let i = 0; i < this.people.count; ++i) {
      const skin = of(complexions), legs = of(trousers), bare = next() < 0.5, lips = [skin[0] * 0.85, skin[1] * 0.68, skin[2] * 0.68];
      [skin, bare ? skin : legs, lips, of(hairs), of(shirts), legs, of(shoes)].forEach((rgb, part) => this.skins.colour(i, part, rgb));
    }
  }
  /** Colours the next `some` people by the cost of their muscles per tick: grey without simulation, then blue to red
   *  from 0.2 to 5 µs. */
  heat(some = 200) {
    for (let k = 0; k < Math.min(some, this.people.count); ++k) {
      const i = this.next++ % this.people.count, person = this.people.slice(i);
      let cost = 0;
      for (let muscle = 0; muscle < 4; ++muscle) cost += this.world.lod.why(person, muscle).cost_us;
      const hot = Math.min(1, Math.max(0, Math.log10(cost / 0.2) / Math.log10(25)));
      const linear = cost < 0.01 ? [0.3, 0.3, 0.3] : [0.05 + 0.9 * hot, 0.25 * (1 - Math.abs(2 * hot - 1)) + 0.05, 0.9 * (1 - hot) + 0.03];
      this.skins.colour(i, null, linear.map((x) => 255 * x ** (1 / 2.2)));
    }
  }
  /** Moves people too far behind or ahead of the walker at (x, z) to the other end of the street. With avoidance the
   *  place must be free, and people too far to the side turn back. */
  wrap(x, z, matrices) {
    const away = [], placed = [], place = (i) => [matrices[576 * i + 3], matrices[576 * i + 11]];
    for (let i = 0; i < this.people.count; ++i) {
      const dx = matrices[576 * i + 3] - x, dz = matrices[576 * i + 11] - z;
      if (Math.abs(dz) > 0.6 * length_m) away.push([i, z + dz - 1.2 * length_m * Math.sign(dz)]);
      if (this.clear && Math.abs(dx) > 0.5 * this.broad_m) this.#turn(i, dx > 0 ? -Math.PI / 2 : Math.PI / 2);
    }
    const isFree = (to) => {  // two people who meet need three metres to stop
      const near = (at) => Math.hypot(at[0] - to[0], at[1] - to[1]) < 3;
      for (let i = 0; i < this.people.count; ++i) if (near(place(i))) return false;
      return !placed.some(near);
    };
    for (const [i, to_z] of away) {
      const asked = this.asked[i], to = [this.clear ? place(i)[0] : asked.place[0], to_z];
      if (this.clear && !isFree(to)) continue;
      this.world.place(this.people.slice(i), [to[0], 0, to[1]], asked.heading_rad);
      placed.push(to);
    }
  }
  #turn(i, heading_rad) {
    const asked = this.asked[i];
    if (asked.heading_rad === heading_rad) return;
    asked.heading_rad = heading_rad;
    this.world.avoidance.setDesiredVelocity(this.people.slice(i), [[asked.speed_m_s, heading_rad]]);
  }
  /** Moves the skins to the poses of the last tick, for the walker at (x, z) and the camera. */
  pose(x, z, camera) {
    const matrices = this.texture.image.data;
    matrices.set(this.world.matrices(this.people));  // a copy: views end when memory grows
    this.texture.needsUpdate = true;
    this.skins.choose(camera);
    this.wrap(x, z, matrices);
  }
  drop() {
    this.skins.drop();
    this.texture.dispose();
    this.world.despawn(this.people);
  }
}
