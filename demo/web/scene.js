// The scene as plain values, and as an address, which omits default values.
export const usual = {
  height: 1.8, mass: 80, build: 2, speed: 5, step: 0, style: {},
  methods: ['modal', 'modal', 'modal', 'modal'], modes: 12, pull: 0, inertia: 0, forces: 1,
  ground: 0, slow: 1, crowd: 60, clear: 0, choose: 0, tolerance: 1, budget: 0, heat: 0,
};
export const methodNames = ['explicit_central', 'implicit_central', 'newmark', 'static', 'modal', 'finite', 'none'];

/** Reads `?height=1.7&methods=explicit_central,modal,newmark,none&style.arm_swing=1.2`; ignores unknown entries. */
export function fromAddress(query) {
  const scene = structuredClone(usual);
  for (const [name, text] of new URLSearchParams(query)) {
    if (name.startsWith('style.')) {
      if (Number.isFinite(Number(text))) scene.style[name.slice(6)] = Number(text);
    } else if (name === 'methods') {
      const methods = text.split(',');
      if (methods.length === 4 && methods.every((m) => methodNames.includes(m))) scene.methods = methods;
    } else if (typeof usual[name] === 'number' && text !== '' && Number.isFinite(Number(text))) {
      scene[name] = Number(text);
    }
  }
  return scene;
}

export function toAddress(scene) {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(scene)) {
    if (name === 'style') for (const [number, of] of Object.entries(value)) query.set(`style.${number}`, of);
    else if (String(value) !== String(usual[name])) query.set(name, value);
  }
  return query.toString();
}

/** Returns the fields of mobil_person, or of mobil_walk if `bodyToo` is false. `numbers`: mobil.style. */
export function request(scene, numbers, bodyToo = true) {
  const body = bodyToo ? { height_m: scene.height, mass_kg: scene.mass, constitution: scene.build } : {};
  return {
    ...body,
    speed_m_s: scene.speed / 3.6,
    step_length_m: scene.step > 0 && scene.speed > 0 ? scene.step : undefined,
    style: numbers.map((n) => scene.style[n.name] ?? n.usual),
  };
}
