// Level of detail, avoidance and terrain of a world, which run within ticks.
import { constants as c } from './interface.js';
import { MobilError } from './library.js';

/** Base class. `inside` contains the internal functions of a world. */
class Subject {
  constructor(inside) { this.inside = inside; }
  /** Returns the counts of all ticks of the last advance() or tick(). */
  counts(name) {
    const { library, call, struct } = this.inside;
    return library.within((take) => {
      const at = struct(take, `mobil_${name}_counts`, `MOBIL_${name.toUpperCase()}_COUNTS`);
      call(`${name}_report`, at);
      return library.object(`mobil_${name}_counts`, at);
    });
  }
}

/** Level of detail: each tick gives managed people the cheapest methods that the scene allows. */
export class Lod extends Subject {
  /** Sets the fields of mobil_lod_options; `muscles` as in spawn. */
  setOptions(options = {}, muscles = null) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('lod_set_options', struct(take, 'mobil_lod_options', 'MOBIL_LOD_OPTIONS', options), muscles ? struct(take, 'mobil_muscles', 'MOBIL_MUSCLES', muscles) : 0));
  }
  /** Sets the fields of mobil_scene. */
  setScene(scene) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('lod_set_scene', struct(take, 'mobil_scene', 'MOBIL_SCENE', scene)));
  }
  /** Makes the shared data that the scene can require, so that no tick waits for it. */
  prepare() { this.inside.call('lod_prepare'); }
  /** Manages people. `needs`: fields of mobil_needs that override those of the scene. */
  manage(people, needs = {}) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('lod_manage', people.ids, people.count, struct(take, 'mobil_needs', 'MOBIL_NEEDS', needs)));
  }
  release(people) { this.inside.call('lod_release', people.ids, people.count); }
  /** Counts: fields of mobil_lod_counts. */
  get report() { return this.counts('lod'); }
  /** Returns the reason for a muscle's method, its predicted error and its cost. */
  why(person, muscle) {
    const { library, call, passed } = this.inside;
    return library.within((take) => {
      const line = take(256), error = take(4), cost = take(8);
      call('lod_why', ...passed(take, person.handle()), muscle, line, 256, error, cost);
      return { why: library.text(line), error_m: library.f32[error >> 2], cost_us: library.data.getFloat64(cost, true) };
    });
  }
}

/** Collision avoidance between walkers, and with walls and discs. */
export class Avoidance extends Subject {
  /** Sets the fields of mobil_avoidance_options, for people managed from now on. */
  setOptions(options = {}) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('avoidance_set_options', struct(take, 'mobil_avoidance_options', 'MOBIL_AVOIDANCE_OPTIONS', options)));
  }
  manage(people) { this.inside.call('avoidance_manage', people.ids, people.count, 1); }
  release(people) { this.inside.call('avoidance_manage', people.ids, people.count, 0); }
  /** Sets desired velocities: an array of [speed in m/s, heading in rad], one for each person. */
  setDesiredVelocity(people, wishes) {
    const { library, call, table } = this.inside;
    if (wishes.length !== people.count) throw new MobilError(`${wishes.length} wishes for ${people.count} people; give one each`, c.MOBIL_REFUSED);
    library.within((take) => call('avoidance_set_desired_velocity', people.ids, people.count, table(take, wishes, 2, 'wishes'), 0));
  }
  /** Replaces all walls: arrays of six numbers, two positions. `heights`, for floors above each other: arrays of two
   * numbers, bottom and top of each. Walkers whose ground is at or above the top, or more than 2 m below the bottom, do
   * not see it. */
  setWalls(walls, heights = null) { this.#set('walls', walls, 6, heights); }
  /** Replaces all discs: arrays of seven numbers, position, velocity and radius. `heights` as for walls. */
  setDiscs(discs, heights = null) { this.#set('discs', discs, 7, heights); }
  #set(what, rows, width, heights) {
    const { library, call, table } = this.inside;
    if (heights !== null && heights.length !== rows.length)
      throw new MobilError(`${heights.length} heights for ${rows.length} ${what}; give one each`, c.MOBIL_REFUSED);
    library.within((take) => call(`avoidance_set_${what}_between`, table(take, rows, width, what), 0,
      heights === null ? 0 : table(take, heights, 2, 'heights'), 0, rows.length));
  }
  /** Counts: fields of mobil_avoidance_counts. */
  get report() { return this.counts('avoidance'); }
}

/** Uneven ground. */
export class Terrain extends Subject {
  #slot = 0;
  #raised = null;
  /** Sets the function heights(places, count) that ticks call from now on, or none (null). It gets three numbers for each
   *  position and returns four: height and normal (level if zero). Its exceptions are thrown by advance() or tick() after
   *  their ticks; feet keep their heights until then. It must not use the world. */
  setHeights(heights) {
    const { library, call } = this.inside, old = this.#slot;
    this.#slot = heights ? library.host((_, places, who, count, ground) => this.#answer(heights, places, count, ground)) : 0;
    call('terrain_set_heights', this.#slot, 0);
    library.dropHost(old);
  }
  #answer(heights, places, count, ground) {
    const { library } = this.inside;
    try {
      const answers = heights(library.f32.slice(places >> 2, (places >> 2) + 3 * count), count);
      if (answers.length !== 4 * count) throw new MobilError(`${answers.length} numbers for ${count} places; give four each`, c.MOBIL_REFUSED);
      library.f32.set(answers, ground >> 2);
    } catch (error) {  // an exception must not cross the library
      this.#raised ??= error;
      library.f32.fill(NaN, ground >> 2, (ground >> 2) + 4 * count);
    }
    return 0;
  }
  /** Throws the exception of the function of heights, if any. */
  finish() {
    const raised = this.#raised;
    this.#raised = null;
    if (raised) throw raised;
  }
  drop() {
    this.inside.library.dropHost(this.#slot);
    this.#slot = 0;
  }
  manage(people) { this.inside.call('terrain_manage', people.ids, people.count, 1); }
  release(people) { this.inside.call('terrain_manage', people.ids, people.count, 0); }
  /** Switches speed scaling on slopes and stairs. */
  setSpeedScaling(on = true) { this.inside.call('terrain_set_speed_scaling', on ? 1 : 0); }
  /** Counts: fields of mobil_terrain_counts. */
  get report() { return this.counts('terrain'); }
}
