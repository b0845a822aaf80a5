// The WebAssembly module: its memory as typed arrays, the structs of mobil.h, and errors.
import { constants, structs } from './interface.js';

/** Error of a refused call: the mistake, its place, the valid range and the remedy. `code` is that of mobil.h. */
export class MobilError extends Error {
  constructor(line, code) {
    super(line);
    this.name = 'MobilError';
    this.code = code;
  }
}

const views = { pointer: 'Uint32', text: 'Uint32', size_t: 'Uint32', int: 'Int32', 'unsigned int': 'Uint32', float: 'Float32', double: 'Float64' };
const bytesOf = (type) => (type === 'double' ? 8 : 4);

const ranges = { pointer: [0, 2 ** 32 - 1], size_t: [0, 2 ** 32 - 1], 'unsigned int': [0, 2 ** 32 - 1], int: [-(2 ** 31), 2 ** 31 - 1] };

/** Returns a number of a C type. Bools are 0 and 1. Fractions of integers, NaN and whatever is no number are refused. */
export function numberOf(value, what, type = 'int', [low, high] = ranges[type] ?? [-Infinity, Infinity]) {
  const number = value === null || typeof value === 'object' ? NaN : Number(value), whole = type in ranges;
  if (Number.isNaN(number) || (whole && !Number.isInteger(number))) throw new MobilError(`${what} is ${String(value)}; give ${whole ? 'an integer' : 'a number'}`, constants.MOBIL_REFUSED);
  if (number < low || number > high) throw new MobilError(`${what} ${number} is out of range; choose ${low} to ${high}`, constants.MOBIL_REFUSED);
  return number;
}

/** Returns true if this engine can run the library: it has SIMD of 128 bits. */
export function canRun() {
  // (module (func (drop (i8x16.splat (i32.const 0)))))
  return typeof WebAssembly === 'object' && WebAssembly.validate(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 9, 1, 7, 0, 65, 0, 253, 15, 26, 11]));
}

/** Returns true if this engine has relaxed SIMD with a fused multiply-add. The module `mobil.wasm` needs it, and has the
 *  bits of desktops; `mobil-plain.wasm` needs `canRun()` only. */
export function canFuse() {
  // f32x4.relaxed_madd of a = 1 + 2⁻¹², a·a − (1 + 2⁻¹¹): 2⁻²⁴ if fused, 0 if the product is rounded.
  const module = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 8, 1, 96, 3, 125, 125, 125, 1, 125, 3, 2, 1, 0, 7, 5, 1, 1, 109, 0, 0, 10, 22, 1, 20, 0, 32, 0, 253, 19, 32, 1, 253, 19, 32, 2, 253, 19, 253, 133, 2, 253, 31, 0, 11]);
  if (!canRun() || !WebAssembly.validate(module)) return false;
  const { m } = new WebAssembly.Instance(new WebAssembly.Module(module)).exports;
  const a = 1 + 2 ** -12;
  return m(a, a, -(1 + 2 ** -11)) === 2 ** -24;
}

/** Returns the bytes of a file, or an answer to fetch. Node reads `file:` addresses with its own module. */
async function request(address) {
  if (!address.startsWith('file:')) {
    const answer = await fetch(address);
    if (!answer.ok) throw new MobilError(`${address} is missing: ${answer.status}; copy mobil.wasm and mobil-plain.wasm there, or give their address to load()`, constants.MOBIL_REFUSED);
    return answer;
  }
  const files = 'node:fs/promises';  // not a literal, because bundlers for browsers would look for it
  const { readFile } = await import(/* webpackIgnore: true */ /* @vite-ignore */ files);
  try {
    return await readFile(new URL(address));
  } catch {
    throw new MobilError(`${address} cannot be read; give the folder of mobil.wasm and mobil-plain.wasm to load()`, constants.MOBIL_REFUSED);
  }
}

/** Compiles a module. `source`: its address, or bytes. Servers that do not know the type of .wasm are allowed. */
async function instantiate(source, imports) {
  const answer = source instanceof Uint8Array ? source : await request(source), named = typeof source === 'string' ? source : 'this module';
  if (!(answer instanceof Uint8Array) && answer.headers.get('content-type')?.startsWith('application/wasm')) {
    return WebAssembly.instantiateStreaming(answer, imports);
  }
  const bytes = answer instanceof Uint8Array ? answer : new Uint8Array(await answer.arrayBuffer());
  if ([0, 97, 115, 109].some((byte, i) => bytes[i] !== byte)) {
    throw new MobilError(`${named} is not WebAssembly; a server may have answered with a page (Vite's needs optimizeDeps.exclude: ['mobil'])`, constants.MOBIL_REFUSED);
  }
  if (!WebAssembly.validate(bytes)) throw new MobilError(`${named} needs features that this engine lacks${canFuse() ? '' : ', such as relaxed SIMD; use mobil-plain.wasm'}`, constants.MOBIL_REFUSED);
  return WebAssembly.instantiate(bytes, imports);
}

