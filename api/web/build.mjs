// SPDX-License-Identifier: Apache-2.0
// Bundles the dashboard: node build.mjs DIST [DEPFILE TARGET]; the latter for Ninja.
import { build } from 'esbuild';
import { copyFileSync, mkdirSync, writeFileSync } from 'node:fs';
import { resolve } from 'node:path';

const [dist = 'dist', depfile, target] = process.argv.slice(2);
const copied = ['index.html', 'icon.svg'];

const result = await build({
  entryPoints: { app: 'src/app.ts', style: 'style.css' },
  outdir: dist,
  bundle: true,
  minify: true,
  format: 'esm',
  target: ['chrome110', 'firefox115', 'safari16'],
  charset: 'utf8',
  legalComments: 'none',
  preserveSymlinks: true,
  metafile: true,
  logLevel: 'warning',
});
mkdirSync(dist, { recursive: true });
for (const file of copied) {
  copyFileSync(file, `${dist}/${file}`);
}
if (depfile) {
  const inputs = [...Object.keys(result.metafile.inputs), ...copied].map((file) => resolve(file));
  writeFileSync(depfile, `${target}: ${inputs.map((file) => file.replaceAll(' ', '\\ ')).join(' ')}\n`);
}
