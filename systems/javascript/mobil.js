// mobil for JavaScript: the C interface as WebAssembly.
//   import { load } from './mobil.js';
//   const mobil = await load('.');                       // the folder of mobil.wasm and mobil-plain.wasm
//   const world = mobil.world();
//   const people = world.spawn([{ height_m: 1.8, mass_kg: 80, speed_m_s: 1.4 }], { method: METHODS.explicit_central });
//   world.tick(60);
//   world.matrices(people);                              // 48 × 3 × 4 floats
import { constants as c, structs } from './interface.js';
import { Library, MobilError, canFuse, canRun } from './library.js';
import { World } from './world.js';

export { AXES, CONSTITUTIONS, FEATURES, METHODS, People, STATES, World } from './world.js';
export { Surfaces } from './surfaces.js';
export { MobilError, canFuse, canRun };
export const constants = c;

const listed = (name) => {
  const all = [];
  for (let at; (at = name(all.length)) !== null;) all.push(at);
  return all;
};

class Mobil {
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
      return listed((i) => (x.mobil_style(i, at) === 0 ? library.object('mobil_style_number', at, ['name', 'unit', 'meaning']) : null));
    });
  }
  /** Returns the segment of each bone of a host's skeleton, or null, by its name or the end of it (person_7_head):
   *  programs number bones in another order. */
  segmentsOf(bones) {
    const own = (bone) => this.segments.find((name) => bone === name || (bone.endsWith(name) && !/[A-Za-z0-9]/.test(bone.at(-name.length - 1))));
    return bones.map((bone) => (own(bone) === undefined ? null : this.segments.indexOf(own(bone))));
  }
  /** Returns the levels of detail of a muscle with measurements: {name, method, modes, moving, error_m, cost_us}. */
  levels(muscle, { speed_m_s = 1.4, height_m = 1.8, inertia = false, pulling = false } = {}) {
    return this.library.within((take) => {
      const at = take(structs.mobil_level.size);
      return listed((i) => (this.library.x.mobil_lod_level(i, muscle, speed_m_s, height_m, inertia ? 1 : 0, pulling ? 1 : 0, at) === 0 ? this.library.object('mobil_level', at, ['name']) : null));
    });
  }
  /** Deprecated, removed in 0.5; use levels. */
  ways(...all) { return this.levels(...all); }
  /** Creates a world. `options`: fields of mobil_options. */
  world(options = {}) { return new World(this.library, options); }
}

/** Loads the library. `from`: the folder with the modules, or the bytes of one; then `fused` is true for mobil.wasm. */
export async function load(from = '.', fused = canFuse()) {
  if (!canRun()) throw new MobilError('this browser has no WebAssembly SIMD; Chrome 91, Firefox 89, Safari 16.4 and later have', c.MOBIL_REFUSED);
  const source = from instanceof Uint8Array ? from : `${from}/${fused ? 'mobil' : 'mobil-plain'}.wasm`;
  return new Mobil(await Library.load(source), fused);
}
