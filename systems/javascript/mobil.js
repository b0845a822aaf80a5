// mobil for JavaScript: the C interface as WebAssembly.
//   import { METHODS, load } from 'mobil';
//   const mobil = await load();
//   const world = mobil.world();
//   const people = world.spawn([{ height_m: 1.8, mass_kg: 80, speed_m_s: 1.4 }], { method: METHODS.explicit_central });
//   world.tick(60);
//   world.matrices(people);                              // 48 × 3 × 4 floats
import { constants as c, structs } from './interface.js';
import { Library, MobilError, canFuse, canRun } from './library.js';
import { World } from './world.js';

export { AXES, CONSTITUTIONS, FEATURES, METHODS, People, STATES, World } from './world.js';
export { Avoidance, Lod, Terrain } from './subjects.js';
export { DETAILS, SKIN_PARTS } from './skins.js';
export { Surfaces } from './surfaces.js';
export { MobilError, canFuse, canRun };
export const constants = c;

const listed = (name) => {
  const all = [];
  for (let at; (at = name(all.length)) !== null;) all.push(at);
  return all;
};

export class Mobil {
  constructor(library, fused) {
    const { x } = library, text = (at) => (at === 0 ? null : library.text(at));
    this.library = library;
    /** True if the bits are those of desktops. */
    this.fused = fused;
    this.version = library.text(x.mobil_library_version());
    this.segments = listed((i) => text(x.mobil_segment_name(i)));
    this.parents = this.segments.map((_, i) => x.mobil_segment_parent(i));
    this.muscles = listed((i) => text(x.mobil_muscle_name(i)));
    /** Parameters of a walk's style, {name, unit, meaning, low, high, usual}, in the order of spawn and changeWalk. */
    this.style = library.within((take) => {
      const at = take(structs.mobil_style_number.size);
      return listed((i) => (x.mobil_style(i, at) === 0 ? library.object('mobil_style_number', at) : null));
    });
  }
  /** Returns the segment of each bone of a host's skeleton, or null, by its name or the end of it (person_7_head):
   *  programs number bones in another order. */
  segmentsOf(bones) {
    const own = (bone) => this.segments.find((name) => bone === name || (bone.endsWith(name) && !/[A-Za-z0-9]/.test(bone.at(-name.length - 1))));
    return bones.map((bone) => (own(bone) === undefined ? null : this.segments.indexOf(own(bone))));
  }
  /** Returns the fields of a typical person for spawn, with usual speed and style. `sex`: 0 man, 1 woman. The deviations
   *  are standard scores of stature and body mass index for that age. */
  typicalPerson(sex, age_y = 25, height_z = 0, mass_index_z = 0) {
    return this.library.within((take) => {
      const { x } = this.library, at = take(structs.mobil_person.size), many = this.style.length, numbers = take(4 * many);
      x.mobil_defaults(c.MOBIL_PERSON, at, structs.mobil_person.size);
      const code = x.mobil_typical_person(sex, age_y, height_z, mass_index_z, numbers, many, at);
      if (code !== 0) throw new MobilError(`typicalPerson: no body of sex ${sex} at ${age_y} years deviates by ${height_z} and ${mass_index_z}; choose sex 0 or 1, 6 to 95 years, and smaller deviations`, code);
      const { height_m, mass_kg, speed_m_s } = this.library.object('mobil_person', at);
      return { sex, age_y, height_m, mass_kg, speed_m_s, style: Array.from(new Float32Array(this.library.memory.buffer, numbers, many)) };
    });
  }
  /** Returns the levels of detail of a muscle with measurements: {name, method, modes, moving, error_m, cost_us}. */
  levels(muscle, { speed_m_s = 1.4, height_m = 1.8, inertia = false, pulling = false } = {}) {
    return this.library.within((take) => {
      const at = take(structs.mobil_level.size);
      return listed((i) => (this.library.x.mobil_lod_level(i, muscle, speed_m_s, height_m, inertia ? 1 : 0, pulling ? 1 : 0, at) === 0 ? this.library.object('mobil_level', at) : null));
    });
  }
  /** Deprecated, removed in 0.5; use levels. */
  ways(...all) { return this.levels(...all); }
  /** Creates a world. `options`: fields of mobil_options. */
  world(options = {}) { return new World(this.library, options); }
}

/** Returns the address of a module in a folder, which is an address or, in Node, a path. */
async function addressIn(from, file) {
  const isFile = /\.wasm$/.test(from), at = isFile ? from : `${from.replace(/\/$/, '')}/${file}`;
  if (typeof document === 'object' || typeof process === 'undefined' || /^[a-z][a-z+.-]+:/i.test(from)) return at;
  const urls = 'node:url';
  return (await import(/* webpackIgnore: true */ /* @vite-ignore */ urls)).pathToFileURL(at).href;
}

/** Loads the library. `from`: the folder with the modules, the address of one, or the bytes of one; without it the modules
 *  of this package. `fuse`: takes mobil.wasm from a folder, otherwise mobil-plain.wasm. */
export async function load(from, fuse = canFuse()) {
  if (!canRun()) throw new MobilError('this browser has no WebAssembly SIMD; Chrome 91, Firefox 89, Safari 16.4 and later have', c.MOBIL_REFUSED);
  let source;
  // Bundlers look for these two expressions, and copy the files.
  if (from === undefined) source = (fuse ? new URL('./mobil.wasm', import.meta.url) : new URL('./mobil-plain.wasm', import.meta.url)).href;
  else if (from instanceof ArrayBuffer || ArrayBuffer.isView(from)) source = new Uint8Array(from.buffer ?? from, from.byteOffset ?? 0, from.byteLength);
  else source = await addressIn(String(from), fuse ? 'mobil.wasm' : 'mobil-plain.wasm');
  const library = await Library.load(source);
  return new Mobil(library, library.x.mobil_fuses() !== 0);
}
