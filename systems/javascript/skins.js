// Skins for the graphics card: the rest shape of a body with clothes and hair, and four segments and weights a vertex.
import { constants as c, structs } from './interface.js';
import { numberOf } from './library.js';

/** Levels of detail, with about 90000, 20000, 5000 and 1200 triangles. */
export const DETAILS = { hero: c.MOBIL_HERO, near: c.MOBIL_NEAR, far: c.MOBIL_FAR, distant: c.MOBIL_DISTANT };
/** Names of the parts, in the order of triangles; `legs` are below the shorts. */
export const SKIN_PARTS = ['skin', 'legs', 'lips', 'hair', 'shirt', 'shorts', 'shoes'];

const vertexArrays = { positions: [Float32Array, 3], normals: [Float32Array, 3], tangents: [Float32Array, 4], texture: [Float32Array, 2], joints: [Uint8Array, 4], weights: [Float32Array, 4], same_as: [Uint32Array, 1] };

/** Returns arrays of their own for World.skinBinding. */
export function skinBinding(world, person, detail) {
  const { library } = world, { x } = library, id = person.handle();
  return library.within((take) => {
    const who = take(8), request = take(structs.mobil_person.size);
    library.u32.set(id, who >> 2);
    library.fill('mobil_person', 'MOBIL_PERSON', request);
    world.must(x.mobil_get_person(world.at, who, request));
    const sex = library.get('mobil_person', request, 'sex'), level = numberOf(detail, 'detail', 'int', [c.MOBIL_HERO, c.MOBIL_DISTANT]);
    const vertices = x.mobil_binding_vertex_count(sex, level), indices = x.mobil_skin_index_count(sex, level);
    const arrays = { ...Object.fromEntries(Object.entries(vertexArrays).map(([name, [Type, width]]) => [name, [Type, width * vertices]])), indices: [Uint32Array, indices], inverse_binds: [Float32Array, 12 * c.MOBIL_SEGMENTS] };
    const at = Object.fromEntries(Object.entries(arrays).map(([name, [Type, count]]) => [name, take(Type.BYTES_PER_ELEMENT * count)]));
    const binding = take(structs.mobil_skin_binding.size), first = take(4 * (c.MOBIL_SKIN_PARTS + 1));
    library.fill('mobil_skin_binding', 'MOBIL_SKIN_BINDING', binding, { detail: level, sex, vertices, index_room: indices, ...at });
    world.must(x.mobil_skin_indices(world.at, sex, level, at.indices, indices, first));
    world.must(x.mobil_get_skin_binding(world.at, who, binding));  // its vertices are others, so are its indices
    const begins = library.u32.slice(first >> 2, (first >> 2) + c.MOBIL_SKIN_PARTS + 1);
    return {
      sex, vertices,
      parts: SKIN_PARTS.map((name, i) => ({ name, first_index: 3 * begins[i], indices: 3 * (begins[i + 1] - begins[i]) })),
      ...Object.fromEntries(Object.entries(arrays).map(([name, [Type, count]]) => [name, new Type(library.memory.buffer.slice(at[name], at[name] + Type.BYTES_PER_ELEMENT * count))])),
    };
  });
}
