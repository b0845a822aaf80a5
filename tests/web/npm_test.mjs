// The package as npm packs it, in a fresh project: Node, Vite, webpack, a plain page, TypeScript, and the examples for
// three.js and Babylon.js. Tools come from npm (npm_tools.json).
// Usage: node npm_test.mjs PACKAGE PLAYWRIGHT PROJECT; PROJECT is replaced. Exit status 1: a test failed.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import test, { after } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch } from '../../demo/web/chromium.mjs';
import { serve } from '../../demo/web/serve.mjs';

const [folder, playwright, project] = process.argv.slice(2).map((each) => path.resolve(each));
const here = path.dirname(fileURLToPath(import.meta.url)), examples = path.join(here, '../../demo/examples');
function run(command, args, options = {}) {
  const done = spawnSync(command, args, { cwd: project, encoding: 'utf8', ...options });
  assert.equal(done.status, 0, `${command} ${args.join(' ')}\n${done.stdout}${done.stderr}`);
  return done.stdout;
}
const write = (name, text) => {
  mkdirSync(path.dirname(path.join(project, name)), { recursive: true });
  writeFileSync(path.join(project, name), text);
};

rmSync(project, { recursive: true, force: true });
mkdirSync(project, { recursive: true });
copyFileSync(path.join(here, 'npm_tools.json'), path.join(project, 'package.json'));
const [packed] = JSON.parse(run('npm', ['pack', '--json', '--pack-destination', project], { cwd: folder }));
run('npm', ['install', '--silent', '--no-audit', '--no-fund', path.join(project, packed.filename)]);
const browser = await launch(playwright);
after(() => browser.close());

const walk = `
export async function walk(load) {
  const mobil = await load(), world = mobil.world();
  const people = world.spawn([0, 1].map((i) => ({ height_m: 1.75, mass_kg: 75, speed_m_s: 1.2, place: [i, 0, 0] })));
  world.tick(60);
  return { fused: mobil.fused, version: mobil.version, ahead_m: world.roots(people)[2], hash: world.hash() };
}`;
write('walk.js', walk);
const inNode = (flags = [], from = '') => JSON.parse(run('node', ['--no-warnings', ...flags, '--input-type=module', '-e',
  `import { load } from 'mobil'; import { walk } from './walk.js'; console.log(JSON.stringify(await walk(async () => load(${from}))));`]));
const fusing = inNode(['--experimental-wasm-relaxed-simd']);

/** Opens a page of `served` and returns what `look` of it returns. Errors of the page fail the test. */
async function visit(served, address, look, before = () => {}) {
  const { port, close } = await serve(served), page = await browser.newPage({ viewport: { width: 400, height: 400 } }), said = [];
  page.on('console', (m) => { if (m.type() === 'error') said.push(m.text()); });
  page.on('pageerror', (e) => said.push(String(e)));
  try {
    await before(page);
    await page.goto(`http://127.0.0.1:${port}/${address}`);
    const seen = await look(page);
    assert.deepEqual(said, []);
    return seen;
  } catch (error) {
    throw new Error(`${error.message}\n${said.join('\n')}`);
  } finally {
    await page.close();
    close();
  }
}
/** Waits until a person is drawn: between 2 and 40 % of the picture, in several colours. Stores the picture. */
async function person(page, name) {
  for (let tries = 0; ; ++tries) {
    const picture = await page.screenshot({ path: path.join(project, `${name}.png`) });
    const { part, colours } = await page.evaluate(async (data) => {
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
      const canvas = new OffscreenCanvas(100, 100), x = canvas.getContext('2d');
      x.drawImage(image, 0, 0, 100, 100);
      const pixels = new Uint32Array(x.getImageData(0, 0, 100, 100).data.buffer), seen = new Set();
      let body = 0;
      for (const pixel of pixels) if (pixel !== pixels[0]) { ++body; seen.add(pixel); }
      return { part: body / pixels.length, colours: seen.size };
    }, picture.toString('base64'));
    if (part > 0.02 && part < 0.4 && colours > 20) return;
    assert.ok(tries < 100, `${name}: ${(100 * part).toFixed(1)} % of the picture in ${colours} colours`);
    await page.waitForTimeout(300);
  }
}
const html = (script, from = '') => `<!doctype html><link rel="icon" href="data:,"><style>body { margin: 0 }</style><canvas width="400" height="400"></canvas><script type="module" ${from && `src="${from}"`}>${script}</script>`;

test('the archive has both modules, types and the licence', () => {
  const names = packed.files.map((file) => file.path);
  for (const name of ['mobil.js', 'mobil.wasm', 'mobil-plain.wasm', 'index.d.ts', 'interface.d.ts', 'LICENSE', 'README.md']) assert.ok(names.includes(name), name);
  console.log(`        ${(packed.size / 1024).toFixed(0)} kB packed, ${(packed.unpackedSize / 1024).toFixed(0)} kB unpacked`);
});

test('Node loads it without a flag or an address', () => {
  const made = inNode();
  assert.equal(made.version, packed.version);
  assert.equal(made.fused, JSON.parse(run('node', ['--input-type=module', '-e', "import { canFuse } from 'mobil'; console.log(canFuse())"])));
  assert.ok(made.ahead_m > 0.5);
  assert.ok(fusing.fused);
});

