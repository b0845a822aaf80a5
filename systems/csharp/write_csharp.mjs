// Writes Mobil.cs, the C interface for C# (Unity, .NET, Mono), from mobil.h: structs of the same layout, constants and
// functions. It needs C# 7.3 and the compiler option /unsafe ("Allow unsafe code").
// Usage: node write_csharp.mjs mobil.h Mobil.cs
import { writeFileSync } from 'node:fs';
import { readHeader, wholeHeader } from '../javascript/read_header.mjs';

const plain = { int: 'int', 'unsigned int': 'uint', float: 'float', double: 'double', size_t: 'UIntPtr', char: 'byte',
  'unsigned char': 'byte', void: 'void' };
const reserved = new Set(['in', 'out', 'ref', 'params', 'object', 'lock', 'fixed', 'event', 'base', 'string', 'is', 'as']);
const named = (name) => reserved.has(name) ? `@${name}` : name;

const [, , header, out] = process.argv;
const text = wholeHeader(header);
const { structs, constants, functions } = readHeader(text);

function typeOf(c) {  // "const mobil_person*" → "mobil_person*"
  const bare = c.replace(/\b(const|struct)\b/g, '').replace(/\s+/g, ' ').trim();
  const stars = bare.replace(/[^*]/g, '').length, base = bare.replace(/[* ]+$/g, '').replace(/\*/g, '').trim();
  if (plain[base]) return plain[base] + '*'.repeat(stars);
  if (structs[base]) return base + '*'.repeat(stars);
  return 'IntPtr' + '*'.repeat(Math.max(stars - 1, 0));  // mobil_sim*, functions of the host
}

const fields = ([name, { type, count }]) => {
  const of = type === 'pointer' || type === 'text' ? 'IntPtr' : typeOf(type);
  if (!count) return [`public ${of} ${named(name)};`];
  if (plain[type] && of !== 'UIntPtr') return [`public fixed ${of} ${named(name)}[${count}];`];
  return Array.from({ length: count }, (_, i) => `public ${of} ${name}${i};`);
};

const lines = ['// Made from mobil.h by write_csharp.mjs. Its comments describe each name.', '#pragma warning disable 649',
  'using System;', 'using System.Runtime.InteropServices;', '', 'public static unsafe class Mobil {',
  '  const string library = "mobil";  // mobil.dll, libmobil.so', ''];
for (const [name, value] of Object.entries(constants)) lines.push(`  public const int ${name} = ${value};`);
lines.push(`  public const int MOBIL_INTERFACE = ${/#define MOBIL_INTERFACE (\d+)/.exec(text)[1]};`, '');
for (const [name, struct] of Object.entries(structs)) {
  lines.push(`  [StructLayout(LayoutKind.Sequential)] public struct ${name} {`);
  for (const field of Object.entries(struct.fields)) lines.push(...fields(field).map((line) => `    ${line}`));
  lines.push('  }');
}
lines.push('');
const code = text.replace(/\/\*[\s\S]*?\*\//g, '').replace(/^\s*#.*$/gm, '').replace(/MOBIL_DEPRECATED\(.*?\)/g, '');
let written = 0;
for (const [, result, name, list] of code.matchAll(/MOBIL_API\s+([^;(]*?)\b(mobil_\w+)\(([^;]*?)\);/g)) {
  const parameters = list.trim() === 'void' ? [] : list.replace(/\s+/g, ' ').split(',').map((text) => {
    const [, type, parameter, array] = /^(.*?[\s*])(\w+)\s*(\[\w*\])?$/.exec(text.trim());
    return `${typeOf(type + (array ? '*' : ''))} ${named(parameter)}`;
  });
  const back = typeOf(result);
  lines.push('  [DllImport(library, CallingConvention = CallingConvention.Cdecl)]',
    `  public static extern ${back} ${name}(${parameters.join(', ')});`);
  ++written;
}
if (written !== functions.length) throw new Error(`mobil.h: ${written} of ${functions.length} functions were read`);
lines.push('', '  /// <summary>The message of the last failed call.</summary>',
  '  public static string Message(IntPtr sim) {', '    byte* text = mobil_message(sim);', '    int length = 0;',
  '    while (text[length] != 0) ++length;', '    return System.Text.Encoding.UTF8.GetString(text, length);', '  }', '}');
writeFileSync(out, lines.join('\n') + '\n');
