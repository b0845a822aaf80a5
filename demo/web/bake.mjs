// Precomputes the shared data of the page's default muscles, so that the page starts fast.
// Usage: node --experimental-wasm-relaxed-simd bake.mjs PACKAGE OUT
import { writeFileSync } from 'node:fs';
import path from 'node:path';

const [, , folder, out] = process.argv;
const { METHODS, load } = await import(path.resolve(folder, 'mobil.js'));
const world = (await load(folder)).world();
world.prepare({ method: METHODS.modal, modes: 12, control_points: 1, reported: 1 });
writeFileSync(out, world.bake());
