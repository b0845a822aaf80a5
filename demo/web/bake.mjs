// Precomputes the shared data of the page's default muscles, so that the page starts fast.
// Usage: node --experimental-wasm-relaxed-simd bake.mjs PACKAGE OUT
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';

const [, , folder, out] = process.argv;
const { METHODS, load } = await import(path.resolve(folder, 'mobil.js'));
const mobil = await load(new Uint8Array(readFileSync(path.join(folder, 'mobil.wasm'))), true);
const world = mobil.world();
world.prepare({ method: METHODS.modal, modes: 12, control_points: 1, reported: 1 });
writeFileSync(out, world.bake());
