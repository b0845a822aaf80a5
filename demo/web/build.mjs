// Bundles the page to static files in OUT: node build.mjs NODE_MODULES PACKAGE OUT. PACKAGE: built systems/javascript.
import { cpSync, mkdirSync, existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const [, , modules, library, out] = process.argv;
const here = path.dirname(fileURLToPath(import.meta.url));
const { build } = createRequire(path.resolve(modules, 'x.js'))('esbuild');
mkdirSync(out, { recursive: true });
await build({
  entryPoints: [path.join(here, 'main.js')], outfile: path.join(out, 'bundle.js'), bundle: true, format: 'esm', minify: true,
  target: 'es2022', nodePaths: [path.resolve(modules)], alias: { mobil: path.resolve(library, 'mobil.js') }, logLevel: 'warning',
});
cpSync(path.join(here, 'page.html'), path.join(out, 'index.html'));
for (const file of ['style.css', 'poster.jpg']) if (existsSync(path.join(here, file))) cpSync(path.join(here, file), path.join(out, file));
for (const file of ['mobil.wasm', 'mobil-plain.wasm']) if (existsSync(path.join(library, file))) cpSync(path.join(library, file), path.join(out, file));
