// A crowd in one draw call: the 48 matrices of each person are copied unchanged to a row of a texture, and each segment
// is an ellipsoid in the box of its bone. People walk in lanes with one speed each, or in four directions while they
// avoid each other.
import * as THREE from 'three';

const lane_m = 1.1, apart_m = 1.6, length_m = 60, room_m2 = 4;
const vertexShader = `
uniform sampler2D poses; uniform vec3 fogColour;
in float segment; in vec4 look; out vec3 colour;
void main() {
  int s = 3 * int(segment + 0.5);
  vec4 a = texelFetch(poses, ivec2(s, gl_InstanceID), 0), b = texelFetch(poses, ivec2(s + 1, gl_InstanceID), 0), c = texelFetch(poses, ivec2(s + 2, gl_InstanceID), 0);
  vec4 p = vec4(position * look.x, 1);
  vec4 e = viewMatrix * vec4(dot(a, p), dot(b, p), dot(c, p), 1);
  vec3 n = normalize(vec3(dot(a.xyz, normal), dot(b.xyz, normal), dot(c.xyz, normal)));
  float light = 0.5 + 0.5 * max(0., dot(n, normalize(vec3(.3, .8, .5))));
  colour = mix(light * look.yzw, fogColour, smoothstep(18., 60., -e.z));
  gl_Position = projectionMatrix * e;
}`;
const fragmentShader = 'in vec3 colour; out vec4 o; void main() { o = linearToOutputTexel(vec4(colour, 1)); }';

