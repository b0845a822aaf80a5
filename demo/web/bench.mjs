// Times of ticks as WebAssembly, median and best of 200, µs.
// Usage: node --experimental-wasm-relaxed-simd bench.mjs PACKAGE
import { readFileSync } from 'node:fs';
import path from 'node:path';

const [, , folder] = process.argv;
const { METHODS, load } = await import(path.resolve(folder, 'mobil.js'));
const mobil = await load(new Uint8Array(readFileSync(path.join(folder, 'mobil.wasm'))), true);

function time(name, body) {
  const times = [];
  for (let i = 0; i < 200; ++i) {
    const began = performance.now();
    body();
    times.push(1000 * (performance.now() - began));
  }
  times.sort((a, b) => a - b);
  console.log(`${name.padEnd(44)} ${times[100].toFixed(0).padStart(6)} (${times[0].toFixed(0)})`);
}
function bench(name, count, muscles) {
  const world = mobil.world();
  const people = world.spawn(Array.from({ length: count }, (_, i) => ({
    height_m: 1.6 + (0.3 * (i % 17)) / 17, mass_kg: 70, speed_m_s: 1 + (0.5 * (i % 13)) / 13, place: [i % 40, 0, Math.floor(i / 40)],
  })), muscles);
  world.tick(300);  // until the engine has optimized the frequent calls
  time(name, () => world.tick());
  if (!muscles) time(`matrices of ${count}`, () => world.matrices(people));
  world.destroy();
}
const modal = { method: METHODS.modal, modes: 12 };
bench('one person, eight muscles, explicit', 1, { method: METHODS.explicit_central });
bench('one person, modal, control points', 1, { ...modal, control_points: 1 });
bench('1000 people, bones', 1000, null);
bench('1000 people, modal, unseen', 1000, { ...modal, control_points: 0 });
bench('1000 people, modal, control points', 1000, { ...modal, control_points: 1 });
