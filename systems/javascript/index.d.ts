// Types of the classes. interface.d.ts, made from mobil.h, has those of structs and constants.
import type * as c from './interface.js';

export type * from './interface.js';
export declare const constants: c.Constants;

type Numbers = ArrayLike<number>;
/** A struct that the library returns: all fields are there. */
export type Returned<T> = { [K in keyof T]-?: NonNullable<T[K]> extends string ? string : NonNullable<T[K]> extends number | boolean ? number : number[] };
/** Values of a walk's style, in the order of Mobil.style. */
export interface Style { style?: Numbers }
/** A request for a person. */
export type PersonRequest = c.mobil_person & Style;
/** A change of a walk. */
export type WalkRequest = c.mobil_walk & Style;

/** Error of a refused call: one line with the mistake, the valid range and the remedy. */
export declare class MobilError extends Error {
  constructor(line: string, code: number);
  /** A code of mobil.h, for example MOBIL_REFUSED. */
  readonly code: number;
}
/** Returns true if this engine has SIMD of 128 bits, which both modules need. */
export declare function canRun(): boolean;
/** Returns true if this engine can run mobil.wasm, which has the bits of desktops. */
export declare function canFuse(): boolean;
/** Loads the library. `from`: the folder with the modules, the address of one, or the bytes of one; without it the modules
 *  of this package. `fuse`: takes mobil.wasm from a folder, otherwise mobil-plain.wasm. */
export declare function load(from?: string | { readonly href: string } | ArrayBuffer | Uint8Array, fuse?: boolean): Promise<Mobil>;

export declare const METHODS: { readonly static: number; readonly explicit_central: number; readonly implicit_central: number; readonly newmark: number; readonly modal: number; readonly none: number; readonly finite: number };
export declare const AXES: { readonly yUp: number; readonly unity: number; readonly unreal: number; readonly godot: number; readonly zUp: number };
export declare const STATES: { readonly full: number; readonly compact: number; readonly asleep: number; readonly posed: number };
export declare const FEATURES: { readonly stepEvents: number; readonly fat: number; readonly forces: number };
export declare const DETAILS: { readonly hero: number; readonly near: number; readonly far: number; readonly distant: number };
export declare const CONSTITUTIONS: readonly ['thin', 'average', 'athletic', 'heavy'];
/** Names of the parts of skins. */
export declare const SKIN_PARTS: readonly ['skin', 'legs', 'lips', 'hair', 'shirt', 'shorts', 'shoes'];

/** The module and its memory. */
export interface Library {
  readonly memory: { readonly buffer: ArrayBuffer };
}

export declare class Mobil {
  private constructor();
  readonly library: Library;
  /** True if the bits are those of desktops. */
  readonly fused: boolean;
  readonly version: string;
  /** Names of the 48 segments. */
  readonly segments: string[];
  /** Parent of each segment; the pelvis is its own. */
  readonly parents: number[];
  readonly muscles: string[];
  readonly style: Returned<c.mobil_style_number>[];
  /** Returns the segment of each bone of a host's skeleton by name, or null. */
  segmentsOf(bones: readonly string[]): (number | null)[];
  /** Returns the fields of a typical person for spawn, with usual speed and style. Deviations are standard scores. */
  typicalPerson(sex: number, age_y?: number, height_z?: number, mass_index_z?: number): { sex: number; age_y: number; height_m: number; mass_kg: number; speed_m_s: number; style: number[] };
  /** Returns the levels of detail of a muscle with measurements. */
  levels(muscle: number, body?: { speed_m_s?: number; height_m?: number; inertia?: boolean | number; pulling?: boolean | number }): Returned<c.mobil_level>[];
  /** @deprecated removed in 0.5; use levels */
  ways(muscle: number, body?: { speed_m_s?: number; height_m?: number; inertia?: boolean | number; pulling?: boolean | number }): Returned<c.mobil_level>[];
  world(options?: c.mobil_options): World;
}

/** People of one world. Those of spawn own memory; a slice is a view. */
export declare class People {
  private constructor();
  readonly library: Library;
  readonly count: number;
  /** Address of the handles. */
  get ids(): number;
  /** Returns the handle of the first person: two numbers. */
  handle(): Uint32Array;
  slice(begin: number, end?: number): People;
  /** Returns the address of memory for that many floats. */
  room(floats: number): number;
  /** Frees the handles' memory. The people are not removed. */
  forget(): void;
}

