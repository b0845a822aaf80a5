// Reads mobil.h and writes its declarations for JavaScript: structs with the offsets of their fields on wasm32, constants
// and the names of functions (FOLDER/interface.js), and for TypeScript (FOLDER/interface.d.ts).
// Usage: node read_header.mjs mobil.h FOLDER EXPORTS
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
        if (pointer) put(field, bare === 'char' ? 'text' : 'pointer', 4, count);
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

const asDoc = (comment, indent = '') => {
  const words = comment?.replace(/^\/\*+\s*|\s*\*+\/$/g, '').replace(/\s*\n\s*\*?\s*/g, ' ').trim();
  return words ? `${indent}/** ${words} */\n` : '';
};

/** Returns constants and structs as TypeScript, with the header's comments. Fields that JavaScript does not set are left
 *  out: pointers, nested structs, sizes and bits of `given`. */
export function typesOf(text, { structs, constants }) {
  const comments = {}, fields = {}, about = {};
  for (const [, body] of text.matchAll(/\benum\s*\{([^}]*)\}/g)) {
    for (const [, , name, comment] of body.matchAll(/(\/\*[\s\S]*?\*\/)|\b(MOBIL_\w+)\b[^,/]*,?[ \t]*(\/\*[\s\S]*?\*\/)?/g)) if (name) comments[name] = comment;
  }
  for (const [, before, body, name] of text.matchAll(/(?:^(\/\*(?:(?!\*\/)[\s\S])*\*\/)\n)?typedef struct \w+\s*\{([^}]*)\}\s*(\w+);/gm)) {
    about[name] = before;
    for (const [, declared, comment] of body.matchAll(/([^;]+);[ \t]*(\/\*[\s\S]*?\*\/)?/g)) {
      const names = declared.replace(/\/\*[\s\S]*?\*\//g, '').replace(/MOBIL_RENAMED\(\w+, (\w+), \w+\)/, '$1').match(/\w+(?=\s*(?:\[\w+\])?\s*(?:,|$))/g) ?? [];
      for (const field of names) (fields[name] ??= {})[field] = comment;
    }
  }
  const left_out = ['size', 'given', 'unused', 'unused_2', 'style_count'];
  const typeOf = ({ type, count }) => (type === 'text' ? 'string' : count ? 'ArrayLike<number>' : type === 'int' ? 'number | boolean' : 'number');
  const lines = Object.entries(structs).map(([name, of]) => {
    const rows = Object.entries(of.fields).filter(([field, { type }]) => !left_out.includes(field) && (sizes[type] || type === 'text') && type !== 'pointer')
      .map(([field, as]) => `${asDoc(fields[name]?.[field], '  ')}  ${field}?: ${typeOf(as)};\n`);
    return rows.length ? `${asDoc(about[name])}export interface ${name} {\n${rows.join('')}}\n` : '';
  });
  const named = Object.entries(constants).map(([name, value]) => `${asDoc(comments[name], '  ')}  readonly ${name}: ${value};\n`);
  return `// Made from mobil.h by read_header.mjs. Fields of requests are optional: missing ones have their defaults.\n${lines.join('')}/** Constants of mobil.h. */\nexport interface Constants {\n${named.join('')}}\n`;
}

const [, program, header, folder, exportsFile] = process.argv;
if (folder && program.endsWith('read_header.mjs')) {
  const whole = wholeHeader(header), read = readHeader(whole);
  writeFileSync(join(folder, 'interface.js'), '// Made from mobil.h by read_header.mjs.\n' +
    Object.entries(read).map(([name, value]) => `export const ${name} = ${JSON.stringify(value)};\n`).join(''));
  writeFileSync(join(folder, 'interface.d.ts'), typesOf(whole, read));
  if (exportsFile) writeFileSync(exportsFile, read.functions.map((name) => `-Wl,--export-if-defined=${name}\n`).join(''));
}
