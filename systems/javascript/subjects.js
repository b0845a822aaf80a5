// What happens within ticks: level of detail, avoidance and terrain of a world, each with verbs of its own.
import { constants as c } from './interface.js';
import { MobilError } from './library.js';

/** `inside`: what a world lends its subjects. */
class Subject {
  constructor(inside) { this.inside = inside; }
  /** What happened in all ticks of the last advance() or tick(). */
  counts(name) {
    const { library, call, struct } = this.inside;
    return library.within((take) => {
      const at = struct(take, `mobil_${name}_counts`, `MOBIL_${name.toUpperCase()}_COUNTS`);
      call(`${name}_report`, at);
      return library.object(`mobil_${name}_counts`, at);
    });
  }
}

/** How finely whose muscles are computed: each tick gives managed people the cheapest methods that the scene allows. */
export class Lod extends Subject {
  /** Fields of mobil_lod_options; `muscles` as of spawn. */
  setOptions(options = {}, muscles = null) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('lod_set_options', struct(take, 'mobil_lod_options', 'MOBIL_LOD_OPTIONS', options), muscles ? struct(take, 'mobil_muscles', 'MOBIL_MUSCLES', muscles) : 0));
  }
  /** Fields of mobil_scene. */
  setScene(scene) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('lod_set_scene', struct(take, 'mobil_scene', 'MOBIL_SCENE', scene)));
  }
  /** Makes what the scene may call for, so that no tick waits later. */
  prepare() { this.inside.call('lod_prepare'); }
  /** Fields of mobil_needs, where these people need other than the scene says. */
  manage(people, needs = {}) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('lod_manage', people.ids, people.count, struct(take, 'mobil_needs', 'MOBIL_NEEDS', needs)));
  }
  release(people) { this.inside.call('lod_release', people.ids, people.count); }
  /** Fields of mobil_lod_counts. */
  get report() { return this.counts('lod'); }
  /** Why a muscle has its method, its predicted error and its cost. */
  why(person, muscle) {
    const { library, call, passed } = this.inside;
    return library.within((take) => {
      const line = take(256), error = take(4), cost = take(8);
      call('lod_why', ...passed(take, person.handle()), muscle, line, 256, error, cost);
      return { why: library.text(line), error_m: library.f32[error >> 2], cost_us: library.data.getFloat64(cost, true) };
    });
  }
}

/** Who keep out of each other's way, of walls and of discs. */
export class Avoidance extends Subject {
  /** Fields of mobil_avoidance_options, of people managed from now on. */
  setOptions(options = {}) {
    const { library, call, struct } = this.inside;
    library.within((take) => call('avoidance_set_options', struct(take, 'mobil_avoidance_options', 'MOBIL_AVOIDANCE_OPTIONS', options)));
  }
  manage(people) { this.inside.call('avoidance_manage', people.ids, people.count, 1); }
  release(people) { this.inside.call('avoidance_manage', people.ids, people.count, 0); }
  /** Where they want to go: an array of [speed in m/s, heading in rad], one a person. */
  setDesiredVelocity(people, wishes) {
    const { library, call, table } = this.inside;
    if (wishes.length !== people.count) throw new MobilError(`${wishes.length} wishes for ${people.count} people; give one each`, c.MOBIL_REFUSED);
    library.within((take) => call('avoidance_set_desired_velocity', people.ids, people.count, table(take, wishes, 2, 'wishes'), 0));
  }
  /** Instead of those before: arrays of six numbers, two places. */
  setWalls(walls) {
    const { library, call, table } = this.inside;
    library.within((take) => call('avoidance_set_walls', table(take, walls, 6, 'walls'), 0, walls.length));
  }
  /** Instead of those before: arrays of seven numbers, place, velocity, radius. */
  setDiscs(discs) {
    const { library, call, table } = this.inside;
    library.within((take) => call('avoidance_set_discs', table(take, discs, 7, 'discs'), 0, discs.length));
  }
  /** Fields of mobil_avoidance_counts. */
  get report() { return this.counts('avoidance'); }
}

/** Ground that is not level. */
export class Terrain extends Subject {
  #slot = 0;
  #raised = null;
  /** Every tick asks `heights(places, count)` from now on, or nothing (null): it is given three numbers a place, and
   *  returns four: the height, and the normal (0 0 0: level). What it throws comes out of advance() or tick() once their
   *  ticks are over; feet stand until then as high as before. It must not use the world. */
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
    } catch (error) {  // the library can neither throw nor be thrown through
      this.#raised ??= error;
      library.f32.fill(NaN, ground >> 2, (ground >> 2) + 4 * count);
    }
    return 0;
  }
  /** Throws what `heights` threw. */
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
  /** People slow down on slopes and stairs, or no more. */
  setSlowing(on = true) { this.inside.call('terrain_set_speed_scaling', on ? 1 : 0); }
  /** Fields of mobil_terrain_counts. */
  get report() { return this.counts('terrain'); }
}
