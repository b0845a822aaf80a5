// The page: one person set by the user, a crowd, and the library that simulates both.
import { FEATURES, METHODS, MobilError, STATES, canRun, constants as c, load } from 'mobil';
import { attempt, choice, slider, toggle } from './controls.js';
import { Crowd } from './crowd.js';
import { Figure } from './figure.js';
import { download, strideAsGlb } from './files.js';
import { Ground, groundNames } from './ground.js';
import { drawTrace, drawWays } from './plots.js';
import { fromAddress, methodNames, request, toAddress, usual } from './scene.js';
import { Skins } from './skins.js';
import { Stage } from './stage.js';
import { Trace, groups } from './trace.js';

const query = new URLSearchParams(location.search), still = query.has('still');
const element = (id) => document.getElementById(id);

class Page {
  constructor(mobil, baked, skins) {
    this.mobil = mobil;
    this.skins = new Skins(skins);
    this.scene = fromAddress(location.search);
    if (!groundNames[this.scene.ground]) this.scene.ground = usual.ground;
    this.world = mobil.world();
    if (baked) this.#takeBaked(baked);
    this.stage = new Stage(element('view'), { still });
    this.trace = new Trace();
    this.told = { tick: 0, draw: 0 };
    this.play(still);
    if (!attempt(() => this.respawn())) {  // a link with an impossible scene
      const why = element('refusal').textContent;
      this.scene = structuredClone(usual);
      this.respawn();
      element('refusal').textContent = `${why}; default values are shown instead`;
    }
    this.#controls();  // for the scene that is shown
    this.grounded();
    this.crowded();
    this.chosen();
  }
  // Bases of another version are rejected and computed here instead.
  #takeBaked(baked) {
    try { this.world.loadBaked(baked); } catch (error) { console.warn(error.message); }
  }

  // ---- One person
  #muscles() {
    const { scene } = this, modal = scene.methods.includes('modal');
    return {
      method: METHODS[scene.methods[0]], modes: modal ? scene.modes : undefined, control_points: 1, reported: 1,
      activation: [c.MOBIL_NO_ACTIVATION, c.MOBIL_BY_PHASE, c.MOBIL_BY_MOMENTS][scene.pull], inertia: scene.inertia,
    };
  }
  #setMethods(person) {
    this.scene.methods.forEach((m, i) => {
      if (i > 0 && m !== this.scene.methods[0]) this.setMethod(i, person);
    });
  }
  setMethod(i, person = this.person) {
    const method = METHODS[this.scene.methods[i]];
    this.world.setMethod(person, i, { method, modes: this.scene.modes, control_points: 1, reported: 1 });
  }
  /** Replaces the person by one with the scene's body. On errors nothing changes. */
  respawn() {
    const { world, scene } = this;
    const at = this.#place();
    const muscles = Object.fromEntries(Object.entries(this.#muscles()).filter(([, v]) => v !== undefined));
    // With avoidance the person starts standing, to have time to react to others.
    const body = request(scene, this.mobil.style), begins = scene.clear ? { ...body, speed_m_s: 0, step_length_m: undefined } : body;
    // Muscles that follow moments need forces first.
    const person = world.spawn([{ ...begins, place: [scene.clear ? at.x : 0, 0, at.z] }], { ...muscles, activation: c.MOBIL_NO_ACTIVATION });
    try {
      if (scene.forces || scene.pull === 2) world.enable(person, FEATURES.forces);
      if (scene.pull) world.setMuscles(person, muscles);
      this.#setMethods(person);
      const figure = new Figure(world, person, this.stage.scene);
      if (this.person) {
        this.figure.drop();
        world.despawn(this.person);
      }
      this.figure = figure;
    } catch (error) {
      world.despawn(person);
      throw error;
    }
    this.person = person;
    if (scene.clear) this.#keepClear();
    if (this.ground) world.terrain.manage(person);
    this.trace.clear();
    this.#curves();
    if (this.choosing) this.world.lod.manage(this.person);
  }
  /** Returns the place of the person's pelvis. */
  #place() {
    const m = this.figure ? this.world.matrices(this.person) : [];
    return { x: m[3] ?? 0, z: m[11] ?? 0 };
  }
  walk() {
    this.world.changeWalk(this.person, request(this.scene, this.mobil.style, false));
    if (this.scene.clear) {  // managed again, because avoidance keeps the initial step length
      this.world.avoidance.release(this.person);
      this.#keepClear();
    }
    this.#curves();
  }
  #curves() {
    const { scene } = this;
    this.ways = groups.map((_, i) => this.mobil.levels(i, { speed_m_s: scene.speed / 3.6, height_m: scene.height, inertia: !!scene.inertia, pulling: scene.pull > 0 }));
  }
  /** Returns the name of each group's current method. */
  #chosenWays() {
    return groups.map((_, i) => {
      const has = this.world.method(this.person, i);
      return this.ways[i].find((way) => way.method === has.method && (has.method !== METHODS.modal || (way.modes === has.modes && !!way.moving === !!has.moving)))?.name ?? '';
    });
  }

  // ---- The crowd
  crowded() {
    const { world, scene } = this;
    const made = scene.crowd > 0 ? new Crowd(world, (...of) => this.mobil.typicalPerson(...of), scene.crowd, this.skins, this.stage.scene, scene.clear, this.#place()) : undefined;
    this.crowd?.drop();
    this.crowd = made;
    if (this.ground && this.crowd) world.terrain.manage(this.crowd.people);
    if (this.choosing && this.crowd) world.lod.manage(this.crowd.people);
  }
  /** Applies a change of *keep clear*: all people avoid each other, or all walk as requested. */
  cleared() {
    this.respawn();
    this.crowded();
  }
  #keepClear() {
    this.world.avoidance.manage(this.person);
    this.world.avoidance.setDesiredVelocity(this.person, [[this.scene.speed / 3.6, 0]]);
  }
  grounded() {
    const { world, scene } = this, everybody = [this.person, this.crowd?.people].filter(Boolean);
    if (this.ground) {
      this.ground.drop();
      for (const people of everybody) world.terrain.release(people);
    }
    this.ground = scene.ground ? new Ground(groundNames[scene.ground], this.stage) : undefined;
    world.terrain.setSpeedScaling(!!scene.slow);
    world.terrain.setHeights(this.ground?.heights ?? null);
    if (this.ground) for (const people of everybody) world.terrain.manage(people);
  }

  /** Applies a change of *choose*: methods chosen for the camera, or those of the controls. */
  chosen() {
    const { world, scene } = this, everybody = [this.person, this.crowd?.people].filter(Boolean);
    if (this.choosing) {
      for (const people of everybody) world.lod.release(people);
      if (this.crowd) {
        world.setState(this.crowd.people, STATES.full);
        world.setMuscles(this.crowd.people, null);
        this.crowd.clothes();
      }
      this.choosing = false;
      this.respawn();
    }
    if (!scene.choose) return;
    const { activation, inertia } = this.#muscles();
    world.lod.setOptions({}, { activation, inertia });
    this.choosing = true;
    this.#lookAt();
    for (const people of everybody) world.lod.manage(people);
  }
  #lookAt() {
    const { scene } = this;
    this.world.lod.setScene({ tolerance_px: scene.tolerance, ...this.stage.viewpoint(), budget_s: scene.budget / 1000, compact_unseen: 1 });
  }

  // ---- Time
  step(ticks) { for (let i = 0; i < ticks; ++i) this.#ran(() => { this.world.tick(); return 1; }); }
  advance(seconds) { this.#ran(() => this.world.advance(seconds).count); }
  /** Times and samples ticks. `ticks()` runs them and returns their number. */
  #ran(ticks) {
    const began = performance.now(), count = ticks();
    if (!count) return;
    if (this.choosing) this.did = this.world.lod.report;
    this.trace.sample(this.world, this.person);
    this.told.tick = soft(this.told.tick, (performance.now() - began) / count);
  }
  draw() {
    const began = performance.now();
    const { x, y, z } = this.figure.pose(this.person);
    this.ground?.follow(x, z);
    // The camera rises with the hips, not with each stair.
    this.stage.follow(x, this.ground ? y - 0.53 * this.scene.height : 0, z);
    if (this.choosing) this.#lookAt();
    if (this.crowd) {
      this.crowd.pose(x, z, this.stage.camera);
      if (this.choosing && this.scene.heat) this.crowd.heat();
    }
    if (this.scene.pull) {
      const pulls = groups.map((_, g) => [0, 1].map((side) => { try { return this.world.readMuscle(c.MOBIL_ACTIVATION, this.person, g, side)[1]; } catch { return 0; } }));
      this.figure.colour((muscle, side) => pulls[muscle]?.[side] ?? 0);
    }
    this.stage.draw();
    this.told.draw = soft(this.told.draw, performance.now() - began);
  }
  /** Updates plots and figures, less often than pictures. */
  tell() {
    groups.forEach((_, i) => {
      const select = element(`method${i}`), { method } = this.world.method(this.person, i);
      select.disabled = !!this.choosing;
      if (this.choosing) select.value = methodNames.find((name) => METHODS[name] === method);
      else select.value = this.scene.methods[i];
    });
    drawTrace(this.trace, this.scene.mass * 9.81);
    drawWays(this.ways, this.#chosenWays());
    const did = this.choosing && this.did ? `, muscles predicted ${(1000 * this.did.predicted_s).toFixed(2)} ms per tick, ${this.did.compacted} far people compact` : '';
    element('told').textContent = `tick ${this.told.tick.toFixed(2)} ms, picture ${this.told.draw.toFixed(1)} ms, ${(1 + (this.crowd?.people.count ?? 0)).toLocaleString('en')} people, ${(this.mobil.library.memory.buffer.byteLength / 2 ** 20).toFixed(0)} MB${did}${this.mobil.fused ? '' : '; this browser does not fuse multiply-adds, so results differ from desktops in the last bits'}`;
  }
  run() {
    let last, told = 0;
    const frame = (now) => {
      requestAnimationFrame(frame);  // first, so that nothing thrown below stops the page
      const passed_s = (now - (last ?? now)) / 1000;  // a first frame's time can be before this call
      last = now;
      try {
        if (!this.paused) this.advance(Math.min(passed_s * +element('pace').value, 0.1));
        this.draw();
        if (now - told > 90) {
          this.tell();
          told = now;
        }
      } catch (error) {
        this.#failed(error);
      }
    };
    requestAnimationFrame(frame);
  }
  // The next frame usually fails the same way, so each message is shown once.
  #failures = new Set();
  #failed(error) {
    if (this.#failures.has(error.message)) return;
    this.#failures.add(error.message);
    element('refusal').textContent = error.message;
    console.error(error);
  }

  // ---- Controls
  #controls() {
    const { scene } = this, anew = () => this.respawn(), walk = () => this.walk();
    slider('body', { id: 'height', name: 'height', holder: scene, key: 'height', low: 1.2, high: 2.2, step: 0.01, unit: ' m', act: anew });
    slider('body', { id: 'mass', name: 'mass', holder: scene, key: 'mass', low: 30, high: 200, step: 1, unit: ' kg', act: anew });
    choice('body', { id: 'build', name: 'build', holder: scene, key: 'build', options: ['thin', 'average', 'athletic', 'heavy'], numbers: true, act: anew });
    slider('walk', { id: 'speed', name: 'speed', holder: scene, key: 'speed', low: 0, high: 8, step: 0.1, unit: ' km/h', act: walk });
    slider('walk', { id: 'step-length', name: 'step length', title: '0: usual for the leg length', holder: scene, key: 'step', low: 0, high: 1.1, step: 0.01, unit: ' m', act: walk });
    for (const n of this.mobil.style) {
      const unit = n.unit === '1' ? '' : ` ${n.unit}`, step = 10 ** Math.floor(Math.log10((n.high - n.low) / 50)), name = n.name.replace(/_(deg|h|m|cycle|n_per_m)$/, '').replaceAll('_', ' ');
      slider('style', { id: n.name, name, title: n.meaning, holder: scene.style, key: n.name, low: n.low, high: n.high, step, unit, usual: n.usual, act: walk });
    }
    choice('walk', { id: 'ground', name: 'ground', title: 'ground of all people', holder: scene, key: 'ground', options: groundNames, numbers: true, act: () => this.grounded() });
    toggle('walk', { id: 'slow', name: 'slow down', title: 'on slopes and stairs', holder: scene, key: 'slow', act: () => this.world.terrain.setSpeedScaling(!!scene.slow) });
    groups.forEach((name, i) => choice('muscles', { id: `method${i}`, name, title: 'method of deformation', holder: scene.methods, key: i, options: methodNames, act: () => (this.choosing ? undefined : this.setMethod(i)) }));
    slider('muscles', { id: 'modes', name: 'modes', title: 'of modal muscles', holder: scene, key: 'modes', low: 1, high: 32, step: 1, act: () => { if (!this.choosing) scene.methods.forEach((m, i) => m === 'modal' && this.setMethod(i)); } });
    choice('muscles', { id: 'pull', name: 'pull', title: 'source of excitation; active muscles turn red', holder: scene, key: 'pull', options: ['none', 'by gait phase', 'by joint moments'], numbers: true, act: anew });
    toggle('muscles', { id: 'inertia', name: 'inertia', title: 'apply gravity and the motion of bones to muscles', holder: scene, key: 'inertia', act: anew });
    toggle('muscles', { id: 'forces', name: 'forces', title: 'ground reaction and joint moments', holder: scene, key: 'forces', act: () => this.world.enable(this.person, FEATURES.forces, !!scene.forces || scene.pull === 2) });
    slider('crowd', { id: 'people', name: 'people', holder: scene, key: 'crowd', low: 0, high: 5000, step: 20, act: () => this.crowded() });
    toggle('crowd', { id: 'clear', name: 'keep clear', title: 'people walk in four directions and avoid each other', holder: scene, key: 'clear', act: () => this.cleared() });
    toggle('crowd', { id: 'choose', name: 'choose', title: 'gives each muscle the cheapest method that is accurate enough for this camera', holder: scene, key: 'choose', act: () => this.chosen() });
    slider('crowd', { id: 'tolerance', name: 'error', title: 'maximum error of a muscle in pixels, if methods are chosen', holder: scene, key: 'tolerance', low: 0.25, high: 8, step: 0.25, unit: ' px', act: () => {} });
    slider('crowd', { id: 'budget', name: 'budget', title: 'time for muscles per tick; 0: unlimited', holder: scene, key: 'budget', low: 0, high: 10, step: 0.1, unit: ' ms', act: () => {} });
    toggle('crowd', { id: 'heat', name: 'show cost', title: 'if methods are chosen: grey none, blue cheap, red expensive', holder: scene, key: 'heat', act: () => { if (!scene.heat) this.crowd?.clothes(); } });
    element('panel').addEventListener('submit', (event) => event.preventDefault());
    element('play').onclick = () => this.play(!this.paused);
    element('step').onclick = () => this.oneStep();
    element('link').onclick = () => this.copyLink();
    element('csv').onclick = () => download('walk.csv', [this.trace.csv()], 'text/csv');
    element('glb').onclick = async () => download('walk.glb', [await this.glb()], 'model/gltf-binary');
    element('hide').onclick = () => {
      const away = document.body.classList.toggle('away');
      element('hide').textContent = away ? 'Show' : 'Hide';
      element('hide').setAttribute('aria-expanded', String(!away));
    };
    addEventListener('keydown', (event) => {
      if (/^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName)) return;
      if (event.key === ' ') this.play(!this.paused);
      else if (event.key === '.') this.oneStep();
      else return;
      event.preventDefault();
    });
  }
  play(paused) {
    this.paused = paused;
    element('play').textContent = paused ? 'Play' : 'Pause';
  }
  oneStep() {
    this.play(true);
    this.step(1);
  }
  address() { return `${location.origin}${location.pathname}?${toAddress(this.scene)}`; }
  async copyLink() {
    history.replaceState(null, '', this.address());
    try {
      await navigator.clipboard.writeText(this.address());
      element('link').textContent = 'Copied';
      setTimeout(() => { element('link').textContent = 'Copy link'; }, 1500);
    } catch { /* the address bar has it */ }
  }
  /** Returns one stride as glTF. */
  glb() { return strideAsGlb(this.world, this.person, this.figure, this.#stride(), (ticks) => this.world.tick(ticks)); }
  // Returns the duration of the right leg's cycle, until its phase has its current value again.
  #stride() {
    const before = this.world.save(), phase = () => this.world.read(c.MOBIL_FEET, this.person)[18];
    let turned = 0, last = phase(), ticks = 0;
    while (turned < 1 && ticks < 300) {
      this.world.tick();
      ++ticks;
      const now = phase();
      turned += (now - last + 1) % 1;
      last = now;
    }
    this.world.restore(before);
    return ticks < 300 ? ticks * this.world.tick_s : 1;
  }
}

