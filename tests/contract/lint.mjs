// SPDX-License-Identifier: Apache-2.0
// Spectral, Redocly and AsyncAPI's own parser on the two descriptions.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

import { Parser } from '@asyncapi/parser';

import { repository } from './stack.mjs';

const here = path.join(repository, 'tests/contract');
const openapi = path.join(repository, 'api/openapi.yaml');
const asyncapi = path.join(repository, 'api/asyncapi.yaml');

/// Throws what the tool says if it finds anything.
function run(tool, ...args) {
  try {
    execFileSync(process.execPath, [path.join(here, 'node_modules/.bin', tool), ...args],
      { cwd: here, encoding: 'utf8', stdio: 'pipe' });
  } catch (error) {
    throw new Error(`${tool}:\n${error.stdout}${error.stderr}`);
  }
}

export async function lint() {
  run('spectral', 'lint', '--fail-severity', 'hint', openapi, asyncapi);
  run('redocly', 'lint', '--extends', 'recommended', '--max-problems', '1000', openapi);
  const { document, diagnostics } = await new Parser().parse(fs.readFileSync(asyncapi, 'utf8'));
  // 3.0.0 is what most tools read: that there is a newer one is no finding.
  const findings = diagnostics.filter((one) => one.code !== 'asyncapi-latest-version');
  if (findings.length || !document) throw new Error(JSON.stringify(findings, null, 1));
  return `Spectral, Redocly and @asyncapi/parser find nothing in either description`;
}
