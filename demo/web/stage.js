// Ground, light and camera, which follows the person.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

const colours = {
  light: { sky: 0xe9ebee, ground: 0xcfd2d6, line: 0xb4b9c0 },
  dark: { sky: 0x14171b, ground: 0x23282e, line: 0x39414a },
};

export class Stage {
  constructor(canvas, { still = false } = {}) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: still });
    this.renderer.setPixelRatio(still ? 1 : Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.scene = new THREE.Scene();
    this.scene.fog = new THREE.Fog(0, 18, 60);
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.05, 120);
    this.camera.position.set(2.0, 1.25, 3.7);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.set(0, 0.85, 0);
    this.level_m = 0;
    this.controls.maxPolarAngle = 1.62;
    this.controls.minDistance = 0.4;
    this.controls.maxDistance = 40;
    this.controls.listenToKeyEvents(canvas);
    this.light = new THREE.DirectionalLight(0xffffff, 2.2);
    this.light.castShadow = true;
    this.light.shadow.mapSize.set(2048, 2048);
    this.light.shadow.normalBias = 0.004;
    Object.assign(this.light.shadow.camera, { left: -1.6, right: 1.6, top: 2.2, bottom: -1.6, far: 12 });
    this.ground = new THREE.Mesh(new THREE.PlaneGeometry(300, 300), new THREE.MeshLambertMaterial());
    this.ground.rotation.x = -Math.PI / 2;
    this.ground.receiveShadow = true;
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9a9488, 1.6), this.light, this.light.target, this.ground);
    const dark = matchMedia('(prefers-color-scheme: dark)');
    dark.addEventListener('change', () => this.#paint(dark.matches));
    this.#paint(dark.matches);
    addEventListener('resize', () => this.#resize());
    this.#resize();
  }

  /** Replaces the level plane by `ground`, or (null) restores the plane. */
  stand(ground) {
    if (this.uneven) this.scene.remove(this.uneven);
    this.uneven = ground;
    if (ground) {
      ground.material.color.copy(this.ground.material.color);
      this.scene.add(ground);
    }
    this.ground.visible = this.grid.visible = !ground;
  }
  /** Moves the camera with (x, y, z), a place on the ground. */
  follow(x, y, z) {
    const { target } = this.controls, moved = new THREE.Vector3(x - target.x, y - this.level_m, z - target.z);
    this.camera.position.add(moved);
    target.add(moved);
    this.level_m = y;
    this.light.position.set(x + 2, y + 5, z + 3);
    this.light.target.position.set(x, y + 0.5, z);
    this.ground.position.set(x, 0, z);
    this.grid.position.set(Math.round(x), 0.002, Math.round(z));
  }
  draw() {
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
  }
  /** Returns the camera's fields of mobil_scene. */
  viewpoint() {
    const gaze = this.camera.getWorldDirection(new THREE.Vector3()), high = Math.tan((this.camera.fov * Math.PI) / 360);
    return {
      has_camera: 1, eye: this.camera.position.toArray(), gaze: gaze.toArray(),
      half_angle_rad: Math.atan(high * Math.hypot(1, this.camera.aspect)),
      radians_per_pixel: (2 * Math.atan(high)) / this.renderer.domElement.height, near_m: 3, reach_m: 60,
    };
  }

  #paint(dark) {
    const { sky, ground, line } = colours[dark ? 'dark' : 'light'];
    this.scene.background = new THREE.Color(sky);
    this.scene.fog.color.set(sky);
    this.ground.material.color.set(ground);
    if (this.grid) {
      this.scene.remove(this.grid);
      this.grid.dispose();
    }
    this.grid = new THREE.GridHelper(120, 120, line, line);
    this.grid.position.set(Math.round(this.controls.target.x), 0.002, Math.round(this.controls.target.z));
    this.scene.add(this.grid);
    this.grid.visible = !this.uneven;
    this.uneven?.material.color.set(ground);
  }
  #resize() {
    this.renderer.setSize(innerWidth, innerHeight, false);
    this.camera.aspect = innerWidth / innerHeight;
    this.camera.updateProjectionMatrix();
  }
}
