// Headless Chromium, for tests and pictures.
import { spawnSync } from 'node:child_process';
import { createRequire } from 'node:module';
import path from 'node:path';

/** Starts a browser with software rendering, for equal pictures everywhere. `modules`: folder of playwright-core. */
export function launch(modules) {
  const { chromium } = createRequire(path.resolve(modules, 'x.js'))('playwright-core');
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });
}

/** Runs ffmpeg with these arguments; throws if it fails. */
export function ffmpeg(...args) {
  const done = spawnSync('ffmpeg', ['-y', '-v', 'error', ...args], { stdio: 'inherit' });
  if (done.status !== 0) throw new Error(`ffmpeg failed: ${args.at(-1)}`);
}