export interface StepEvent {
  person: { index: number; generation: number };
  kind: number;
  side: number;
  tick: number;
  part: number;
  heading_rad: number;
  place: number[];
}
/** A skin for the graphics card: fields of mobil_skin_binding. */
export interface SkinBinding {
  sex: number;
  vertices: number;
  parts: { name: (typeof SKIN_PARTS)[number]; first_index: number; indices: number }[];
  positions: Float32Array;
  normals: Float32Array;
  tangents: Float32Array;
  texture: Float32Array;
  joints: Uint8Array;
  weights: Float32Array;
  same_as: Uint32Array;
  indices: Uint32Array;
  /** Three rows of four for each segment. */
  inverse_binds: Float32Array;
}

/** Arrays that it returns are views into the library's memory, valid until the next call, except those of roots(), save(),
 *  bake() and skinBinding(). */
export declare class World {
  private constructor();
  readonly library: Library;
  /** Address of the simulation; 0 after destroy(). */
  readonly at: number;
  readonly tick_s: number;
  get time_s(): number;
  readonly lod: Lod;
  readonly avoidance: Avoidance;
  readonly terrain: Terrain;
  destroy(): void;
  /** Throws the error of a refused call. */
  must(code: number): number;

  spawn(requests: readonly PersonRequest[], muscles?: c.mobil_muscles | null): People;
  despawn(people: People): void;
  changeWalk(people: People, walk: WalkRequest): void;
  place(person: People, place: Numbers, heading_rad: number): void;
  shiftOrigin(to: Numbers): void;
  setPoses(people: People, poses: Float32Array | readonly number[], jumped?: boolean): void;
  walk(person: People): { style: number[]; speed_m_s?: number; step_length_m?: number; step_frequency_hz?: number; heading_rad?: number };
  enable(people: People, feature: number, on?: boolean | number): void;
  setState(people: People, state: number, within_m?: number): number;
  state(person: People): number;

  setMuscles(people: People, muscles: c.mobil_muscles | null): void;
  setMethod(people: People, muscle: number, method: c.mobil_method): void;
  setExcitation(people: People, muscle: number, side: number, excitation: number | Float32Array | readonly number[]): void;
  prepare(muscles?: c.mobil_muscles | null): void;
  bake(): Uint8Array;
  loadBaked(baked: Uint8Array): void;
  method(person: People, muscle: number): Returned<c.mobil_method>;

  tick(ticks?: number): void;
  advance(seconds: number): Returned<c.mobil_ticks>;

  events(): StepEvent[];
  /** Returns four numbers a person: position and heading. */
  roots(people: People, ahead_s?: number): Float64Array;
  /** Returns 48 segments times three rows of four, a person. */
  matrices(people: People, ahead_s?: number): Float32Array;
  /** Returns 48 segments times position and quaternion, a person. */
  poses(people: People, ahead_s?: number): Float32Array;
  body(person: People): Returned<c.mobil_segment>[];
  read(what: number, people: People): Float32Array;
  readMuscle(what: number, people: People, muscle: number, side?: number): Float32Array;
  cost(): Returned<c.mobil_system>[];
  surfaces(like: People, choice?: c.mobil_surface_choice): Surfaces;
  /** Returns the skin of a person, for people of the same sex and similar build. A vertex is at the sum of weight * matrix *
   *  inverse bind * position over its joints. */
  skinBinding(person: People, detail?: number): SkinBinding;

  save(): Uint8Array;
  restore(state: Uint8Array): void;
  /** Returns 16 hexadecimal digits. */
  hash(): string;

