// Chromium without a window, for tests and pictures.
import { spawnSync } from 'node:child_process';
import { createRequire } from 'node:module';
import path from 'node:path';

/** A browser that draws by software, so that pictures are alike on all machines. `modules`: where playwright-core is. */
export function launch(modules) {
  const { chromium } = createRequire(path.resolve(modules, 'x.js'))('playwright-core');
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });
}

/** ffmpeg with these arguments; throws where it fails. */
export function ffmpeg(...args) {
  const done = spawnSync('ffmpeg', ['-y', '-v', 'error', ...args], { stdio: 'inherit' });
  if (done.status !== 0) throw new Error(`ffmpeg failed: ${args.at(-1)}`);
}