export class Library {
  /** Loads a module. `source`: its address or bytes. */
  static async load(source) {
    const self = new Library(), made = await instantiate(source, { wasi_snapshot_preview1: self.#wasi() });
    self.x = made.instance.exports;
    self.memory = self.x.memory;
    self.x._initialize();
    return self;
  }

  // Memory can grow in any call, which requires new views.
  get u8() { return this.#view('bytes', Uint8Array); }
  get u32() { return this.#view('words', Uint32Array); }
  get f32() { return this.#view('floats', Float32Array); }
  get data() { return this.#view('mixed', DataView); }

  /** Allocates memory of the module, to be released by release(). */
  allocate(bytes) {
    const at = this.x.malloc(Math.max(bytes, 1));
    if (at === 0) throw new MobilError(`no memory for ${bytes} bytes; this page has ${this.memory.buffer.byteLength}`, constants.MOBIL_MEMORY);
    return at;
  }
  release(at) { this.x.free(at); }

  /** Runs `body` with an allocator whose memory is released when it returns. */
  within(body) {
    const taken = [];
    try {
      return body((bytes) => {
        taken.push(this.allocate(bytes));
        return taken.at(-1);
      });
    } finally {
      for (const at of taken) this.release(at);
    }
  }

  #slots = [];
  /** Adds a function of five numbers that returns one to the module's table, and returns its slot; dropHost() frees it. */
  host(call) {
    // (module (import "h" "f" (func (param i32 i32 i32 i32 i32) (result i32))) (export "f" (func 0)))
    const module = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 10, 1, 96, 5, 127, 127, 127, 127, 127, 1, 127, 2, 7, 1, 1, 104, 1, 102, 0, 0, 7, 5, 1, 1, 102, 0, 0]);
    const { f } = new WebAssembly.Instance(new WebAssembly.Module(module), { h: { f: call } }).exports;
    const table = this.x.__indirect_function_table, slot = this.#slots.pop() ?? table.grow(1);
    table.set(slot, f);
    return slot;
  }
  dropHost(slot) {
    if (!slot) return;
    this.x.__indirect_function_table.set(slot, null);
    this.#slots.push(slot);
  }

  text(at) {
    let end = at;
    while (this.u8[end]) ++end;
    return new TextDecoder().decode(this.u8.slice(at, end));
  }
  /** Allocates a C string. */
  string(text, take) {
    const bytes = new TextEncoder().encode(text), at = take(bytes.length + 1);
    this.u8.set(bytes, at);
    this.u8[at + bytes.length] = 0;
    return at;
  }

  /** Fills a struct at `at` with defaults (`which`: MOBIL_PERSON and so on), then with the fields of `given`. */
  fill(name, which, at, given = {}) {
    const { size } = structs[name];
    const code = this.x.mobil_defaults(constants[which], at, size);
    if (code !== 0) throw new MobilError(`${name} is not as this module knows it`, code);
    for (const [field, value] of Object.entries(given)) if (value !== undefined) this.set(name, at, field, value);
  }
  set(name, at, field, value) {
    const place = structs[name].fields[field];
    if (!place) throw new MobilError(`${name} has no ${field}; it has ${Object.keys(structs[name].fields).join(', ')}`, constants.MOBIL_REFUSED);
    const put = `set${views[place.type]}`;
    if (place.count && value?.length !== place.count) throw new MobilError(`${field} of ${name} is ${place.count} numbers`, constants.MOBIL_REFUSED);
    if (place.count) for (let i = 0; i < place.count; ++i) this.data[put](at + place.at + bytesOf(place.type) * i, numberOf(value[i], `${field}[${i}]`, place.type), true);
    else this.data[put](at + place.at, numberOf(value, field, place.type), true);
  }
  /** Returns a field: a number, an array of numbers, or a string. */
  get(name, at, field) {
    const { at: begin, type, count } = structs[name].fields[field], one = (i) => this.data[`get${views[type]}`](at + begin + bytesOf(type) * i, true);
    if (type === 'text') return this.text(one(0));
    return count ? Array.from({ length: count }, (_, i) => one(i)) : one(0);
  }
  /** Converts a struct to an object. */
  object(name, at) {
    return Object.fromEntries(Object.keys(structs[name].fields).filter((f) => f !== 'size').map((f) => [f, this.get(name, at, f)]));
  }

  #views = {};
  #view(name, Type) {
    if (this.#views[name]?.buffer !== this.memory.buffer) this.#views[name] = new Type(this.memory.buffer);
    return this.#views[name];
  }

  // The system functions that the library needs: a clock, and messages when it ends.
  #wasi() {
    const refuse = () => 8;  // EBADF
    return {
      environ_get: () => 0,
      environ_sizes_get: (count, bytes) => { this.u32[count >> 2] = 0; this.u32[bytes >> 2] = 0; return 0; },
      clock_time_get: (clock, precision, out) => { this.data.setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true); return 0; },
      fd_close: refuse, fd_seek: refuse, fd_read: refuse, fd_fdstat_get: refuse,
      fd_write: (fd, list, count, out) => {
        let bytes = 0, text = '';
        for (let i = 0; i < count; ++i) {
          const [at, length] = this.u32.subarray((list >> 2) + 2 * i);
          text += new TextDecoder().decode(this.u8.slice(at, at + length));
          bytes += length;
        }
        console.error(text.trimEnd());
        this.u32[out >> 2] = bytes;
        return 0;
      },
      proc_exit: (code) => { throw new MobilError(`the library ended with ${code}`, constants.MOBIL_INTERNAL); },
    };
  }
}
