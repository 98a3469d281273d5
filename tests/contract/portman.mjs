// SPDX-License-Identifier: Apache-2.0
// Contract tests that Portman makes of openapi.yaml, run by Newman.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

import { repository } from './stack.mjs';

const bin = path.join(repository, 'tests/contract/node_modules/.bin');

/// What Portman is to ask about: real ids, and times that there is something to say about.
function config(stack, { robot, incident }) {
  const id = (pattern, value) => ({ openApiOperation: `*::${pattern}`,
    overwriteRequestPathVariables: [{ key: 'id', value, overwrite: true }] });
  const without = (pattern, ...keys) => ({ openApiOperation: `*::${pattern}`,
    overwriteRequestQueryParams: keys.map((key) => ({ key, remove: true })),
    overwriteRequestHeaders: ['If-None-Match', 'If-Match', 'Last-Event-ID'].map((key) => ({ key, remove: true })) });
  const gets = ['/api/v1/robots', '/api/v1/robots/{id}', '/api/v1/robots/{id}/scans',
    '/api/v1/robots/{id}/scores', '/api/v1/robots/{id}/config', '/api/v1/incidents',
    '/api/v1/incidents/{id}', '/api/v1/incidents/{id}/evidence', '/api/v1/incidents/{id}/history',
    '/api/v1/config', '/api/v1/config/history', '/api/v1/me', '/api/v1/service',
    '/api/v1/openapi.json', '/api/v1/asyncapi.json', '/healthz', '/readyz', '/metrics'];
  const one = (openApiOperation) => ({ openApiOperation, statusSuccess: { enabled: true },
    contentType: { enabled: true }, headersPresent: { enabled: false } });
  return {
    version: 1.0,
    globals: { securityOverwrites: { bearer: { token: stack.tokens.admin } },
      stripResponseExamples: true },
    tests: { contractTests: gets.map((get) => one(`GET::${get}`)).concat(gets
      .filter((get) => get !== '/metrics')
      .map((get) => ({ openApiOperation: `GET::${get}`, jsonBody: { enabled: true },
        schemaValidation: { enabled: true } }))) },
    overwrites: [id('/api/v1/robots/{id}', robot), id('/api/v1/robots/{id}/*', robot),
      id('/api/v1/incidents/{id}', incident), id('/api/v1/incidents/{id}/*', incident),
      without('/*', 'from', 'to', 'cursor', 'robot', 'state', 'kind', 'label', 'resolution')],
  };
}

export async function portmanAndNewman(stack) {
  const { incidents } = await stack.get('/api/v1/incidents');
  const file = (name) => path.join(stack.folder, name);
  fs.writeFileSync(file('portman.json'),
    JSON.stringify(config(stack, { robot: incidents[0].robotId, incident: incidents[0].id })));
  // Only what is read, as it is: other requests are operations.mjs' and random.mjs'.
  fs.writeFileSync(file('filter.json'), JSON.stringify({ methods: ['put', 'post', 'patch', 'delete'],
    operationIds: ['getEvents', 'getPage', 'getAsset', 'getRoc'] }));
  run('portman', stack, ['-l', path.join(repository, 'api/openapi.yaml'), '-c', file('portman.json'),
    '--filterFile', file('filter.json'), '-o', file('collection.json'),
    '-b', `http://127.0.0.1:${stack.rest}`]);
  run('newman', stack, ['run', file('collection.json'), '--reporters', 'json',
    '--reporter-json-export', file('newman.json')]);
  const { stats, failures } = JSON.parse(fs.readFileSync(file('newman.json'), 'utf8')).run;
  const { total, failed } = stats.assertions;
  if (failed || failures.length || total < 60) {
    throw new Error(failures.map((one) => `${one.source?.name}: ${one.error.message}`).join('\n') ||
      `only ${total} assertions`);
  }
  return `${stats.requests.total} requests, ${total} assertions made by Portman hold`;
}

function run(tool, stack, args) {
  try {
    execFileSync(process.execPath, [path.join(bin, tool), ...args],
      { cwd: stack.folder, encoding: 'utf8', stdio: 'pipe' });
  } catch (error) {
    if (tool === 'newman' && fs.existsSync(path.join(stack.folder, 'newman.json'))) return;
    throw new Error(`${tool}: ${error.stdout}${error.stderr}`);
  }
}
