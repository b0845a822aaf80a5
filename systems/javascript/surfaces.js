// Bones and muscles of one body as triangles, bound once and written for people of similar build.
import { constants as c, structs } from './interface.js';
import { MobilError } from './library.js';

export class Surfaces {
  constructor(world, like, choice) {
    const { library } = world;
    this.world = world;
    library.within((take) => {
      const at = take(structs.mobil_surface_choice.size), out = take(4), id = take(8);
      library.fill('mobil_surface_choice', 'MOBIL_SURFACE_CHOICE', at, choice);
      library.u32.set(like.handle(), id >> 2);
      world.must(library.x.mobil_bind_surfaces(world.at, id, at, out));
      this.at = library.u32[out >> 2];
      this.vertices = library.x.mobil_vertex_count(this.at);
      const indices = library.x.mobil_index_count(this.at), index = take(4 * indices);
      world.must(library.x.mobil_indices(this.at, index, indices));
      /** Three per triangle. */
      this.indices = library.u32.slice(index >> 2, (index >> 2) + indices);
      const tissue = take(4 * this.vertices);
      world.must(library.x.mobil_surface_tissue(this.at, tissue, 4 * this.vertices));
      /** Four bytes a vertex: along and around the surface, tendon, aponeurosis, 0 to 255 for 0 to 1. */
      this.tissue = library.u8.slice(tissue, tissue + 4 * this.vertices);
      /** {name, segment, muscle, side, first_vertex, vertices, first_index, indices}; `muscle` is negative for bones. */
      this.parts = [];
      const part = take(structs.mobil_part.size);
      while (library.x.mobil_surface_part(this.at, this.parts.length, part) === 0) this.parts.push(library.object('mobil_part', part));
    });
    this.buffer = library.allocate(24 * this.vertices);
  }
  /** Returns position and normal of each vertex, six floats, as a view valid until the next call. `origin` is subtracted
   *  first. `ahead_s`: an instant after the last tick. */
  write(person, origin = [0, 0, 0], ahead_s = 0) {
    if (!this.at) throw new MobilError('these surfaces were dropped; make others by World.surfaces', c.MOBIL_REFUSED);
    const { library } = this.world, bytes = 24 * this.vertices;
    library.within((take) => {
      const at = take(structs.mobil_surface_target.size);
      library.fill('mobil_surface_target', 'MOBIL_SURFACE_TARGET', at, {
        surfaces: this.at, positions: this.buffer, normals: this.buffer + 12, position_stride: 24, normal_stride: 24,
        position_bytes: bytes, normal_bytes: bytes - 12, origin, ahead_s,
      });
      library.u32.set(person.handle(), (at + structs.mobil_surface_target.fields.id.at) >> 2);
      this.world.must(library.x.mobil_write_surfaces(this.world.at, at, 0, 1));
    });
    return library.f32.subarray(this.buffer >> 2, (this.buffer >> 2) + 6 * this.vertices);
  }
  drop() {
    this.world.library.x.mobil_drop_surfaces(this.at);
    this.world.library.release(this.buffer);
    this.at = this.buffer = 0;
  }
}
