// Skins of a crowd, skinned on the graphics card: one instanced mesh for each sex, body and level of detail. The matrices
// of each person are a row of a texture, and so are the colours of the parts.
import * as THREE from 'three';

const vertexShader = `
uniform highp sampler2D poses; uniform sampler2D looks; uniform vec3 centres[48];
in vec4 joints, weights; in float part; in vec2 person; out vec3 colour, up; out float away;
void main() {
  int row = int(person.x + 0.5);
  vec3 at = vec3(0), n = vec3(0);
  for (int i = 0; i < 4; ++i) {
    if (weights[i] == 0.) continue;
    int s = int(joints[i] + 0.5);
    vec4 a = texelFetch(poses, ivec2(3 * s, row), 0), b = texelFetch(poses, ivec2(3 * s + 1, row), 0), c = texelFetch(poses, ivec2(3 * s + 2, row), 0);
    vec4 p = vec4(person.y * (position - centres[s]), 1);
    at += weights[i] * vec3(dot(a, p), dot(b, p), dot(c, p));
    n += weights[i] * vec3(dot(a.xyz, normal), dot(b.xyz, normal), dot(c.xyz, normal));
  }
  vec4 e = viewMatrix * vec4(at, 1);
  colour = texelFetch(looks, ivec2(int(part + 0.5), row), 0).rgb;
  up = n;
  away = -e.z;
  gl_Position = projectionMatrix * e;
}`;
const fragmentShader = `
uniform vec3 fogColour; in vec3 colour, up; in float away; out vec4 o;
void main() {
  vec3 n = normalize(up);
  float light = 0.34 + 0.16 * n.y + 0.6 * max(0., dot(n, normalize(vec3(.3, .8, .5))));
  o = linearToOutputTexel(vec4(mix(light * colour, fogColour, smoothstep(18., 60., away)), 1));
}`;
/** Distances from the camera up to which levels of detail are drawn; fog hides what is farther than the last. */
const reach_m = [9, 22, 60];

/** The file of bake_skins.mjs: `bytes` is a Uint8Array. */
export class Skins {
  constructor(bytes) {
    const size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true), begin = bytes.byteOffset + 4 + size;
    const about = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + size)));
    const array = (Type, at, count) => new Type(bytes.buffer, begin + at, count);
    /** For each sex: attributes of all bodies, levels of detail, and bodies with attributes of their own. */
    this.sexes = about.sexes.map((sex) => ({
      index: new THREE.BufferAttribute(array(Uint16Array, sex.index, sex.levels.reduce((all, level) => all + level.count, 0)), 1),
      levels: sex.levels,
      joints: new THREE.BufferAttribute(array(Uint8Array, sex.joints, 4 * sex.vertices), 4),
      weights: new THREE.BufferAttribute(array(Uint8Array, sex.weights, 4 * sex.vertices), 4, true),
      part: new THREE.BufferAttribute(array(Uint8Array, sex.parts, sex.vertices), 1),
      bodies: sex.bodies.map(({ positions, normals, centres, ...of }) => ({
        ...of,
        position: new THREE.BufferAttribute(Float32Array.from(array(Int16Array, positions, 3 * sex.vertices), (x) => x / about.per_m), 3),
        normal: new THREE.BufferAttribute(array(Int8Array, normals, 3 * sex.vertices), 3, true),
        centres: array(Float32Array, centres, 144),
      })),
    }));
  }
  /** Returns the body of a sex that is nearest to a person in age, up to that of adults, and in body mass index. */
  nearest({ sex = 0, age_y = 25, height_m, mass_kg }) {
    const { bodies } = this.sexes[sex], years = (of) => Math.min(of, 18) / 2;
    const off = bodies.map((body) => Math.abs(years(age_y) - years(body.age_y)) + Math.abs(mass_kg / height_m ** 2 - body.mass_kg / body.height_m ** 2));
    return bodies[off.indexOf(Math.min(...off))];
  }
}

