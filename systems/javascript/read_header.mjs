// Reads mobil.h and writes its declarations for JavaScript: structs with the offsets of their fields on wasm32, constants
// and the names of functions.
// Usage: node read_header.mjs mobil.h interface.js EXPORTS
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';

const sizes = { 'size_t': 4, 'int': 4, 'unsigned int': 4, float: 4, double: 8, pointer: 4 };

function declarators(type, list) {  // "float place[3], heading_rad" → [{name, count}…]
  return list.split(',').map((text) => {
    const [, star, name, count] = /^\s*(\**)\s*(\w+)\s*(?:\[(\w+)\])?\s*$/.exec(text) ?? [];
    if (!name) throw new Error(`mobil.h: cannot read "${type} ${text}"`);
    return { name, pointer: star !== '', count: count ? Number(count) : 0 };
  });
}

export function readHeader(text) {
  const code = text.replace(/\/\*[\s\S]*?\*\//g, '').replace(/^\s*#.*$/gm, '').replace(/MOBIL_DEPRECATED\(.*?\)/g, '')
    .replace(/MOBIL_RENAMED\((\w+), (\w+), \w+\)/g, '$1 $2');
  const constants = {};
  for (const [, body] of code.matchAll(/\benum\s*\{([^}]*)\}/g)) {
    let next = 0;
    for (const entry of body.split(',').map((e) => e.trim()).filter(Boolean)) {
      const [name, value] = entry.split('=').map((e) => e.trim());
      next = value === undefined ? next : constants[value] ?? Number(value);
      constants[name] = next++;
    }
  }
  const structs = {};
  for (const [, body, name] of code.matchAll(/typedef struct \w+\s*\{([^}]*)\}\s*(\w+);/g)) {
    const fields = {};
    let at = 0, alignment = 1;
    const put = (field, type, size, count, align = size) => {
      at = Math.ceil(at / align) * align;
      alignment = Math.max(alignment, align);
      fields[field] = { at, type, count };
      at += size * Math.max(count, 1);
    };
    for (const line of body.split(';').map((l) => l.replace(/\s+/g, ' ').trim()).filter(Boolean)) {
      const called = /\(\*(\w+)\)/.exec(line);
      if (called) {
        put(called[1], 'pointer', 4, 0);
        continue;
      }
      const [, type, list] = /^((?:const |struct )*(?:unsigned \w+|\w+))\s*(.*)$/.exec(line);
      const bare = type.replace(/const |struct /g, '');
      for (const { name: field, pointer, count } of declarators(type, list)) {
        if (pointer) put(field, 'pointer', 4, count);
        else if (sizes[bare]) put(field, bare, sizes[bare], count);
        else if (structs[bare]) put(field, bare, structs[bare].size, count, structs[bare].alignment);
        else throw new Error(`mobil.h: unknown type ${bare}`);
      }
    }
    structs[name] = { size: Math.ceil(at / alignment) * alignment, alignment, fields };
  }
  const functions = [...code.matchAll(/MOBIL_API[^;(]*?\b(mobil_\w+)\(/g)].map((m) => m[1]);
  return { structs, constants, functions };
}

// Returns the text of mobil.h with the parts that it includes.
export function wholeHeader(header) {
  return readFileSync(header, 'utf8')
    .replace(/#include <mobil\/(c\/\w+\.h)>/g, (_, part) => readFileSync(join(dirname(header), part), 'utf8'));
}

const [, program, header, out, exportsFile] = process.argv;
if (out && program.endsWith('read_header.mjs')) {
  const read = readHeader(wholeHeader(header));
  writeFileSync(out, '// Made from mobil.h by read_header.mjs.\n' +
    Object.entries(read).map(([name, value]) => `export const ${name} = ${JSON.stringify(value)};\n`).join(''));
  if (exportsFile) writeFileSync(exportsFile, read.functions.map((name) => `-Wl,--export-if-defined=${name}\n`).join(''));
}
