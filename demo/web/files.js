// Files to download: a table of the last minute, and a stride as glTF.
import * as THREE from 'three';
import { GLTFExporter } from 'three/examples/jsm/exporters/GLTFExporter.js';

export function download(name, parts, type) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob(parts, { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Returns a mesh's part of a shared buffer of places and normals as a separate mesh. `shapes`: morph target buffers.
function alone(of, first_buffer, shapes = []) {
  const index = of.geometry.index.array, first = index.reduce((a, b) => Math.min(a, b)), last = index.reduce((a, b) => Math.max(a, b));
  const pick = (all, offset, minus) => {
    const out = new Float32Array(3 * (last - first + 1));
    for (let v = first; v <= last; ++v) {
      for (let i = 0; i < 3; ++i) out[3 * (v - first) + i] = all[6 * v + offset + i] - (minus ? minus[6 * v + offset + i] : 0);
    }
    return new THREE.BufferAttribute(out, 3);
  };
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(index.map((v) => v - first), 1));
  geometry.setAttribute('position', pick(first_buffer, 0));
  geometry.setAttribute('normal', pick(first_buffer, 3));
  if (shapes.length) {
    geometry.morphAttributes.position = shapes.map((shape) => pick(shape, 0, first_buffer));
    geometry.morphTargetsRelative = true;
  }
  const mesh = new THREE.Mesh(geometry, of.material);
  mesh.name = of.name;
  return mesh;
}

/** Returns the next stride as GLB bytes, on the spot (with height changes on stairs or hills): bones as moving nodes,
 *  muscles as blended morph targets. `step` runs a number of ticks. The world is restored afterwards. */
export async function strideAsGlb(world, person, figure, stride_s, step, shapes = 20) {
  const before = world.save(), ticks = Math.max(1, Math.round(stride_s / world.tick_s / shapes));
  const times = [], flesh = [], matrices = [];
  for (let k = 0; k <= shapes; ++k) {
    const m = world.matrices(person).slice(), from = [m[3], 0, m[11]];
    times.push(k * ticks * world.tick_s);
    flesh.push(figure.surfaces.write(person, from).slice());
    for (let s = 0; s < 48; ++s) for (let i = 0; i < 3; ++i) m[12 * s + 4 * i + 3] -= from[i];
    matrices.push(m);
    if (k < shapes) step(ticks);
  }
  world.restore(before);

  const root = new THREE.Group(), tracks = [];
  root.name = 'mobil';
  for (const bone of figure.bones) {
    const mesh = alone(bone, bone.geometry.attributes.position.data.array), places = [], turns = [];
    const place = new THREE.Vector3(), turn = new THREE.Quaternion(), scale = new THREE.Vector3();
    for (const m of matrices) {
      const at = 12 * bone.userData.segment;
      new THREE.Matrix4().set(...m.subarray(at, at + 12), 0, 0, 0, 1).decompose(place, turn, scale);
      places.push(...place.toArray());
      turns.push(...turn.toArray());
    }
    mesh.position.fromArray(places);
    mesh.quaternion.fromArray(turns);
    root.add(mesh);
    tracks.push(new THREE.VectorKeyframeTrack(`${mesh.uuid}.position`, times, places), new THREE.QuaternionKeyframeTrack(`${mesh.uuid}.quaternion`, times, turns));
  }
  const weights = times.flatMap((_, k) => flesh.slice(1).map((__, s) => (s + 1 === k ? 1 : 0)));
  for (const muscle of figure.muscles) {
    const mesh = alone(muscle, flesh[0], flesh.slice(1));
    mesh.updateMorphTargets();
    root.add(mesh);
    tracks.push(new THREE.NumberKeyframeTrack(`${mesh.uuid}.morphTargetInfluences`, times, weights));
  }
  const clip = new THREE.AnimationClip('walk', times.at(-1), tracks);
  return new Uint8Array(await new GLTFExporter().parseAsync(root, { binary: true, animations: [clip] }));
}
