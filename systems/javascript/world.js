// mobil.h as a class: people, their walks and muscles, time and reading. Returned arrays are views into the library's
// memory, valid until the next call; copy them with `.slice()` to keep them.
import { constants as c, structs } from './interface.js';
import { MobilError, numberOf } from './library.js';
import { Avoidance, Lod, Terrain } from './subjects.js';
import { DETAILS, skinBinding } from './skins.js';
import { Surfaces } from './surfaces.js';

export const METHODS = { static: c.MOBIL_STATIC, explicit_central: c.MOBIL_EXPLICIT_CENTRAL, implicit_central: c.MOBIL_IMPLICIT_CENTRAL, newmark: c.MOBIL_NEWMARK, modal: c.MOBIL_MODAL, none: c.MOBIL_NONE, finite: c.MOBIL_FINITE };
export const AXES = { yUp: c.MOBIL_AXES_Y_UP, unity: c.MOBIL_AXES_UNITY, unreal: c.MOBIL_AXES_UNREAL, godot: c.MOBIL_AXES_GODOT, zUp: c.MOBIL_AXES_Z_UP };
export const STATES = { full: c.MOBIL_FULL, compact: c.MOBIL_COMPACT, asleep: c.MOBIL_ASLEEP, posed: c.MOBIL_POSED };
export const FEATURES = { stepEvents: c.MOBIL_STEP_EVENTS, fat: c.MOBIL_FAT, forces: c.MOBIL_FORCES };
export const CONSTITUTIONS = ['thin', 'average', 'athletic', 'heavy'];
const given = { speed_m_s: c.MOBIL_SPEED, step_length_m: c.MOBIL_STEP_LENGTH, step_frequency_hz: c.MOBIL_STEP_FREQUENCY, heading_rad: c.MOBIL_HEADING };
const idBytes = structs.mobil_id.size;