  /** @deprecated removed in 0.5; use enable with FEATURES.forces */
  setForces(people: People, on?: boolean): void;
  /** @deprecated removed in 0.5; use enable with FEATURES.fat */
  setFatWobble(people: People, on?: boolean): void;
  /** @deprecated removed in 0.5; use enable with FEATURES.stepEvents */
  watch(people: People, on?: boolean): void;
  /** @deprecated removed in 0.5; use setState with STATES.asleep */
  sleep(people: People): number;
  /** @deprecated removed in 0.5; use setState with STATES.compact */
  compact(people: People): number;
  /** @deprecated removed in 0.5; use setState with STATES.full */
  wake(people: People, within_m?: number): number;
  /** @deprecated removed in 0.5; use setState with STATES.full */
  expand(people: People): number;
  /** @deprecated removed in 0.5; use lod.setOptions */
  startChoosing(options?: c.mobil_lod_options, muscles?: c.mobil_muscles | null): void;
  /** @deprecated removed in 0.5; use lod.setScene */
  setScene(scene: c.mobil_scene): void;
  /** @deprecated removed in 0.5; use lod.manage */
  manage(people: People, needs?: c.mobil_needs): void;
  /** @deprecated removed in 0.5; use lod.release */
  letGo(people: People): void;
  /** @deprecated removed in 0.5; use lod.report */
  choose(): Returned<c.mobil_lod_counts>;
  /** @deprecated removed in 0.5; use lod.why */
  why(person: People, muscle: number): { why: string; error_m: number; cost_us: number };
  /** @deprecated removed in 0.5; use avoidance.setOptions */
  startAvoidance(options?: c.mobil_avoidance_options): void;
  /** @deprecated removed in 0.5; use avoidance.manage and release */
  avoid(people: People, on?: boolean): void;
  /** @deprecated removed in 0.5; use avoidance.setDesiredVelocity */
  want(people: People, wishes: readonly Numbers[]): void;
  /** @deprecated removed in 0.5; use avoidance.setWalls */
  setWalls(walls: readonly Numbers[]): void;
  /** @deprecated removed in 0.5; use avoidance.setDiscs */
  setDiscs(discs: readonly Numbers[]): void;
  /** @deprecated removed in 0.5; use avoidance.report */
  steer(): Returned<c.mobil_avoidance_counts>;
  /** @deprecated removed in 0.5; use terrain.manage and release */
  setOnGround(people: People, on?: boolean): void;
  /** @deprecated removed in 0.5; use terrain.setSpeedScaling */
  setSlowing(on: boolean): void;
  /** @deprecated removed in 0.5; use terrain.setHeights */
  updateGround(heights: Heights | null): void;
}

/** Bones and muscles of one body as triangles. */
export declare class Surfaces {
  private constructor();
  readonly world: World;
  /** Address of the surfaces; 0 after drop(). */
  readonly at: number;
  /** Address of the vertices that write() fills. */
  readonly buffer: number;
  readonly vertices: number;
  readonly indices: Uint32Array;
  /** Four bytes a vertex: along and around the surface, tendon, aponeurosis, 0 to 255 for 0 to 1. */
  readonly tissue: Uint8Array;
  /** `muscle` is negative for bones. */
  readonly parts: Returned<c.mobil_part>[];
  /** Returns position and normal of each vertex, six floats. */
  write(person: People, origin?: Numbers, ahead_s?: number): Float32Array;
  drop(): void;
}

/** Level of detail: each tick gives managed people the cheapest methods that the scene allows. */
export declare class Lod {
  private constructor();
  setOptions(options?: c.mobil_lod_options, muscles?: c.mobil_muscles | null): void;
  setScene(scene: c.mobil_scene): void;
  prepare(): void;
  manage(people: People, needs?: c.mobil_needs): void;
  release(people: People): void;
  /** Counts of all ticks of the last advance() or tick(). */
  get report(): Returned<c.mobil_lod_counts>;
  why(person: People, muscle: number): { why: string; error_m: number; cost_us: number };
}
/** Collision avoidance between walkers, and with walls and discs. */
export declare class Avoidance {
  private constructor();
  setOptions(options?: c.mobil_avoidance_options): void;
  manage(people: People): void;
  release(people: People): void;
  /** Sets [speed in m/s, heading in rad] for each person. */
  setDesiredVelocity(people: People, wishes: readonly Numbers[]): void;
  /** Replaces all walls: two positions each. `heights`: bottom and top of each. */
  setWalls(walls: readonly Numbers[], heights?: readonly Numbers[] | null): void;
  /** Replaces all discs: position, velocity and radius each. */
  setDiscs(discs: readonly Numbers[], heights?: readonly Numbers[] | null): void;
  get report(): Returned<c.mobil_avoidance_counts>;
}
/** Receives three numbers for each position; returns four: height and normal. */
export type Heights = (places: Float32Array, count: number) => Numbers;
/** Uneven ground. */
export declare class Terrain {
  private constructor();
  setHeights(heights: Heights | null): void;
  manage(people: People): void;
  release(people: People): void;
  setSpeedScaling(on?: boolean): void;
  get report(): Returned<c.mobil_terrain_counts>;
}
