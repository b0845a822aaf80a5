// Uses each class of the package; tests/web/npm_test.mjs compiles it with tsc --strict.
import { AXES, CONSTITUTIONS, DETAILS, FEATURES, METHODS, MobilError, SKIN_PARTS, STATES, canFuse, canRun, constants, load } from 'mobil';
import type { Heights, Mobil, People, PersonRequest, SkinBinding, Surfaces, World, mobil_muscles } from 'mobil';

export async function example(): Promise<string> {
  const mobil: Mobil = await load(new URL('file:///mobil'), canRun() && canFuse());
  const style = mobil.style.map((n) => n.usual), first: string | undefined = mobil.segments[0], muscle: number = constants.MOBIL_QUADRICEPS;
  const world: World = mobil.world({ axes: AXES.unity, tick_s: 1 / 60 });
  const one: PersonRequest = { height_m: 1.8, mass_kg: 80, sex: constants.MOBIL_MAN, constitution: CONSTITUTIONS.indexOf('average'), style, place: [0, 0, 0] };
  const muscles: mobil_muscles = { method: METHODS.modal, modes: 8, control_points: true, modal_cells: new Uint32Array([2, 2, 8]) };
  const people: People = world.spawn([one, { ...one, place: new Float32Array(3) }], muscles);
  world.enable(people, FEATURES.stepEvents);
  world.changeWalk(people.slice(0), { speed_m_s: 1, heading_rad: 1 });
  world.setMethod(people, muscle, world.method(people, muscle));
  world.lod.setScene({ tolerance_m: 0.002, eye: [0, 1, 2] });
  world.lod.manage(people);
  world.avoidance.manage(people);
  world.avoidance.setDesiredVelocity(people, [[1, 0], new Float32Array(2)]);
  world.avoidance.setWalls([[0, 0, 0, 1, 0, 0]], [[0, 2]]);
  const level: Heights = (places, count) => new Float32Array(4 * count).fill(places.length * 0);
  world.terrain.setHeights(level);
  const { count, alpha } = world.advance(1 / 30), poses: Float32Array = world.poses(people, alpha * world.tick_s);
  const chosen: number = world.lod.report.looked_at + world.avoidance.report.people + world.terrain.report.places;
  const surfaces: Surfaces = world.surfaces(people, { bones: true, side: constants.MOBIL_BOTH });
  const vertices: Float32Array = surfaces.write(people, [0, 0, 0], 0.01), names: string[] = surfaces.parts.map((part) => part.name);
  const skin: SkinBinding = world.skinBinding(people, DETAILS.distant), shirt = skin.parts[SKIN_PARTS.indexOf('shirt')]?.indices ?? 0;
  const masses = world.body(people).map((segment) => segment.mass_kg + (segment.offset[1] ?? 0));
  const events = world.events().filter(({ kind, person }) => kind === constants.MOBIL_HEEL_STRIKE && person.index > 0);
  world.setState(people, STATES.asleep);
  world.restore(world.save());
  try {
    world.tick();
  } catch (error) {
    if (error instanceof MobilError && error.code === constants.MOBIL_STALE) return error.message;
  }
  surfaces.drop();
  world.despawn(people);
  const costs = world.cost().map((system) => `${system.name} ${system.seconds}`);
  // @ts-expect-error: no field of mobil_person
  const wrong: PersonRequest = { hight_m: 1.8 };
  return [first, count, chosen, poses.length, vertices.length, names, shirt, masses, events.length, costs, wrong, world.hash()].join(' ');
}