/** People of one world: handles in the library's memory, which the result of spawn owns. A slice is a view. */
export class People {
  #at;
  #owner;
  #rows = 0;
  #room = 0;
  /** `owner`: the people that a slice is a part of. */
  constructor(library, at, count, owner = null) {
    this.library = library;
    this.count = count;
    this.#at = at;
    this.#owner = owner;
  }
  /** Address of the handles. */
  get ids() {
    if (this.#at === 0 || this.#owner?.#at === 0) throw new MobilError('these people were despawned or forgotten; use handles that spawn gave since', c.MOBIL_STALE);
    return this.#at;
  }
  /** Returns the handle of the first person: two numbers. */
  handle() {
    if (this.count < 1) throw new MobilError('one person is wanted, and there is nobody among these', c.MOBIL_REFUSED);
    return this.library.u32.slice(this.ids >> 2, (this.ids >> 2) + 2);
  }
  /** Returns a view of one or several people. It owns nothing, and is invalid after these are despawned or forgotten. */
  slice(begin, end = begin + 1) {
    const last = Math.min(end, this.count);
    if (!Number.isInteger(begin) || !Number.isInteger(last) || begin < 0 || last < begin) {
      throw new MobilError(`there is no slice from ${begin} to ${end} of ${this.count} people`, c.MOBIL_REFUSED);
    }
    return new People(this.library, this.ids + idBytes * begin, last - begin, this.#owner ?? this);
  }
  /** Returns memory for that many floats. A slice uses its owner's, so slices need no forget(). */
  room(floats) {
    const owner = this.#owner ?? this, wanted = Math.max(floats, 1);
    if (this.ids && owner.#room < wanted) {
      this.library.release(owner.#rows);
      owner.#rows = owner.#room = 0;
      owner.#rows = this.library.allocate(4 * wanted);
      owner.#room = wanted;
    }
    return owner.#rows;
  }
  /** Frees the handles' memory. The people are not removed. A slice frees nothing. */
  forget() {
    if (!this.#owner) for (const at of [this.#at, this.#rows]) this.library.release(at);
    this.#at = this.#rows = this.#room = 0;
  }
}

export class World {
  /** `options`: fields of mobil_options, for example tick_s. */
  constructor(library, options = {}) {
    this.library = library;
    library.within((take) => {
      const at = take(structs.mobil_options.size), out = take(4), line = take(256);
      library.fill('mobil_options', 'MOBIL_OPTIONS', at, options);
      const code = library.x.mobil_create(at, out, line, 256);
      if (code !== 0) throw new MobilError(library.text(line), code);
      this.at = library.u32[out >> 2];
    });
    this.tick_s = library.x.mobil_tick_s(this.at);
    const inside = {
      library, call: (...all) => this.#call(...all), struct: (...all) => this.#struct(...all), table: (...all) => this.#table(...all), passed: (...all) => this.#passed(...all),
    };
    this.lod = new Lod(inside);
    this.avoidance = new Avoidance(inside);
    this.terrain = new Terrain(inside);
  }
  destroy() {
    this.library.x.mobil_destroy(this.at);
    this.at = 0;
    this.terrain.drop();
  }

  /** Throws the error of a refused call. */
  must(code) {
    if (code < 0) throw new MobilError(this.library.text(this.library.x.mobil_message(this.at)), code);
    return code;
  }
  #call(name, ...rest) { return this.must(this.library.x[`mobil_${name}`](this.at, ...rest)); }
  #struct(take, name, which, fields) {
    const at = take(structs[name].size);
    this.library.fill(name, which, at, fields);
    return at;
  }
  #muscles(take, fields) { return fields ? this.#struct(take, 'mobil_muscles', 'MOBIL_MUSCLES', fields) : 0; }
  #put(take, numbers) {
    const own = numbers.buffer === this.library.memory.buffer ? numbers.slice() : numbers;  // a view is invalid after memory grows
    const at = take(4 * own.length);
    this.library.f32.set(own, at >> 2);
    return at;
  }
  /** Checks the count of numbers, because the library reads `wanted` of them. */
  #exactly(take, numbers, wanted, what) {
    if (numbers.length !== wanted) throw new MobilError(`${what}: ${wanted} numbers are wanted, and there are ${numbers.length}`, c.MOBIL_REFUSED);
    return this.#put(take, numbers);
  }
  #table(take, rows, width, what) {
    const odd = rows.find((row) => row.length !== width);
    if (odd) throw new MobilError(`${what} are rows of ${width} numbers, and one has ${odd.length}`, c.MOBIL_REFUSED);
    return this.#put(take, rows.flatMap((row) => [...row]));
  }
  /** Sets `given`, the given fields and the style of a mobil_person or mobil_walk at `at`. */
  #walk(take, name, at, request) {
    const { style, ...fields } = request;
    let bits = 0;
    for (const [field, bit] of Object.entries(given)) if (fields[field] !== undefined) bits |= bit;
    if (style) {
      bits |= c.MOBIL_STYLE;
      fields.style = this.#put(take, style);
      fields.style_count = style.length;
    }
    for (const [field, value] of Object.entries(fields)) if (value !== undefined) this.library.set(name, at, field, value);
    this.library.set(name, at, 'given', name === 'mobil_person' ? bits & ~c.MOBIL_HEADING : bits);
  }

  /** Spawns people, all or none. `requests`: fields of mobil_person, for example {height_m: 1.8, mass_kg: 80,
   *  speed_m_s: 1.4, place: [0, 0, 0]}; `style` is an array in the order of `library.style`. `muscles`: fields of
   *  mobil_muscles, or null. */
  spawn(requests, muscles = null) {
    return this.library.within((take) => {
      const { size } = structs.mobil_person, at = take(size * requests.length);
      requests.forEach((request, i) => {
        this.library.fill('mobil_person', 'MOBIL_PERSON', at + size * i);
        this.#walk(take, 'mobil_person', at + size * i, request);
      });
      const which = this.#muscles(take, muscles), ids = this.library.allocate(idBytes * requests.length);
      try {
        this.#call('spawn', at, size, requests.length, which, ids);
      } catch (error) {
        this.library.release(ids);
        throw error;
      }
      return new People(this.library, ids, requests.length);
    });
  }
  /** Removes people, all or none, and frees these handles. After a slice was despawned, its owner still contains the stale
   *  handles: use slices for the remaining people, and forget() the owner last. */
  despawn(people) {
    this.#call('despawn', people.ids, people.count);
    people.forget();
  }
  /** Changes the walks of people to the same one from the next step on; missing fields stay. */
  changeWalk(people, walk) {
    this.library.within((take) => {
      const at = this.#struct(take, 'mobil_walk', 'MOBIL_WALK');
      this.#walk(take, 'mobil_walk', at, walk);
      this.#call('change_walk', people.ids, people.count, at);
    });
  }
  /** Moves a walker at once, without inertia. */
  place(person, place, heading_rad) {
    this.library.within((take) => {
      const at = this.#exactly(take, place, 3, 'place');
      this.#call('place', ...this.#passed(take, person.handle()), at, heading_rad);
    });
  }
  /** Moves the world's origin: subtracts `to`, three numbers, from all positions. */
  shiftOrigin(to) { this.library.within((take) => this.#call('shift_origin', this.#exactly(take, to, 3, 'origin'))); }
  /** Sets posed people's poses for the end of the next tick, in the form of poses(): 48 times position and quaternion, 336
   *  numbers a person. `jumped`: muscles and fat feel no inertia of the motion from the last pose. */
  setPoses(people, poses, jumped = false) {
    this.library.within((take) => this.#call('set_poses', people.ids, people.count, this.#exactly(take, poses, 7 * c.MOBIL_SEGMENTS * people.count, 'poses'), 0, jumped ? 1 : 0));
  }
  /** Returns a walker's requested walk, as changeWalk takes it. */
  walk(person) {
    return this.library.within((take) => {
      const at = this.#struct(take, 'mobil_walk', 'MOBIL_WALK'), number = take(structs.mobil_style_number.size);
      let many = 0;
      while (this.library.x.mobil_style(many, number) === 0) ++many;
      const style = take(4 * many);
      this.#call('get_walk', ...this.#passed(take, person.handle()), at, style, many);
      const { given: said, ...all } = this.library.object('mobil_walk', at), walk = { style: Array.from(this.#floats(style, many)) };
      for (const [field, bit] of Object.entries(given)) if (said & bit) walk[field] = all[field];
      return walk;
    });
  }
  /** Switches a feature of FEATURES from the next tick on. events() returns step events; fat is for peers that display
   *  skin, which this module does not have. */
  enable(people, feature, on = true) { this.#call('enable', people.ids, people.count, numberOf(feature, 'feature'), on ? 1 : 0); }
  /** Changes people to a state of STATES where possible (see mobil.h). Returns how many are in it now. */
  setState(people, state, within_m = 0.005) {
    return this.library.within((take) => {
      const changed = take(4);
      this.#call('set_state', people.ids, people.count, numberOf(state, 'state'), numberOf(within_m, 'within_m', 'float'), changed);
      return this.library.u32[changed >> 2];
    });
  }
  state(person) {
    return this.library.within((take) => {
      const at = take(4);
      this.#call('get_state', ...this.#passed(take, person.handle()), at);
      return this.library.u32[at >> 2];
    });
  }

  // ---- Muscles
  /** Sets muscles, fields of mobil_muscles; null removes them. */
  setMuscles(people, muscles) { this.library.within((take) => this.#call('set_muscles', people.ids, people.count, this.#muscles(take, muscles))); }
  /** Sets the method of one muscle, both sides: fields of mobil_method. */
  setMethod(people, muscle, method) {
    this.library.within((take) => this.#call('set_method', people.ids, people.count, numberOf(muscle, 'muscle'), this.#struct(take, 'mobil_method', 'MOBIL_METHOD', method)));
  }
  /** Sets the excitation of a muscle with MOBIL_BY_HOST, clamped to 0.01 to 1: one number for all, or one a person. */
  setExcitation(people, muscle, side, excitation) {
    const each = typeof excitation === 'number' ? new Float32Array(people.count).fill(excitation) : excitation;
    this.library.within((take) => this.#call('set_excitation', people.ids, people.count, numberOf(muscle, 'muscle'), numberOf(side, 'side'), this.#exactly(take, each, people.count, 'excitations'), 0));
  }
  /** Makes the shared data of these muscles, so that no later call waits for it. */
  prepare(muscles) { this.library.within((take) => this.#call('prepare', this.#muscles(take, muscles))); }
  bake() {
    return this.library.within((take) => {
      const bytes = take(4);
      this.#call('bake', 0, 0, bytes);
      const room = this.library.u32[bytes >> 2], at = take(room);
      this.#call('bake', at, room, bytes);
      return this.library.u8.slice(at, at + room);
    });
  }
  /** `baked`: a Uint8Array from bake() of this version. */
  loadBaked(baked) {
    this.library.within((take) => {
      const at = take(baked.length);
      this.library.u8.set(baked, at);
      this.#call('load_baked', at, baked.length);
    });
  }

  /** Returns a muscle's present method: fields of mobil_method. */
  method(person, muscle) {
    return this.library.within((take) => {
      const at = this.#struct(take, 'mobil_method', 'MOBIL_METHOD');
      this.#call('get_method', ...this.#passed(take, person.handle()), numberOf(muscle, 'muscle'), at);
      return this.library.object('mobil_method', at);
    });
  }
  // Wasm's C convention passes a struct by value as a pointer to a copy.
  #passed(take, id) {
    const at = take(idBytes);
    this.library.u32.set(id, at >> 2);
    return [at];
  }

  // ---- Time
  tick(ticks = 1) {
    this.#call('tick', numberOf(ticks, 'ticks', 'unsigned int'));
    this.terrain.finish();
  }
  /** Adds the time of a frame and runs as many ticks as fit. Returns {count, alpha, dropped_s}. */
  advance(seconds) {
    return this.library.within((take) => {
      const at = take(structs.mobil_ticks.size);
      this.#call('advance', numberOf(seconds, 'seconds', 'double'), at);
      this.terrain.finish();
      return this.library.object('mobil_ticks', at);
    });
  }
  get time_s() { return this.library.x.mobil_time_s(this.at); }

  // ---- Reading
  /** Returns the step events of all ticks of the last tick() or advance(): fields of mobil_event. */
  events() {
    return this.library.within((take) => {
      const count = take(4), { size, fields } = structs.mobil_event;
      this.#call('events', 0, 0, count);
      const many = this.library.u32[count >> 2], at = take(size * many);
      this.#call('events', at, many, count);
      return Array.from({ length: many }, (_, i) => {
        const one = at + size * i, id = (one + fields.id.at) >> 2;
        const event = { person: { index: this.library.u32[id], generation: this.library.u32[id + 1] } };
        for (const field of ['kind', 'side', 'tick', 'part', 'heading_rad', 'place']) event[field] = this.library.get('mobil_event', one, field);
        return event;
      });
    });
  }
  /** Returns the roots of people `ahead_s` after the last tick, without the sway of the hips: a Float64Array of four
   *  numbers a person, position and heading. */
  roots(people, ahead_s = 0) {
    return this.library.within((take) => {
      const at = take(structs.mobil_root.size * people.count);
      this.#call('roots', people.ids, people.count, ahead_s, at);
      return new Float64Array(this.library.memory.buffer.slice(at, at + structs.mobil_root.size * people.count));
    });
  }
  #floats(at, count) { return this.library.f32.subarray(at >> 2, (at >> 2) + count); }
  /** Returns matrices, three rows of four for each of 48 segments: 576 floats a person, usable as a shader's texels.
   *  `ahead_s`: an instant after the last tick. */
  matrices(people, ahead_s = 0) { return this.#poses(people, c.MOBIL_MATRIX, 12, ahead_s); }
  /** Returns poses as position x y z and quaternion x y z w for each segment: 336 floats a person. */
  poses(people, ahead_s = 0) { return this.#poses(people, c.MOBIL_PLACE_AND_QUATERNION, 7, ahead_s); }
  #poses(people, form, each, ahead_s) {
    const floats = each * c.MOBIL_SEGMENTS * people.count, out = people.room(floats);
    this.library.within((take) => {
      const layout = this.#struct(take, 'mobil_pose_layout', 'MOBIL_POSE_LAYOUT', { form, ahead_s });
      this.#call('poses', people.ids, people.count, layout, out, 0);
    });
    return this.#floats(out, floats);
  }
  /** Returns the body of a person, for each of 48 segments {parent, offset, tip, mass_kg, centre, inertia_kg_m2}, in the
   *  frames of poses(). */
  body(person) {
    return this.library.within((take) => {
      const { size } = structs.mobil_segment, at = take(size * c.MOBIL_SEGMENTS);
      this.library.fill('mobil_segment', 'MOBIL_SEGMENT', at);
      this.#call('get_body', ...this.#passed(take, person.handle()), at, 0);
      return Array.from({ length: c.MOBIL_SEGMENTS }, (_, s) => this.library.object('mobil_segment', at + size * s));
    });
  }
  /** Returns rows of MOBIL_JOINTS, MOBIL_FEET and so on. */
  read(what, people) {
    const floats = Math.max(this.library.x.mobil_row_floats(numberOf(what, 'row')), 0) * people.count, out = people.room(floats);
    this.#call('read', what, people.ids, people.count, out, 0);
    return this.#floats(out, floats);
  }
  /** Returns rows of MOBIL_LINE, MOBIL_REPORT and so on, of one muscle and side. */
  readMuscle(what, people, muscle, side = c.MOBIL_RIGHT) {
    const one = this.library.within((take) => this.must(this.library.x.mobil_muscle_row_floats(this.at, numberOf(what, 'row'), ...this.#passed(take, people.handle()), numberOf(muscle, 'muscle'), numberOf(side, 'side'))));
    const floats = one * people.count, out = people.room(floats);
    this.#call('read_muscles', what, people.ids, people.count, muscle, side, out, 0);
    return this.#floats(out, floats);
  }
  /** Returns the cost of each system in the last tick: {name, module, seconds, entities}. */
  cost() {
    return this.library.within((take) => {
      const at = take(structs.mobil_system.size), all = [];
      while (this.library.x.mobil_cost(this.at, all.length, at) === 0) all.push(this.library.object('mobil_system', at));
      return all;
    });
  }
  /** Binds bones and muscles as triangles. `choice`: fields of mobil_surface_choice. */
  surfaces(like, choice = {}) { return new Surfaces(this, like, choice); }
  /** Returns the skin of a person for the graphics card, for people of the same sex and similar build, as typed arrays of
   *  its own: the fields of mobil_skin_binding, and `parts` {name, first_index, indices}. A vertex is at the sum of weight
   *  * matrix * inverse bind * position over its joints, with the matrices of matrices(). The first call for each sex takes
   *  several seconds. */
  skinBinding(person, detail = DETAILS.near) { return skinBinding(this, person, detail); }

  // ---- State
  save() {
    return this.library.within((take) => {
      const room = this.library.x.mobil_snapshot_bytes(this.at), at = take(room), bytes = take(4);
      this.#call('save', at, room, bytes);
      return this.library.u8.slice(at, at + this.library.u32[bytes >> 2]);
    });
  }
  restore(state) {
    this.library.within((take) => {
      const at = take(state.length);
      this.library.u8.set(state, at);
      this.#call('restore', at, state.length);
    });
  }
  /** Returns a 64-bit hash in hexadecimal, equal for equal states on every machine with fused multiply-adds. */
  hash() {
    return this.library.within((take) => {
      const at = take(8);
      this.#call('hash', at);
      return [1, 0].map((i) => this.library.u32[(at >> 2) + i].toString(16).padStart(8, '0')).join('');
    });
  }
}

/** Deprecated names, removed in 0.5, with their replacements. */
const old = {
  setForces: (w, people, on = true) => w.enable(people, FEATURES.forces, on),
  setFatWobble: (w, people, on = true) => w.enable(people, FEATURES.fat, on),
  watch: (w, people, on = true) => w.enable(people, FEATURES.stepEvents, on),
  sleep: (w, people) => w.setState(people, STATES.asleep),
  compact: (w, people) => w.setState(people, STATES.compact),
  wake: (w, people, within_m) => w.setState(people, STATES.full, within_m),
  expand: (w, people) => w.setState(people, STATES.full),
  startChoosing: (w, ...all) => w.lod.setOptions(...all),
  setScene: (w, scene) => w.lod.setScene(scene),
  manage: (w, ...all) => w.lod.manage(...all),
  letGo: (w, people) => w.lod.release(people),
  choose: (w) => w.lod.report,
  why: (w, ...all) => w.lod.why(...all),
  startAvoidance: (w, options) => w.avoidance.setOptions(options),
  avoid: (w, people, on = true) => (on ? w.avoidance.manage(people) : w.avoidance.release(people)),
  want: (w, ...all) => w.avoidance.setDesiredVelocity(...all),
  setWalls: (w, walls) => w.avoidance.setWalls(walls),
  setDiscs: (w, discs) => w.avoidance.setDiscs(discs),
  steer: (w) => w.avoidance.report,
  setOnGround: (w, people, on = true) => (on ? w.terrain.manage(people) : w.terrain.release(people)),
  setSlowing: (w, on) => w.terrain.setSpeedScaling(on),
  updateGround: (w, heights) => w.terrain.setHeights(heights),
};
for (const [name, call] of Object.entries(old)) World.prototype[name] = function deprecated(...all) { return call(this, ...all); };
