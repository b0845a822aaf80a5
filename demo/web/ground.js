// The uneven ground of the page: heights for the library's queries, and the mesh.
import * as THREE from 'three';

const reach_m = 60;

/** Corners of a profile along z, [z, height] in m, repeated after `period_m`; vertical between two with the same z. */
const kerbs = { period_m: 8, corners: [[0, 0], [4, 0], [4, 0.12], [8, 0.12], [8, 0]] };
const stairs = (() => {
  const steps = 6, rise_m = 0.16, tread_m = 0.3, up_m = 4, down_m = 10, period_m = 16, corners = [[0, 0]];
  for (let i = 0; i < steps; ++i) corners.push([up_m + tread_m * i, rise_m * i], [up_m + tread_m * i, rise_m * (i + 1)]);
  for (let i = 0; i < steps; ++i) corners.push([down_m + tread_m * i, rise_m * (steps - i)], [down_m + tread_m * i, rise_m * (steps - i - 1)]);
  return { period_m, corners: [...corners, [period_m, 0]] };
})();

/** Returns a function for the height at z: that of the last corner before it, because all treads are level. */
function tread({ period_m, corners }) {
  return (x, z) => {
    const at = z - period_m * Math.floor(z / period_m);
    let height = 0;
    for (const [from, rises] of corners) {
      if (from > at) break;
      height = rises;
    }
    return [height, 0, 0];
  };
}

const along = (2 * Math.PI) / 30, aside = (2 * Math.PI) / 40;
const hills = (x, z) => {
  const slant = aside * x + along * z;
  return [0.3 * Math.sin(along * z) + 0.25 * Math.sin(slant), 0.25 * aside * Math.cos(slant), along * (0.3 * Math.cos(along * z) + 0.25 * Math.cos(slant))];
};

/** Grounds by name. `at(x, z)` returns height and slopes along x and z, which repeat after `period_x`, `period_z`. */
const grounds = {
  hills: { at: hills, period_x: 40, period_z: 30 },
  kerbs: { at: tread(kerbs), period_x: 1, period_z: kerbs.period_m, profile: kerbs },
  stairs: { at: tread(stairs), period_x: 1, period_z: stairs.period_m, profile: stairs },
};
export const groundNames = ['level', ...Object.keys(grounds)];

// Returns a texture of squares of one metre, which is multiplied by the ground's colour.
function squares() {
  const canvas = Object.assign(document.createElement('canvas'), { width: 128, height: 128 }), x = canvas.getContext('2d');
  x.fillStyle = '#fff';
  x.fillRect(0, 0, 128, 128);
  x.strokeStyle = '#bbb';
  x.lineWidth = 4;
  x.strokeRect(0, 0, 128, 128);
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 8;
  return texture;
}

function geometry({ at, profile, period_x, period_z }) {
  // The mesh is up to half a period off the person.
  const past = (period_m) => Math.ceil(reach_m / period_m + 0.5) * period_m, past_x = past(period_x), past_z = past(period_z);
  const rows = [];  // [z, height, or null for the height of the ground]
  if (profile) for (let z = -past_z; z < past_z; z += period_z) rows.push(...profile.corners.map(([from, height]) => [z + from, height]));
  else for (let z = -past_z; z <= past_z; ++z) rows.push([z, null]);
  const apart = profile ? 2 * past_x : 1, position = [], uv = [], index = [], columns = (2 * past_x) / apart + 1;
  for (const [z, height] of rows) {
    for (let x = -past_x; x <= past_x; x += apart) {
      position.push(x, height ?? at(x, z)[0], z);
      uv.push(x, z + (height ?? 0));
    }
  }
  for (let i = 0; i + 1 < rows.length; ++i) {
    for (let k = 0; k + 1 < columns; ++k) {
      const a = columns * i + k, b = a + 1, c = a + columns, d = c + 1;
      index.push(a, c, b, b, c, d);
    }
  }
  const made = new THREE.BufferGeometry();
  made.setIndex(index);
  made.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
  made.setAttribute('uv', new THREE.Float32BufferAttribute(uv, 2));
  return profile ? made.toNonIndexed() : made;
}

export class Ground {
  constructor(name, stage) {
    Object.assign(this, grounds[name]);
    const made = geometry(this);
    made.computeVertexNormals();
    this.mesh = new THREE.Mesh(made, new THREE.MeshLambertMaterial({ map: squares() }));
    this.mesh.receiveShadow = true;
    this.stage = stage;
    stage.stand(this.mesh);
  }
  /** Callback for Terrain.setHeights. */
  heights = (places, count) => {
    const answers = new Float32Array(4 * count);
    for (let i = 0; i < count; ++i) {
      const [height, x, z] = this.at(places[3 * i], places[3 * i + 2]);
      answers.set([height, -x, 1, -z], 4 * i);
    }
    return answers;
  };
  /** Moves the mesh with the person, by whole periods. */
  follow(x, z) {
    this.mesh.position.set(this.period_x * Math.round(x / this.period_x), 0, this.period_z * Math.round(z / this.period_z));
  }
  drop() {
    this.stage.stand(null);
    this.mesh.geometry.dispose();
    this.mesh.material.map.dispose();
    this.mesh.material.dispose();
  }
}
