// A walker as a skinned mesh of Babylon.js, in the first <canvas> of the page.
import { Bone, Color3, Engine, FreeCamera, HemisphericLight, Material, Matrix, Mesh, MultiMaterial, Quaternion, Scene, Skeleton, Space, StandardMaterial, SubMesh, Vector3, VertexData } from '@babylonjs/core';
import { DETAILS, load } from 'mobil';

const colours = { skin: '#d09a74', legs: '#d09a74', lips: '#b06a5c', hair: '#33241a', shirt: '#a8556b', shorts: '#3d4a5f', shoes: '#1c1c1e' };
const mobil = await load(), world = mobil.world();
const person = world.spawn([{ height_m: 1.75, mass_kg: 70, speed_m_s: 1.3 }]), skin = world.skinBinding(person, DETAILS.far);

const engine = new Engine(document.querySelector('canvas'), true), scene = new Scene(engine);
scene.useRightHandedSystem = true;  // as mobil
const body = new Mesh('body', scene), skeleton = new Skeleton('skeleton', 'skeleton', scene);
Object.assign(new VertexData(), { positions: skin.positions, normals: skin.normals, indices: skin.indices, matricesIndices: Float32Array.from(skin.joints), matricesWeights: skin.weights }).applyToMesh(body);
const joint = (s) => [3, 7, 11].map((i) => -skin.inverse_binds[12 * s + i]);
const bones = mobil.segments.map((name, s) => new Bone(name, skeleton, null, Matrix.Translation(...joint(s))));  // poses are in the world
body.skeleton = skeleton;
body.alwaysSelectAsActiveMesh = true;
body.material = new MultiMaterial('clothes', scene);
body.material.subMaterials = skin.parts.map(({ name }) => Object.assign(new StandardMaterial(name, scene), { diffuseColor: Color3.FromHexString(colours[name]), specularColor: Color3.Black(), sideOrientation: Material.CounterClockWiseSideOrientation }));
body.subMeshes = [];
skin.parts.forEach((part, i) => new SubMesh(i, 0, skin.vertices, part.first_index, part.indices, body));

const camera = new FreeCamera('camera', new Vector3(), scene);
new HemisphericLight('light', new Vector3(0, 1, 0.5), scene);
engine.runRenderLoop(() => {
  const { alpha } = world.advance(engine.getDeltaTime() / 1000), poses = world.poses(person, alpha * world.tick_s);
  bones.forEach((bone, s) => {
    bone.setPosition(Vector3.FromArray(poses, 7 * s), Space.LOCAL);
    bone.setRotationQuaternion(Quaternion.FromArray(poses, 7 * s + 3), Space.LOCAL);
  });
  camera.position.set(poses[0] + 3, 1.5, poses[2] + 3);
  camera.setTarget(new Vector3(poses[0], 0.9, poses[2]));
  scene.render();
});