/** People as skins. `asked`: their requests; `poses`: the texture of their matrices, one row each. */
export class SkinnedPeople {
  constructor(skins, asked, poses, fog, parent) {
    const colours = new Uint8Array(4 * 8 * asked.length).fill(255);
    this.looks = new THREE.DataTexture(colours, 8, asked.length, THREE.RGBAFormat, THREE.UnsignedByteType);
    this.looks.colorSpace = THREE.SRGBColorSpace;
    this.group = new THREE.Group();
    this.poses = poses;
    this.count = asked.length;
    const shared = { poses: { value: poses }, looks: { value: this.looks }, fogColour: { value: fog.color } };
    /** Meshes of each person, one for each level of detail, and the scale of their body. */
    const kinds = new Map(), drawn = asked.map((r) => skins.nearest(r));
    asked.forEach((r, i) => { if (!kinds.has(drawn[i])) kinds.set(drawn[i], this.#meshes(skins.sexes[r.sex ?? 0], drawn[i], shared)); });
    this.meshes = drawn.map((body) => kinds.get(body));
    this.scale = asked.map((r, i) => r.height_m / drawn[i].height_m);
    this.kinds = [...kinds.values()];
    parent.add(this.group);
  }
  #meshes(sex, body, shared) {
    const material = new THREE.ShaderMaterial({ glslVersion: THREE.GLSL3, vertexShader, fragmentShader, uniforms: { ...shared, centres: { value: body.centres } } });
    return sex.levels.map(({ first, count }) => {
      const geometry = new THREE.InstancedBufferGeometry();
      geometry.setIndex(sex.index);
      geometry.setDrawRange(first, count);
      for (const name of ['joints', 'weights', 'part']) geometry.setAttribute(name, sex[name]);
      for (const name of ['position', 'normal']) geometry.setAttribute(name, body[name]);
      geometry.setAttribute('person', new THREE.InstancedBufferAttribute(new Float32Array(2 * this.count), 2).setUsage(THREE.DynamicDrawUsage));
      geometry.instanceCount = 0;
      const mesh = new THREE.Mesh(geometry, material);
      mesh.frustumCulled = false;
      this.group.add(mesh);
      return mesh;
    });
  }
  /** Sets the colour of one part, or (part null) of all parts, sRGB from 0 to 255. */
  colour(i, part, rgb) {
    for (let p = part ?? 0; p < (part === null ? 8 : part + 1); ++p) this.looks.image.data.set(rgb, 32 * i + 4 * p);
    this.looks.needsUpdate = true;
  }
  /** Chooses the people that the camera sees, and their levels of detail. */
  choose(camera) {
    const matrices = this.poses.image.data, sphere = new THREE.Sphere(new THREE.Vector3(), 1.2);
    camera.updateMatrixWorld();
    const seen = new THREE.Frustum().setFromProjectionMatrix(new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    for (const meshes of this.kinds) for (const mesh of meshes) mesh.geometry.instanceCount = 0;
    for (let i = 0; i < this.count; ++i) {
      sphere.center.set(matrices[576 * i + 3], matrices[576 * i + 7], matrices[576 * i + 11]);
      if (!seen.intersectsSphere(sphere)) continue;
      const away_m = camera.position.distanceTo(sphere.center), level = reach_m.findIndex((reach) => away_m < reach);
      if (level < 0) continue;
      const { geometry } = this.meshes[i][level];
      geometry.attributes.person.array.set([i, this.scale[i]], 2 * geometry.instanceCount++);
    }
    for (const meshes of this.kinds) {
      for (const mesh of meshes) {
        mesh.visible = mesh.geometry.instanceCount > 0;
        mesh.geometry.attributes.person.needsUpdate = mesh.visible;
      }
    }
  }
  drop() {
    this.group.removeFromParent();
    for (const meshes of this.kinds) for (const mesh of meshes) mesh.geometry.dispose();
    this.looks.dispose();
  }
}