test('Node loads it from a folder, a file, an address and bytes', () => {
  const plain = inNode([], 'undefined, false'), at = path.join(project, 'node_modules/mobil');
  assert.equal(plain.fused, false);
  for (const from of [`'./node_modules/mobil', false`, `${JSON.stringify(at)}, false`, `'./node_modules/mobil/mobil-plain.wasm'`, `new URL(${JSON.stringify(pathToFileURL(`${at}/`).href)}), false`,
    `(await import('node:fs')).readFileSync('node_modules/mobil/mobil-plain.wasm')`, `(await import('node:fs')).readFileSync('node_modules/mobil/mobil-plain.wasm').buffer`]) {
    const bytes = from.includes('.buffer') ? `new Uint8Array(${from.replace('.buffer', '')}).buffer` : from;
    assert.deepEqual(inNode([], bytes), plain, from);
  }
  const refused = (from) => spawnSync('node', ['--input-type=module', '-e', `import { load } from 'mobil'; try { await load(${from}); } catch (e) { console.log(e.name + ' ' + e.message); }`], { cwd: project, encoding: 'utf8' }).stdout;
  assert.match(refused(`'nowhere'`), /^MobilError file:\S*nowhere\S* cannot be read; give the folder.*\n$/);
  assert.match(refused('new Uint8Array([60, 33])'), /^MobilError this module is not WebAssembly.*\n$/);
  assert.match(refused('new Uint8Array([0, 97, 115, 109, 9])'), /^MobilError this module needs features.*\n$/);
});

test('Vite bundles it with the example for three.js', async () => {
  write('three/index.html', html('', './three.js'));
  copyFileSync(path.join(examples, 'three.js'), path.join(project, 'three/three.js'));
  run('npx', ['vite', 'build', 'three', '--base', './', '--logLevel', 'warn']);
  await visit(path.join(project, 'three/dist'), '', (page) => person(page, 'three'));
});

test('webpack bundles it with the example for Babylon.js', async () => {
  copyFileSync(path.join(examples, 'babylon.js'), path.join(project, 'babylon.js'));
  const webpack = createRequire(path.join(project, 'x.js'))('webpack'), out = path.join(project, 'babylon');
  const stats = await new Promise((done, failed) => {
    webpack({ context: project, entry: './babylon.js', mode: 'production', output: { path: out, filename: 'main.js' }, performance: { hints: false } }, (error, made) => (error ? failed(error) : done(made)));
  });
  assert.ok(!stats.hasErrors() && !stats.hasWarnings(), stats.toString('errors-warnings'));
  write('babylon/index.html', html('', './main.js'));
  await visit(out, '', (page) => person(page, 'babylon'));
});

const plainPage = async (before) => visit(project, 'plain.html', async (page) => {
  await page.waitForFunction(() => document.title, null, { timeout: 60000 });
  return JSON.parse(await page.title());
}, before);
test('a plain page loads it by a script, with the bits of Node', async () => {
  write('plain.html', html("import { load } from './node_modules/mobil/mobil.js'; import { walk } from './walk.js'; document.title = JSON.stringify(await walk(load));"));
  const seen = await plainPage();
  if (seen.fused) assert.deepEqual(seen, fusing);
});
test('a server that does not know the type of .wasm is enough', async () => {
  const octets = (page) => page.route('**/*.wasm', async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, headers: { ...answer.headers(), 'content-type': 'application/octet-stream' } });
  });
  assert.ok((await plainPage(octets)).ahead_m > 0.5);
});

const tsc = (file) => run('npx', ['tsc', '--strict', '--noEmit', '--noUncheckedIndexedAccess', '--target', 'es2022', '--module', 'nodenext', '--lib', 'es2022,dom', file]);
test('tsc --strict accepts a program that uses each class', () => {
  copyFileSync(path.join(here, 'npm_example.ts'), path.join(project, 'example.ts'));
  tsc('example.ts');
});
test('types declare each export, method and field, and nothing else', async () => {
  const module = await import(pathToFileURL(path.join(project, 'node_modules/mobil/mobil.js')));
  const mobil = await module.load(), world = mobil.world(), people = world.spawn([{ height_m: 1.8, mass_kg: 80 }]);
  // Between the package's own files only.
  const internal = ['inside', 'counts', 'finish', 'drop of Terrain', 'library of People', 'library of World'];
  const each = { Mobil: mobil, World: world, People: people, Surfaces: world.surfaces(people), Lod: world.lod, Avoidance: world.avoidance, Terrain: world.terrain };
  const lines = Object.entries(each).map(([name, object]) => {
    const all = new Set(Object.keys(object));
    for (let of = Object.getPrototypeOf(object); of !== Object.prototype; of = Object.getPrototypeOf(of)) for (const method of Object.getOwnPropertyNames(of)) all.add(method);
    const members = [...all].filter((member) => member !== 'constructor' && !internal.includes(member) && !internal.includes(`${member} of ${name}`));
    const optional = internal.filter((i) => i.endsWith(` of ${name}`)).map((i) => i.split(' ')[0]);
    return `same<${members.map((m) => `'${m}'`).join(' | ')}, Exclude<keyof m.${name}, ${optional.map((m) => `'${m}'`).join(' | ') || 'never'}>>(true);`;
  });
  const exported = Object.keys(module).map((n) => `'${n}'`).join(' | '), skin = Object.keys(world.skinBinding(people, module.DETAILS.distant)).map((n) => `'${n}'`).join(' | ');
  write('members.ts', `import * as m from 'mobil';
type Same<A, B> = [A] extends [B] ? ([B] extends [A] ? true : ['not in the package', Exclude<B, A>]) : ['not declared', Exclude<A, B>];
declare function same<A, B>(it: Same<A, B>): void;
same<${exported}, keyof typeof m>(true);
same<${skin}, keyof m.SkinBinding>(true);
${lines.join('\n')}
`);
  tsc('members.ts');
});
