// SPDX-License-Identifier: Apache-2.0
// To work on the dashboard: npm run dev [-- http://127.0.0.1:8080]. Rebuilds on every change, serves
// it on port 8090, and passes everything else on to the service.
import { context } from 'esbuild';
import { createReadStream, existsSync } from 'node:fs';
import { createServer, request } from 'node:http';

const service = new URL(process.argv[2] ?? 'http://127.0.0.1:8080');
const dist = 'dist';
const types = { html: 'text/html; charset=utf-8', js: 'text/javascript', css: 'text/css', svg: 'image/svg+xml' };

const bundle = await context({
  entryPoints: { app: 'src/app.ts', style: 'style.css' },
  outdir: dist,
  bundle: true,
  sourcemap: 'inline',
  format: 'esm',
  logLevel: 'info',
});
await bundle.watch();

function serveFile(name, response) {
  const file = ['index.html', 'icon.svg'].includes(name) ? name : `${dist}/${name}`;
  if (!existsSync(file)) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, {
    'Content-Type': types[name.split('.').pop()] ?? 'application/octet-stream',
    'Content-Security-Policy': "default-src 'self'; frame-ancestors 'none'",
    'Cache-Control': 'no-store',
  });
  createReadStream(file).pipe(response);
}

function pass(incoming, response) {
  const { method, url, headers } = incoming;
  const onward = request(new URL(url, service), { method, headers }, (answer) => {
    response.writeHead(answer.statusCode, answer.headers);
    answer.pipe(response);
  });
  onward.on('error', () => response.writeHead(502).end());
  response.on('close', () => onward.destroy());
  incoming.pipe(onward);
}

createServer((incoming, response) => {
  const path = incoming.url.split('?')[0];
  if (path === '/') serveFile('index.html', response);
  else if (/^\/assets\/[\w.-]+$/.test(path)) serveFile(path.slice(8), response);
  else pass(incoming, response);
}).listen(8090, '127.0.0.1', () => console.log(`http://127.0.0.1:8090 in front of ${service}`));
