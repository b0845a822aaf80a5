// A walker as a skinned mesh of three.js, in the first <canvas> of the page.
import * as THREE from 'three';
import { DETAILS, load } from 'mobil';

const colours = { skin: 0xd09a74, legs: 0xd09a74, lips: 0xb06a5c, hair: 0x33241a, shirt: 0x2c6478, shorts: 0x2b3242, shoes: 0x1c1c1e };
const mobil = await load(), world = mobil.world();
const person = world.spawn([{ height_m: 1.75, mass_kg: 70, speed_m_s: 1.3 }]), skin = world.skinBinding(person, DETAILS.far);
const matrix = (all, segment) => new THREE.Matrix4().set(...all.subarray(12 * segment, 12 * segment + 12), 0, 0, 0, 1);

const geometry = new THREE.BufferGeometry();
for (const [name, array, size] of [['position', skin.positions, 3], ['normal', skin.normals, 3], ['skinIndex', skin.joints, 4], ['skinWeight', skin.weights, 4]]) geometry.setAttribute(name, new THREE.BufferAttribute(array, size));
geometry.setIndex(new THREE.BufferAttribute(skin.indices, 1));
skin.parts.forEach((part, i) => geometry.addGroup(part.first_index, part.indices, i));
const body = new THREE.SkinnedMesh(geometry, skin.parts.map(({ name }) => new THREE.MeshStandardMaterial({ color: colours[name] })));
const bones = mobil.segments.map((name) => Object.assign(new THREE.Bone(), { name, matrixAutoUpdate: false }));
body.add(...bones);  // none is the child of another: poses are in the world
body.bind(new THREE.Skeleton(bones, bones.map((_, s) => matrix(skin.inverse_binds, s))), new THREE.Matrix4());
body.frustumCulled = false;

const renderer = new THREE.WebGLRenderer({ canvas: document.querySelector('canvas') }), scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(35, renderer.domElement.width / renderer.domElement.height, 0.1, 100);
scene.add(body, new THREE.HemisphereLight(0xffffff, 0x888888, 3));
let last_ms;
renderer.setAnimationLoop((now_ms) => {
  const { alpha } = world.advance((now_ms - (last_ms ?? now_ms)) / 1000), poses = world.matrices(person, alpha * world.tick_s);
  last_ms = now_ms;
  bones.forEach((bone, s) => { bone.matrix.copy(matrix(poses, s)); bone.matrixWorldNeedsUpdate = true; });
  camera.position.set(poses[3] + 3, 1.5, poses[11] + 3);
  camera.lookAt(poses[3], 0.9, poses[11]);
  renderer.render(scene, camera);
});
