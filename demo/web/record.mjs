// Records the page's pictures: page.webp, a stride, and poster.jpg, which is shown if the page cannot run.
// Usage: node record.mjs PLAYWRIGHT PAGE, the folder where tests/web/run installs playwright-core, and the built page.
import { mkdtemp, rm } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { ffmpeg, launch } from './chromium.mjs';
import { serve } from './serve.mjs';

const [modules, built] = process.argv.slice(2).map((folder) => path.resolve(folder));
if (!built) throw new Error('usage: node record.mjs PLAYWRIGHT PAGE');
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const before = 300, frames = 32, ticks = 4, width = 760, height = 451;

const { port, close } = await serve(built);
const browser = await launch(modules);
const folder = await mkdtemp(path.join(os.tmpdir(), 'record-'));
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 760 } });
  await page.goto(`http://127.0.0.1:${port}/?pull=1&crowd=120&clear=1`);
  await page.waitForFunction(() => document.body.dataset.ready, null, { timeout: 120000 });
  const step = async (count) => {
    for (let k = 0; k < count; ++k) await page.keyboard.press('.');
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  };
  await step(before);
  for (let i = 0; i < frames; ++i) {
    await step(ticks);
    await page.screenshot({ path: path.join(folder, `${String(i).padStart(3, '0')}.png`) });
    process.stdout.write(`\r${i + 1} of ${frames} pictures${i + 1 === frames ? '\n' : ''}`);
  }
  ffmpeg('-framerate', '15', '-i', path.join(folder, '%03d.png'), '-vf', `scale=${width}:${height}:flags=lanczos`,
    '-c:v', 'libwebp_anim', '-loop', '0', '-quality', '60', path.join(here, 'page.webp'));
  ffmpeg('-i', path.join(folder, '000.png'), '-q:v', '4', path.join(here, 'poster.jpg'));
} finally {
  await browser.close();
  close();
  await rm(folder, { recursive: true });
}
