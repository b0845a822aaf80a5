// A picture of a skin's texture coordinates: checks on the first person of a crowd, from the front and from behind.
//
//   mobil crowd --people 2 --seconds 0.5 --export crowd.glb --export-seconds 0.2
//   node demo/gallery/atlas.mjs MODULES crowd.glb assets/surfaces/atlas.jpg
//
// MODULES: the folder where tests/web/run installs three and playwright-core.
import { copyFile, mkdtemp, rm, symlink, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { ffmpeg, launch } from '../web/chromium.mjs';
import { serve } from '../web/serve.mjs';

const [modules, scene, picture] = process.argv.slice(2).map((name) => path.resolve(name));
if (!picture) throw new Error('usage: node atlas.mjs MODULES CROWD.glb PICTURE.jpg');
const folder = await mkdtemp(path.join(os.tmpdir(), 'atlas-'));
await copyFile(scene, path.join(folder, 'crowd.glb'));
await symlink(path.join(modules, 'three'), path.join(folder, 'three'));
await writeFile(path.join(folder, 'index.html'), `<!doctype html><body style="margin:0">
<script type="importmap">{"imports":{"three":"./three/build/three.module.js","three/addons/":"./three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
const side = 2048, checks = 64, width = 560, height = 900;
const canvas = document.createElement('canvas');
canvas.width = canvas.height = side;
const pen = canvas.getContext('2d');
for (let i = 0; i < checks; ++i) for (let j = 0; j < checks; ++j) {
  pen.fillStyle = (i + j) % 2 ? \`hsl(\${i / checks * 360} 60% \${35 + 40 * j / checks}%)\` : '#eee';
  pen.fillRect(i * side / checks, j * side / checks, side / checks, side / checks);
}
pen.fillStyle = '#000';
pen.font = '24px sans-serif';
for (let i = 0; i < 16; ++i) for (let j = 0; j < 16; ++j) pen.fillText(String.fromCharCode(65 + i) + j, i * side / 16 + 4, j * side / 16 + 26);
const map = new THREE.CanvasTexture(canvas);
Object.assign(map, { flipY: false, colorSpace: THREE.SRGBColorSpace, anisotropy: 8 });
const scene = new THREE.Scene(), light = new THREE.DirectionalLight(0xffffff, 1.5);
light.position.set(2, 3, 4);
scene.background = new THREE.Color(0xe4e7ea);
scene.add(new THREE.HemisphereLight(0xffffff, 0x666666, 2), light);
const { scene: people, animations } = await new GLTFLoader().loadAsync('crowd.glb');
scene.add(people);
let bone;
people.traverse((one) => {
  if (!one.isSkinnedMesh) return;
  if (!bone) bone = one.skeleton.bones[0];
  one.visible = one.skeleton.bones[0] === bone;
  one.frustumCulled = false;
  one.material = new THREE.MeshStandardMaterial({ map, roughness: 0.9 });
});
const mixer = new THREE.AnimationMixer(people);
mixer.clipAction(animations[0]).play();
mixer.update(0.05);
scene.updateMatrixWorld(true);
const at = bone.getWorldPosition(new THREE.Vector3());
const ahead = new THREE.Vector3(0, 0, 1).applyQuaternion(bone.getWorldQuaternion(new THREE.Quaternion())).setY(0).normalize();
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(2 * width, height);
renderer.setScissorTest(true);
document.body.append(renderer.domElement);
[0.4, 3.5].forEach((angle, i) => {
  const camera = new THREE.PerspectiveCamera(34, width / height, 0.1, 50);
  camera.position.copy(at).addScaledVector(ahead.clone().applyAxisAngle(new THREE.Vector3(0, 1, 0), angle), 3.3).setY(at.y + 0.3);
  camera.lookAt(at.x, at.y - 0.02, at.z);
  renderer.setViewport(i * width, 0, width, height);
  renderer.setScissor(i * width, 0, width, height);
  renderer.render(scene, camera);
});
document.title = 'drawn';
</script>`);
const { port, close } = await serve(folder);
const browser = await launch(modules);
try {
  const page = await browser.newPage({ viewport: { width: 1120, height: 900 } });
  page.on('pageerror', (error) => console.error(String(error)));
  await page.goto(`http://127.0.0.1:${port}/`);
  await page.waitForFunction(() => document.title === 'drawn', null, { timeout: 60000 });
  await page.screenshot({ path: path.join(folder, 'atlas.png') });
  ffmpeg('-i', path.join(folder, 'atlas.png'), '-q:v', '4', picture);
} finally {
  await browser.close();
  close();
  await rm(folder, { recursive: true });
}