function random(seed) {
  return () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

/** Returns requests of `count` people on both sides of a walker at x = 0 who heads along z. */
function requests(count) {
  const next = random(7), all = [], lanes = Math.max(2, Math.ceil(count / Math.floor(length_m / apart_m)));
  for (let lane = 0; all.length < count; ++lane) {
    const side = lane % 2 ? 1 : -1, x = side * ((side > 0 ? 2.9 : 1.7) + lane_m * Math.floor(lane / 2)), ahead = lane % 4 < 2;
    const speed = 1 + 0.6 * next(), here = Math.ceil((count - all.length) / (lanes - lane)), gap = Math.max(apart_m, length_m / here);
    for (let i = 0; i < here; ++i) {
      const height = 1.55 + 0.35 * next();
      all.push({
        height_m: height, mass_kg: height * height * (20 + 7 * next()), constitution: Math.floor(4 * next()), speed_m_s: speed,
        heading_rad: ahead ? 0 : Math.PI, place: [x, 0, gap * (i + 0.3 * next()) - length_m / 2],
      });
    }
  }
  return all;
}

/** Returns requests of `count` people on an area `length_m` long, `room_m2` each, who walk in four directions. */
function requestsAllOver(count, from) {
  const next = random(7), broad_m = Math.max(20, (count * room_m2) / length_m), all = [];
  const even = (x) => 2 * Math.ceil(x / 2);  // keeps the middle free for the person
  const columns = even(Math.sqrt((count * broad_m) / length_m)), rows = even(count / columns);
  const within = (cell, cells, all_m) => ((cell + 0.3 + 0.4 * next()) / cells - 0.5) * all_m;
  for (let i = 0; i < count; ++i) {
    const height = 1.55 + 0.35 * next(), x = within(i % columns, columns, broad_m), z = within(Math.floor(i / columns), rows, length_m);
    all.push({
      height_m: height, mass_kg: height * height * (20 + 7 * next()), constitution: Math.floor(4 * next()), speed_m_s: 1.1 + 0.5 * next(),
      heading_rad: [0, Math.PI, Math.PI / 2, -Math.PI / 2][Math.floor(4 * next())], place: [from.x + x, 0, from.z + z],
    });
  }
  return { all, broad_m };
}

export class Crowd {
  /** `figure`: source of the boxes of segments, which are scaled by height. `clear`: people avoid each other and start
   *  around `from`. */
  constructor(world, count, figure, height_m, parent, clear, from) {
    this.world = world;
    this.clear = clear;
    if (clear) ({ all: this.asked, broad_m: this.broad_m } = requestsAllOver(count, from));
    else this.asked = requests(count);
    // People who avoid each other start standing, because two walkers spawned close together could not stop in time.
    this.people = world.spawn(this.asked.map((r) => (clear ? { ...r, speed_m_s: 0 } : r)));
    if (clear) {
      world.avoidance.manage(this.people);
      world.avoidance.setDesiredVelocity(this.people, this.asked.map((r) => [r.speed_m_s, r.heading_rad]));
    }
    const { geometry, looks } = this.#geometry(figure, height_m);
    this.looks = looks;
    this.texture = new THREE.DataTexture(new Float32Array(576 * count), 144, count, THREE.RGBAFormat, THREE.FloatType);
    this.fogColour = { value: parent.fog.color };
    this.mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({ glslVersion: THREE.GLSL3, uniforms: { poses: { value: this.texture }, fogColour: this.fogColour }, vertexShader, fragmentShader }));
    this.mesh.frustumCulled = false;
    parent.add(this.mesh);
    this.clothes();
    this.next = 0;
  }
  #geometry(figure, height_m) {
    const ball = new THREE.OctahedronGeometry(1, this.asked.length > 1000 ? 0 : this.asked.length > 200 ? 1 : 2).attributes.position;
    const position = [], normal = [], segment = [], v = new THREE.Vector3();
    for (const bone of figure.bones) {
      const box = new THREE.Box3(), { index, attributes } = bone.geometry;
      for (let i = 0; i < index.count; ++i) box.expandByPoint(v.fromBufferAttribute(attributes.position, index.getX(i)));
      const centre = box.getCenter(new THREE.Vector3()), half = box.getSize(new THREE.Vector3()).multiplyScalar(0.5).addScalar(0.012);
      for (let i = 0; i < ball.count; ++i) {
        v.fromBufferAttribute(ball, i);
        position.push(centre.x + v.x * half.x, centre.y + v.y * half.y, centre.z + v.z * half.z);
        normal.push(v.x / half.x, v.y / half.y, v.z / half.z);
        segment.push(bone.userData.segment);
      }
    }
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.instanceCount = this.asked.length;
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
    geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normal, 3));
    geometry.setAttribute('segment', new THREE.Float32BufferAttribute(segment, 1));
    const looks = new THREE.InstancedBufferAttribute(new Float32Array(4 * this.asked.length), 4);
    this.asked.forEach((r, i) => { looks.array[4 * i] = r.height_m / height_m; });
    geometry.setAttribute('look', looks);
    return { geometry, looks };
  }
  #colour(i, r, g, b) {
    this.looks.array.set([r, g, b], 4 * i + 1);
    this.looks.needsUpdate = true;
  }
  /** Sets random colours. */
  clothes() {
    const next = random(11);
    for (let i = 0; i < this.people.count; ++i) this.#colour(i, 0.2 + 0.3 * next(), 0.22 + 0.3 * next(), 0.26 + 0.3 * next());
  }
  /** Colours the next `some` people by the cost of their muscles per tick: grey without simulation, then blue to red
   *  from 0.2 to 5 µs. */
  heat(some = 200) {
    for (let k = 0; k < Math.min(some, this.people.count); ++k) {
      const i = this.next++ % this.people.count, person = this.people.slice(i);
      let cost = 0;
      for (let muscle = 0; muscle < 4; ++muscle) cost += this.world.lod.why(person, muscle).cost_us;
      const hot = Math.min(1, Math.max(0, Math.log10(cost / 0.2) / Math.log10(25)));
      if (cost < 0.01) this.#colour(i, 0.3, 0.3, 0.3);
      else this.#colour(i, 0.05 + 0.9 * hot, 0.25 * (1 - Math.abs(2 * hot - 1)) + 0.05, 0.9 * (1 - hot) + 0.03);
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
  pose(x, z) {
    const matrices = this.texture.image.data;
    matrices.set(this.world.matrices(this.people));  // a copy: views end when memory grows
    this.texture.needsUpdate = true;
    this.wrap(x, z, matrices);
  }
  drop() {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.texture.dispose();
    this.world.despawn(this.people);
  }
}