const soft = (old, now) => (old ? 0.95 * old + 0.05 * now : now);

async function bytes(address) {
  const answer = await fetch(address);
  return answer.ok ? new Uint8Array(await answer.arrayBuffer()) : null;
}

async function start() {
  const webgl2 = !!document.createElement('canvas').getContext('webgl2');
  if (!canRun() || !webgl2 || query.has('poster')) {
    element('poster').hidden = false;
    document.querySelector('main').hidden = true;
    element('poster').querySelector('p').textContent = `This page needs ${canRun() ? 'WebGL 2' : 'WebAssembly with SIMD'}, which this browser does not have. This picture shows it in another browser.`;
    document.title = 'mobil: poster';
    return;
  }
  const [mobil, baked, skins] = await Promise.all([load(), bytes('bases.bin'), bytes('skins.bin')]);
  performance.mark('library');
  const page = new Page(mobil, baked, skins);
  performance.mark('people');
  globalThis.mobilPage = page;
  page.constants = { METHODS };
  page.step(still ? Math.round(60 * Number(query.get('t') ?? 2)) : 1);
  page.draw();
  page.tell();
  if (!still) page.run();
  document.body.dataset.ready = Math.round(performance.now());
}

start().catch((error) => {
  element('refusal').textContent = error.message;
  if (!(error instanceof MobilError)) throw error;
});
