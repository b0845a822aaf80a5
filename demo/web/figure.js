// The meshes of one person: bones are rigid meshes with a matrix each, muscles are one buffer written by the library.
import * as THREE from 'three';
import { constants as c } from 'mobil';

const rest = new THREE.Color(0x8c1a14), pulling = new THREE.Color(0xff5a36), tendon = new THREE.Color(0xb9a88c);

export class Figure {
  constructor(world, person, parent) {
    this.world = world;
    this.group = new THREE.Group();
    parent.add(this.group);
    this.#addBones(person);
    this.#addMuscles(person);
    this.pose(person);
  }

  #mesh(buffer, indices, part, material) {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(indices.slice(part.first_index, part.first_index + part.indices), 1));
    geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(buffer, 3, 0));
    geometry.setAttribute('normal', new THREE.InterleavedBufferAttribute(buffer, 3, 3));
    const mesh = new THREE.Mesh(geometry, material);
    mesh.name = part.name;
    mesh.frustumCulled = false;
    mesh.castShadow = true;
    this.group.add(mesh);
    return mesh;
  }

  // Surfaces are in world coordinates. Those of a bone are transformed once to its segment, then moved by its matrix.
  #addBones(person) {
    const surfaces = this.world.surfaces(person, { bones: 1, muscles: 0, side: c.MOBIL_BOTH });
    const vertices = surfaces.write(person).slice(), matrices = this.world.matrices(person).slice();
    for (const part of surfaces.parts) {
      const m = matrices.subarray(12 * part.segment);
      for (let v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
        const at = vertices.subarray(6 * v, 6 * v + 6);
        const from = [at[0] - m[3], at[1] - m[7], at[2] - m[11]], normal = at.slice(3);
        for (let i = 0; i < 3; ++i) {
          at[i] = m[i] * from[0] + m[4 + i] * from[1] + m[8 + i] * from[2];
          at[3 + i] = m[i] * normal[0] + m[4 + i] * normal[1] + m[8 + i] * normal[2];
        }
      }
    }
    const buffer = new THREE.InterleavedBuffer(vertices, 6), material = new THREE.MeshStandardMaterial({ color: 0xe6dcc2, roughness: 0.75 });
    this.bones = surfaces.parts.map((part) => {
      const mesh = this.#mesh(buffer, surfaces.indices, part, material);
      mesh.matrixAutoUpdate = false;
      mesh.userData.segment = part.segment;
      return mesh;
    });
    surfaces.drop();
  }
  #addMuscles(person) {
    this.surfaces = this.world.surfaces(person, { bones: 0, muscles: 15, side: c.MOBIL_BOTH });
    this.buffer = new THREE.InterleavedBuffer(new Float32Array(6 * this.surfaces.vertices), 6).setUsage(THREE.DynamicDrawUsage);
    this.muscles = this.surfaces.parts.map((part) => {
      const mesh = this.#mesh(this.buffer, this.surfaces.indices, part, new THREE.MeshStandardMaterial({ color: rest, roughness: 0.5 }));
      mesh.userData = { muscle: part.muscle, side: part.side, tendon: /tendon/.test(part.name) };
      if (mesh.userData.tendon) mesh.material.color.copy(tendon);
      return mesh;
    });
  }

  /** Moves the meshes to the pose of the last tick and returns the place of the pelvis. */
  pose(person) {
    const m = this.world.matrices(person);
    for (const bone of this.bones) {
      const at = 12 * bone.userData.segment;
      bone.matrix.set(...m.subarray(at, at + 12), 0, 0, 0, 1);
      bone.matrixWorldNeedsUpdate = true;
    }
    const place = { x: m[3], y: m[7], z: m[11] };
    this.buffer.array.set(this.surfaces.write(person));
    this.buffer.needsUpdate = true;
    return place;
  }
  /** Colours muscles by `activation(muscle, side)`, 0 to 1. */
  colour(activation) {
    for (const { userData, material } of this.muscles) if (!userData.tendon) material.color.lerpColors(rest, pulling, activation(userData.muscle, userData.side));
  }
  drop() {
    this.group.removeFromParent();
    for (const mesh of [...this.bones, ...this.muscles]) mesh.geometry.dispose();
    this.surfaces.drop();
  }
}
