// Serves a folder of static files, on this machine only. Usage: node serve.mjs FOLDER [PORT]
import http from 'node:http';
import { readFile, stat } from 'node:fs/promises';
import path from 'node:path';

const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.jpg': 'image/jpeg' };

/** Listens on `port` (0: any free one); resolves to {port, close}. */
export async function serve(folder, port = 0) {
  const root = path.resolve(folder);
  const server = http.createServer(async (question, answer) => {
    try {
      const asked = decodeURIComponent(new URL(question.url, 'http://x').pathname);
      const file = path.join(root, asked.endsWith('/') ? `${asked}index.html` : asked);
      if (!file.startsWith(root + path.sep)) throw new Error('outside');
      const { mtimeMs, size } = await stat(file), etag = `"${mtimeMs}-${size}"`;
      const known = question.headers['if-none-match'] === etag;
      answer.writeHead(known ? 304 : 200, { 'content-type': types[path.extname(file)] ?? 'application/octet-stream', 'cache-control': 'no-cache', etag });
      answer.end(known ? undefined : await readFile(file));
    } catch {
      answer.writeHead(404);
      answer.end();
    }
  });
  await new Promise((done, failed) => {
    server.on('error', failed);
    server.listen(port, '127.0.0.1', done);
  });
  return { port: server.address().port, close: () => server.close() };
}

if (process.argv[1]?.endsWith('serve.mjs')) {
  const { port } = await serve(process.argv[2] ?? '.', Number(process.argv[3] ?? 8080)).catch((error) => {
    console.error(`cannot listen: ${error.message}; choose another port: demo/web/run --port N`);
    process.exit(2);
  });
  console.log(`open http://127.0.0.1:${port}/ in a browser; Ctrl-C ends`);
}
