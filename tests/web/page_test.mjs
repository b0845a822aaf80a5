// The page in a real Chromium: it starts, walks, has working controls, refuses impossible values, has a desktop's bits.
// Usage: node page_test.mjs NODE_MODULES PAGE SCREENSHOTS. Exit status 1: a test failed.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch } from '../../demo/web/chromium.mjs';
import { serve } from '../../demo/web/serve.mjs';

const [, , modules, folder, shots] = process.argv;
const here = path.dirname(fileURLToPath(import.meta.url));
const { port, close } = await serve(folder);
const browser = await launch(modules);
const said = [];
let passed = 0, failed = 0;

const usual = { viewport: { width: 1100, height: 680 }, acceptDownloads: true };
/** Opens the page; `from` is a context whose cache it uses. */
async function open(query, options = {}, from = null) {
  const page = from ? await from.newPage() : await browser.newPage({ ...usual, ...options });
  page.on('console', (m) => { if (m.type() === 'error') said.push(m.text()); });
  page.on('pageerror', (e) => said.push(String(e)));
  await page.goto(`http://127.0.0.1:${port}/?${query}`);
  await page.waitForFunction(() => document.body.dataset.ready || document.title.includes('poster'), null, { timeout: 120000 });
  return page;
}
async function test(name, body) {
  const began = Date.now();
  try {
    await body();
    ++passed;
    console.log(`ok      ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
const set = (page, id, value) => page.evaluate(([i, v]) => {
  const e = document.getElementById(i);
  if (e.type === 'checkbox') e.checked = v;
  else e.value = v;
  e.dispatchEvent(new Event(e.type === 'range' ? 'input' : 'change'));
  return document.getElementById('refusal').textContent;
}, [id, value]);
const look = (page, ticks = 0) => page.evaluate((n) => { mobilPage.step(n); mobilPage.draw(); mobilPage.tell(); }, ticks);
const hash = (page) => page.evaluate(() => mobilPage.world.hash());
// Coarse appearance of the page: mean colours of 40 by 25 tiles.
const tiles = (page) => page.evaluate(() => {
  const small = Object.assign(document.createElement('canvas'), { width: 40, height: 25 }), x = small.getContext('2d');
  x.imageSmoothingQuality = 'high';
  x.drawImage(document.getElementById('view'), 0, 0, 40, 25);
  return [...x.getImageData(0, 0, 40, 25).data].filter((_, i) => i % 4 < 3);
});
/** Returns the fraction of tiles that differ by more than a twelfth in some colour. */
const differ = (a, b) => {
  let n = 0;
  for (let i = 0; i < a.length; i += 3) n += [0, 1, 2].some((k) => Math.abs(a[i + k] - b[i + k]) > 20);
  return n / (a.length / 3);
};
mkdirSync(shots, { recursive: true });

const page = await open('still&t=2.2&crowd=60');
await test('it starts and shows a person who walks', async () => {
  const seen = await tiles(page);
  await page.screenshot({ path: `${shots}/page.png` });
  const file = path.join(here, 'page_tiles.json');
  if (process.env.MOBIL_TILES) writeFileSync(file, JSON.stringify(seen));
  assert.ok(differ(seen, JSON.parse(readFileSync(file))) < 0.02, 'not the picture of page_tiles.json');
  await page.evaluate(() => { mobilPage.figure.group.visible = false; mobilPage.draw(); });
  assert.ok(differ(seen, await tiles(page)) > 0.02, 'nobody was to be seen');
  await page.evaluate(() => { mobilPage.figure.group.visible = true; });
});
await test('a crowd has children, who walk beside a parent', async () => {
  const [share, apart_m] = await page.evaluate(() => {
    const { asked } = mobilPage.crowd, children = asked.filter((r) => r.age_y < 18), parents = asked.filter((r) => r.age_y >= 18);
    const apart = children.map((a) => Math.min(...parents.map((b) => Math.hypot(a.place[0] - b.place[0], a.place[2] - b.place[2]))));
    return [children.length / asked.length, Math.max(...apart)];
  });
  assert.ok(share > 0.1 && share < 0.3 && apart_m < 0.8, `${share} of the people are children, up to ${apart_m} m from a parent`);
});
await test('its bits are those of desktops', async () => {
  const committed = Object.fromEntries(readFileSync(path.join(here, '../portable/hashes.txt'), 'utf8').trim().split('\n').map((l) => l.match(/^(.*\S)\s+(\S+)$/).slice(1)));
  const ours = await page.evaluate(() => {
    const f = Math.fround, { METHODS } = mobilPage.constants;
    const scene = (muscles, ticks) => {
      const world = mobilPage.mobil.world(), asked = [];
      for (let i = 0; i < 20; ++i) {
        asked.push({ height_m: f(f(1.55) + f(f(0.02) * i)), mass_kg: 60 + i, speed_m_s: f(f(0.8) + f(f(0.05) * i)), place: [i, 0, 0], heading_rad: f(f(0.2) * (i % 5)) });
      }
      const people = world.spawn(asked, muscles);
      world.tick(ticks);
      world.changeWalk(people.slice(0, 10), { speed_m_s: 1.3, heading_rad: 1 });
      world.tick(ticks);
      const of = world.hash();
      world.destroy();
      return of;
    };
    const off = { control_points: 0, activation: 0, inertia: 0 };
    return {
      fused: mobilPage.mobil.fused, bones: scene(null, 120), static: scene({ ...off, method: METHODS.static, control_points: 1 }, 20),
      reduced: scene({ ...off, method: METHODS.modal, control_points: 1 }, 20), 'reduced, inertia': scene({ ...off, method: METHODS.modal, control_points: 1, inertia: 1 }, 20),
    };
  });
  if (!ours.fused) return console.log('        not compared: this browser does not fuse multiply-adds');
  for (const [name, of] of Object.entries(ours)) if (name !== 'fused') assert.equal(of, committed[name], name);
});
await test('sliders change body, walk and style', async () => {
  const before = await hash(page);
  for (const [id, value] of [['mass', 95], ['height', 1.9], ['build', 3], ['speed', 3.4], ['step-length', 0.6], ['arm_forward_deg', 50]]) {
    assert.equal(await set(page, id, value), '', `${id} ${value}`);
  }
  await look(page, 30);
  assert.notEqual(await hash(page), before);
});
await test('what nobody can be is refused in one line, and the slider goes back', async () => {
  assert.equal(await set(page, 'mass', 50), '');
  const before = await hash(page), refused = await set(page, 'height', 2.2);
  assert.match(refused, /nobody of 2\.2 m weighs 50 kg.*choose a mass of/);
  assert.equal(await page.inputValue('#height'), '1.9');
  assert.equal(await hash(page), before);
  assert.equal(await set(page, 'mass', 80), '');
});
await test('each method simulates each group', async () => {
  for (const method of ['explicit_central', 'implicit_central', 'newmark', 'static', 'finite', 'none', 'modal']) {
    for (let i = 0; i < 4; ++i) assert.equal(await set(page, `method${i}`, method), '', method);
    await look(page, 5);
    assert.equal(await page.evaluate(() => mobilPage.world.method(mobilPage.person, 2).method), await page.evaluate((m) => mobilPage.constants.METHODS[m], method));
  }
  assert.equal(await set(page, 'modes', 8), '');
});
await test('muscles pull, feel inertia, and redden', async () => {
  for (const pull of [1, 2]) {
    assert.equal(await set(page, 'pull', pull), '');
    await look(page, 40);
    assert.ok(await page.evaluate(() => Math.max(...mobilPage.trace.rows.map((r) => r.at(-1)))) > 0.05);
  }
  assert.equal(await set(page, 'inertia', true), '');
  await look(page, 20);
  await page.screenshot({ path: `${shots}/pulling.png` });
  assert.equal(await set(page, 'inertia', false) + await set(page, 'pull', 0), '');
});
await test('methods are chosen for the camera, and cost is shown', async () => {
  assert.equal(await set(page, 'people', 300), '');
  assert.equal(await set(page, 'choose', true), '');
  await look(page, 40);
  const plain = await tiles(page);
  assert.equal(await set(page, 'heat', true), '');
  await look(page, 10);
  await look(page, 1);
  await page.screenshot({ path: `${shots}/heat.png` });
  assert.ok(differ(plain, await tiles(page)) > 0.01);
  assert.ok(await page.evaluate(() => mobilPage.did.compacted + mobilPage.did.looked_at) > 0);
  const near = await page.evaluate(() => mobilPage.world.lod.why(mobilPage.person, 1));
  assert.ok(near.error_m > 0 && near.cost_us > 0, near.why);
  assert.equal(await set(page, 'heat', false) + await set(page, 'choose', false), '');
  await look(page, 2);
});
await test('people climb stairs, kerbs and hills', async () => {
  const flat = await tiles(page);
  for (const [ground, rise_m] of [[1, 0.1], [2, 0.08], [3, 0.6]]) {
    assert.equal(await set(page, 'ground', ground), '');
    const heights = [];
    for (let i = 0; i < 30; ++i) heights.push(await page.evaluate(() => { mobilPage.step(20); return mobilPage.world.matrices(mobilPage.person)[7]; }));
    assert.ok(Math.max(...heights) - Math.min(...heights) > rise_m, `ground ${ground}: hips from ${Math.min(...heights)} to ${Math.max(...heights)} m`);
    await look(page);
    await page.screenshot({ path: `${shots}/ground${ground}.png` });
  }
  assert.ok(differ(flat, await tiles(page)) > 0.02);
  // More than one period of the stairs, 16 m.
  const walked_m = () => page.evaluate(() => {
    const ahead_m = () => mobilPage.world.matrices(mobilPage.person)[11], from_m = ahead_m();
    for (let i = 0; i < 60; ++i) mobilPage.step(15);
    return ahead_m() - from_m;
  });
  const slower_m = await walked_m();
  assert.equal(await set(page, 'slow', false), '');
  const usual_m = await walked_m();
  assert.ok(slower_m < 0.95 * usual_m, `on stairs people go ${slower_m} m where they are slowed, and ${usual_m} m where not`);
  assert.equal(await set(page, 'slow', true) + await set(page, 'ground', 0), '');
});
await test('a crowd keeps clear of each other, and goes its ways', async () => {
  assert.equal(await set(page, 'people', 120), '');
  assert.equal(await set(page, 'clear', true), '');
  const places = () => page.evaluate(() => {
    const { world, crowd, person } = mobilPage, all = [person, crowd.people], out = [];
    for (const people of all) {
      const m = world.matrices(people);
      for (let i = 0; i < people.count; ++i) out.push([m[576 * i + 3], m[576 * i + 11]]);
    }
    return out;
  });
  let nearest = 9;
  const first = await places();
  for (let t = 0; t < 20; ++t) {
    await look(page, 15);
    const now = await places();
    now.forEach((a, i) => now.slice(0, i).forEach((b) => { nearest = Math.min(nearest, Math.hypot(a[0] - b[0], a[1] - b[1])); }));
  }
  const last = await places(), gone = last.map((a, i) => Math.hypot(a[0] - first[i][0], a[1] - first[i][1]));
  await page.screenshot({ path: `${shots}/clear.png` });
  console.log(`        nearest ${nearest.toFixed(2)} m, gone ${(gone.reduce((a, b) => a + b) / gone.length).toFixed(1)} m in 5 s`);
  assert.ok(nearest > 0.3 && gone.filter((d) => d > 3).length > 0.9 * gone.length);
  assert.equal(await set(page, 'clear', false) + await set(page, 'people', 0), '');
});
await test('the crowd is drawn from memory of its own', async () => {
  assert.equal(await set(page, 'people', 60), '');
  await look(page, 1);
  const [own, kept, moves] = await page.evaluate(() => {
    const { crowd, mobil: { library } } = mobilPage, { image } = crowd.texture, before = image.data, first = before.slice();
    library.memory.grow(1);  // invalidates views of the library's memory
    mobilPage.step(2);
    mobilPage.draw();
    return [before.buffer !== library.memory.buffer, image.data === before && before.length === 576 * crowd.people.count, before.some((v, i) => v !== first[i])];
  });
  assert.ok(own && kept && moves, `own ${own}, kept ${kept}, moves ${moves}`);
});
await test('five thousand people walk', async () => {
  assert.equal(await set(page, 'people', 5000), '');
  await look(page, 3);
  await page.screenshot({ path: `${shots}/crowd.png` });
  console.log(`        ${await page.evaluate(() => { const a = performance.now(); mobilPage.step(20); return ((performance.now() - a) / 20).toFixed(2); })} ms a tick`);
  assert.equal(await set(page, 'people', 0), '');
});
await test('new bodies do not eat memory', async () => {
  const bytes = () => page.evaluate(() => mobilPage.mobil.library.memory.buffer.byteLength);
  await set(page, 'height', 1.75);
  const before = await bytes();
  for (let i = 0; i < 30; ++i) assert.equal(await set(page, 'height', 1.6 + 0.01 * i), '');
  assert.ok(await bytes() - before < 8 * 2 ** 20, `${await bytes() - before} bytes more`);
});
await test('keys step and stop time; every control has a name', async () => {
  const time = () => page.evaluate(() => mobilPage.world.time_s);
  await page.focus('#view');
  const before = await time();
  await page.keyboard.press('.');
  assert.ok(Math.abs(await time() - before - 1 / 60) < 1e-9);
  await page.keyboard.press(' ');
  assert.equal(await page.textContent('#play'), 'Pause');
  await page.keyboard.press(' ');
  for (const name of ['height', 'speed', 'hamstrings', 'pull', 'ground', 'people', 'keep clear', 'choose']) assert.equal(await page.getByLabel(name, { exact: true }).count(), 1, name);
  assert.match(await page.getAttribute('#angles', 'aria-label'), /hip -?\d+, knee -?\d+, ankle -?\d+ degrees/);
});
await test('a table and a stride are files', async () => {
  await look(page, 30);
  let file = page.waitForEvent('download');
  await page.click('#csv');
  const rows = readFileSync(await (await file).path(), 'utf8').trim().split('\n');
  assert.ok(rows.length > 30 && rows.every((r) => r.split(',').length === rows[0].split(',').length));
  const before = await hash(page);
  file = page.waitForEvent('download');
  await page.click('#glb');
  await (await file).saveAs(`${shots}/walk.glb`);
  const glb = readFileSync(`${shots}/walk.glb`);
  assert.equal(glb.toString('latin1', 0, 4), 'glTF');
  const said = JSON.parse(glb.toString('utf8', 20, 20 + glb.readUInt32LE(12)));
  assert.equal(said.animations.length, 1);
  assert.ok(said.nodes.some((n) => n.name === 'T4') && said.meshes.some((m) => m.primitives[0].targets?.length === 20));
  assert.equal(await hash(page), before);
});
await test('a link holds the scene', async () => {
  await set(page, 'height', 1.66);
  await set(page, 'mass', 58);
  await set(page, 'toe_out_deg', 15);
  await set(page, 'method3', 'newmark');
  const link = new URL(await page.evaluate(() => mobilPage.address()));
  const [one, two] = [await open(`still&t=1&crowd=20&${link.search.slice(1).replace(/crowd=\d+&?/, '')}`), await open(`${link.search.slice(1).replace(/crowd=\d+&?/, '')}&crowd=20&t=1&still`)];
  assert.equal(await one.inputValue('#height') + await one.inputValue('#toe_out_deg') + await one.inputValue('#method3'), '1.6615newmark');
  assert.equal(await hash(one), await hash(two));
  await one.close();
  await two.close();
});
await test('a link that nobody can walk shows what is usual, and says why', async () => {
  const odd = await open('still&height=2.2&mass=40&methods=explicit_central,nonsense&crowd=0');
  assert.match(await odd.textContent('#refusal'), /default values are shown instead/);
  await odd.close();
});
await test('it is dark where people like it dark, and fits a telephone', async () => {
  const dark = await open('still&crowd=20', { colorScheme: 'dark', viewport: { width: 390, height: 780 }, hasTouch: true, isMobile: true });
  const [r, g, b] = await tiles(dark);
  assert.ok(r + g + b < 200, `${r} ${g} ${b}`);
  await dark.screenshot({ path: `${shots}/telephone.png` });
  await dark.close();
});
await test('where it cannot run there is a picture', async () => {
  const poster = await open('poster');
  assert.ok(await poster.isVisible('#poster img') && !(await poster.isVisible('#panel')));
  await poster.close();
});
await test('time runs', async () => {
  const visitor = await browser.newContext(usual);
  const first = await open('crowd=60', {}, visitor);
  await first.waitForFunction(() => mobilPage.world.time_s > 0.3, null, { timeout: 60000 });
  await first.close();
  const live = await open('crowd=60', {}, visitor);
  const marks = await live.evaluate(() => ['library', 'people'].map((name) => Math.round(performance.getEntriesByName(name)[0].startTime)));
  console.log(`        from the address, files in the cache: library ${marks[0]} ms, people ${marks[1]} ms, first picture (without a graphics card) ${await live.evaluate(() => document.body.dataset.ready)} ms; ${await live.textContent('#told')}`);
  await visitor.close();
});
await test('a frame that fails does not stop the page, and says so once', async () => {
  const live = await open('crowd=0'), before = said.length;
  const { frames, changes } = await live.evaluate(async () => {
    const refusal = document.getElementById('refusal'), { draw } = mobilPage;
    let frames = 0, changes = 0;
    new MutationObserver(() => ++changes).observe(refusal, { childList: true });
    mobilPage.draw = () => { ++frames; throw new Error('nothing can be drawn'); };
    for (let i = 0; frames < 5 && i < 500; ++i) await new Promise((done) => { setTimeout(done, 20); });
    mobilPage.draw = draw;
    return { frames, changes };
  });
  assert.equal(said.splice(before).length, 1);
  assert.ok(frames >= 5, `${frames} frames`);
  assert.equal(await live.textContent('#refusal'), 'nothing can be drawn');
  assert.equal(changes, 1, `in ${frames} frames`);
  const time_s = await live.evaluate(() => mobilPage.world.time_s);
  await live.waitForFunction((t) => mobilPage.world.time_s > t + 0.1, time_s, { timeout: 60000 });
  await live.close();
});
await test('no console error', () => assert.deepEqual(said, []));
await browser.close();
close();
console.log(`${passed} passed, ${failed} failed`);
process.exitCode = failed ? 1 : 0;
