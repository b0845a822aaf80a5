// Precomputes the skins of the page's crowd: adults of three builds, and children, of both sexes, each in three levels
// of detail with common vertices. The page has no time to make them (seconds), and draws them on the graphics card.
// Usage: node --experimental-wasm-relaxed-simd bake_skins.mjs PACKAGE NODE_MODULES OUT
import { writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [, , folder, modules, out] = process.argv;
const { DETAILS, load } = await import(pathToFileURL(path.resolve(folder, 'mobil.js')));
const { MeshoptSimplifier } = await import(pathToFileURL(createRequire(path.resolve(modules, 'x.js')).resolve('meshoptimizer')));
await MeshoptSimplifier.ready;
const triangles = [3600, 1000, 320], per_m = 16000;
const ages = [[25, -1], [25, 0], [25, 1], [13, 0], [8, 0]];  // age and standard score of the body mass index

/** Returns the triangles of a binding with one vertex for each place and part, and the first of its vertices for each. */
function joined(skin) {
  const found = new Map(), from = [], part = [], index = new Uint32Array(skin.indices.length);
  skin.parts.forEach(({ first_index, indices }, p) => {
    for (let i = first_index; i < first_index + indices; ++i) {
      const v = skin.indices[i], key = 8 * skin.same_as[v] + p;
      if (!found.has(key)) {
        found.set(key, from.length);
        from.push(v);
        part.push(p);
      }
      index[i] = found.get(key);
    }
  });
  return { from, part, index };
}
const picked = (all, from, width) => Float32Array.from({ length: width * from.length }, (_, i) => all[width * from[Math.floor(i / width)] + (i % width)]);

/** Returns the levels of detail of a mesh, each made from the one before, so that all use vertices of the first. */
function levels(skin, { from, index }) {
  const places = picked(skin.positions, from, 3), normals = picked(skin.normals, from, 3), all = [];
  let last = index;
  for (const wanted of triangles) {
    [last] = MeshoptSimplifier.simplifyWithAttributes(last, places, 3, normals, 3, [0.02, 0.02, 0.02], null, 3 * wanted, 1);
    all.push(last);
  }
  return all;
}
/** Returns four weights as bytes that add up to 255. */
function bytes(weights) {
  const all = Array.from(weights, (w) => Math.round(255 * w));
  all[0] += 255 - all.reduce((a, b) => a + b);
  return all;
}

const mobil = await load(folder), world = mobil.world(), chunks = [], about = { per_m, sexes: [] };
let at = 0;
function put(array) {
  const begin = at, padding = (4 - (array.byteLength % 4)) % 4;
  chunks.push(Buffer.from(array.buffer, array.byteOffset, array.byteLength), Buffer.alloc(padding));
  at += array.byteLength + padding;
  return begin;
}
for (const sex of [0, 1]) {
  const bodies = ages.map(([age_y, mass_index_z]) => ({ ...mobil.typicalPerson(sex, age_y, 0, mass_index_z), speed_m_s: 0 }));
  const people = world.spawn(bodies), skins = bodies.map((_, i) => world.skinBinding(people.slice(i), DETAILS.near));
  const usual = skins[1], mesh = joined(usual), detail = levels(usual, mesh), kept = [...new Set(detail[0])], place = new Map(kept.map((v, i) => [v, i]));
  const from = kept.map((v) => mesh.from[v]), index = Uint16Array.from(detail.flatMap((level) => Array.from(level, (v) => place.get(v))));
  let first = 0;
  about.sexes.push({
    vertices: kept.length, index: put(index), levels: detail.map((level) => ({ first: (first += level.length) - level.length, count: level.length })),
    parts: put(Uint8Array.from(kept, (v) => mesh.part[v])), joints: put(Uint8Array.from(picked(usual.joints, from, 4))),
    weights: put(Uint8Array.from(from.flatMap((v) => bytes(usual.weights.subarray(4 * v, 4 * v + 4))))),
    bodies: skins.map((skin, i) => ({
      age_y: bodies[i].age_y, height_m: bodies[i].height_m, mass_kg: bodies[i].mass_kg,
      positions: put(Int16Array.from(picked(skin.positions, from, 3), (x) => Math.round(per_m * x))),
      normals: put(Int8Array.from(picked(skin.normals, from, 3), (x) => Math.round(127 * x))),
      centres: put(Float32Array.from({ length: 144 }, (_, i) => -skin.inverse_binds[4 * i + 3])),  // of joints
    })),
  });
  console.log(`${['men', 'women'][sex]}: ${kept.length} vertices, ${detail.map((level) => level.length / 3).join(', ')} triangles of ${usual.indices.length / 3}`);
}
const head = Buffer.from(JSON.stringify(about)), size = Buffer.alloc(4), padding = Buffer.alloc((4 - (head.length % 4)) % 4, ' ');
size.writeUInt32LE(head.length + padding.length);
writeFileSync(out, Buffer.concat([size, head, padding, ...chunks]));
