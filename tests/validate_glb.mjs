// Runs Khronos' glTF validator on one file. Usage: node validate_glb.mjs FILE.glb
// Prints every message (error, warning, information, hint) and the counts. Exit status 0: no errors and no warnings;
// 1: some; 2: bad usage or no such file; 77: the npm package gltf-validator was not found.
// It searches for the package in MOBIL_NODE_MODULES, NODE_PATH, next to this script and above the working folder.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

function findValidator() {
  const places = [process.env.MOBIL_NODE_MODULES, process.cwd()].filter(Boolean).map((folder) => join(folder, 'any.js'));
  for (const place of [...places, import.meta.url]) {
    try {
      return createRequire(place)('gltf-validator');
    } catch (error) {
      if (error.code !== 'MODULE_NOT_FOUND') throw error;
    }
  }
  return null;
}

const file = process.argv[2];
if (process.argv.length !== 3) {
  console.error('usage: node validate_glb.mjs FILE.glb');
  process.exit(2);
}
const validator = findValidator();
if (validator === null) {
  console.error('gltf-validator is not installed; npm install --prefix FOLDER gltf-validator, then set ' +
                'MOBIL_NODE_MODULES=FOLDER/node_modules');
  process.exit(77);
}
let bytes;
try {
  bytes = new Uint8Array(readFileSync(file));
} catch (error) {
  console.error(`${file}: cannot be read (${error.code})`);
  process.exit(2);
}
const report = await validator.validateBytes(bytes, { maxIssues: 1000, format: 'glb' });
const severity = ['error', 'warning', 'information', 'hint'];
for (const { severity: level, code, pointer, message } of report.issues.messages) {
  console.log(`${severity[level]}: ${code} at ${pointer ?? `byte ${message.offset}`}: ${message}`);
}
const { numErrors, numWarnings, numInfos, numHints } = report.issues;
console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} informations, ${numHints} hints`);
process.exit(numErrors + numWarnings > 0 ? 1 : 0);
