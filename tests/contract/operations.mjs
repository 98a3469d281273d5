// SPDX-License-Identifier: Apache-2.0
// Requests for every operation and every status that it declares, through Prism as a validating proxy.
import { operations } from './contract.mjs';
import { ask } from './http.mjs';
import { eventually, freePort, repository } from './stack.mjs';

const json = { 'Content-Type': 'application/json' };
const later = { from: '2100-01-01T00:00:00Z' };

/// What no request brings about: faults, and work of others that happens to be under way.
const unreachable = new Set(['500', 'acknowledgeIncident 503', 'unacknowledgeIncident 503',
  'resolveIncident 503', 'shelveIncident 503', 'labelIncident 503', 'previewThreshold 503',
  'calibrateThreshold 503', 'getEvents 503', 'getScans 503',
  'getEvents 429']);

/// Prism waits for a stream's end: events.mjs holds it to its description, 429 included.
const streams = new Set(['getEvents']);

/// By operation: the requests that are answered with success, in this order.
const successes = ({ robot, open, resolved, version }) => ({
  getRobots: [{}],
  getRobot: [{ id: robot }],
  getScores: [{ id: robot, query: { from: '2020-01-01T00:00:00Z', limit: 3 } },
    { id: robot, query: { resolution: 10, limit: 1000 } },
    { id: robot, headers: { Accept: 'text/csv' } }],
  getIncidents: [{}, { query: { robot, state: 'resolved', kind: 'teleport', limit: 1 } },
    { query: { label: 'false_alarm' } }, { headers: { Accept: 'text/csv' } }],
  getIncident: [{ id: open }, { id: resolved }],
  getEvidence: [{ id: open }],
  acknowledgeIncident: [{ id: open, body: { comment: 'on my way' } }, { id: open }],
  unacknowledgeIncident: [{ id: open, body: {} }],
  shelveIncident: [{ id: open, body: { seconds: 60 } }, { id: open, body: { seconds: 0 } }],
  labelIncident: [{ id: open, body: { label: 'kidnapping' } },
    { id: resolved, body: { label: 'false_alarm', comment: 'a forklift' } }],
  resolveIncident: [{ id: open, body: { comment: 'done' } }],
  getConfig: [{}],
  putConfig: [{ body: { resolve_after_s: 60 } }],
  patchConfig: [{ body: { stale_after_s: 9 } },
    { body: { stale_after_s: null }, headers: { 'Content-Type': 'application/merge-patch+json' } }],
  deleteConfig: [{}],
  getRobotConfig: [{ id: robot }],
  putRobotConfig: [{ id: robot, body: { motion: { threshold_min: 7 } } }],
  patchRobotConfig: [{ id: robot, body: { threshold: 200 } }],
  deleteRobotConfig: [{ id: robot }],
  listConfigChanges: [{}, { query: { robot, limit: 1 } }],
  restoreConfig: [{ id: version, body: {} }],
  previewThreshold: [{ body: { threshold: 6.5, robot } },
    { body: { detector: 'qs2ddtw', threshold: 100 } }],
  calibrateThreshold: [{ body: { falseAlarmRate: 0.001, robot } }],
  getRoc: [{}],
  getMe: [{}],
  getScans: [{ id: robot }],
  getIncidentHistory: [{ id: open }],
  getPage: [{}],
  getAsset: [{ id: 'app.js' }, { id: 'style.css' }, { id: 'icon.svg' }],
  getService: [{}],
  getOpenapi: [{}],
  getAsyncapi: [{}],
  getHealth: [{}],
  getReadiness: [{}],
  getMetrics: [{}],
});

/// By status: a request of the operation that is answered so; `valid` where the contract allows it.
const refusals = (operation, good) => ({
  304: () => ({ ...good, headers: { 'If-None-Match': '*' }, valid: true }),
  400: () => ({ ...good, query: { ...good.query, colour: 'red' }, valid: true }),
  401: () => ({ ...good, headers: { ...good.headers, Authorization: 'Bearer nobody' } }),
  403: () => ({ ...good, user: 'viewer', valid: true }),
  404: () => ({ ...good, ...unknown(operation, good), valid: true }),
  409: () => ({ ...good, ...inTheWay(operation, good), valid: true }),
  412: () => ({ ...good, headers: { ...good.headers, 'If-Match': '"0"' }, valid: true }),
  413: () => ({ ...good, raw: JSON.stringify({ comment: ' '.repeat(70_000) }) }),
  415: () => ({ ...good, headers: { 'Content-Type': 'text/plain' }, raw: 'x' }),
  429: () => ({ ...good, hasty: true, valid: true }),
  503: () => ({ ...good, hasty: true, valid: true }),
});

function unknown(operation, good) {
  if (operation.path.includes('{id}')) {
    return { id: operation.id === 'restoreConfig' ? 999_999 : 'nobody' };
  }
  return operation.method === 'GET' ? { query: { robot: 'nobody' }, user: 'one-robots' }
    : { body: { ...good.body, robot: 'nobody' } };
}

function inTheWay(operation, good) {
  if (operation.id === 'getRoc') return { query: later };
  return operation.id === 'calibrateThreshold' ? { body: { ...good.body, ...later } }
    : { id: good.resolved };
}

class Suite {
  asked = 0;
  covered = new Set();
  wrong = [];

  /// Through Prism: `strict` refuses requests that the contract does not allow, too.
  constructor(stack, ports) {
    this.stack = stack;
    this.ports = ports;
  }

  async ask(operation, request, expected, attempts = 10) {
    const { port, user = 'admin' } = request.hasty ? { port: this.ports.hasty }
      : { port: request.valid ? this.ports.strict : this.ports.lenient, ...request };
    const query = new URLSearchParams(request.query).toString().replaceAll('%3A', ':');
    const body = request.raw ?? (request.body && JSON.stringify(request.body));
    const answer = await ask({
      port,
      method: operation.method,
      path: operation.path.replace(/\{[^}]*\}/, request.id) + (query && `?${query}`),
      headers: { ...(Object.keys(operation.bodies).length ? json : {}),
        ...(operation.open ? {} : this.stack.as(user)), ...request.headers },
      body: body ?? (operation.method === 'POST' ? '' : undefined),
    }).catch((error) => { throw new Error(`${operation.id}, for ${expected}: ${error}`); });
    this.asked += 1;
    if (expected === 429 && answer.status !== 429 && attempts > 1) {  // a second went by
      return this.ask(operation, request, expected, attempts - 1);
    }
    this.judge(operation, request, expected, answer);
  }

  judge(operation, request, expected, answer) {
    const violations = answer.headers['sl-violations'];
    const isPrisms = answer.body.includes('stoplight.io/prism');
    if (violations || isPrisms || answer.status !== expected) {
      const told = `${operation.id} ${JSON.stringify(request).slice(0, 300)}: ${answer.status}, not ${expected}; ` +
        `${violations ?? ''} ${answer.body.slice(0, 600)}`;
      this.wrong.push(told);
    }
    this.covered.add(`${operation.id} ${answer.status}`);
  }
}

async function startPrism(stack, name, upstream, flags) {
  const port = await freePort();
  stack.start(name, process.execPath, [`${repository}/tests/contract/node_modules/.bin/prism`,
    'proxy', `${repository}/api/openapi.yaml`, `http://127.0.0.1:${upstream}`, '--errors',
    '--port', String(port), '--verboseLevel', 'warn', ...flags]);
  await eventually(`${name} passes requests on`, async () => {
    try {
      return (await ask({ port, path: '/healthz' })).status === 200;
    } catch {
      return false;
    }
  });
  return port;
}

/// Incidents to try things on; some more are labelled so that there is a curve.
async function world(stack) {
  const { incidents } = await stack.get('/api/v1/incidents');
  const open = incidents.find((one) => one.state === 'open');
  const resolved = incidents.find((one) => one.state === 'resolved');
  for (const [incident, label] of [[open, 'kidnapping'], [resolved, 'false_alarm']]) {
    await ask({ port: stack.rest, method: 'POST', path: `/api/v1/incidents/${incident.id}/label`,
      headers: { ...json, ...stack.as('operator') }, body: JSON.stringify({ label }) });
  }
  const set = await ask({ port: stack.rest, method: 'PATCH', path: '/api/v1/config',
    headers: { ...json, ...stack.as('admin') }, body: '{"resolve_after_s":0}' });
  return { robot: open.robotId, open: open.id, resolved: resolved.id,
    version: JSON.parse(set.body).version };
}

export async function operationsThroughPrism(stack) {
  const [strict, lenient, hasty] = await Promise.all([
    startPrism(stack, 'prism-strict', stack.rest, []),
    startPrism(stack, 'prism-lenient', stack.rest, ['--validate-request', 'false']),
    startPrism(stack, 'prism-hasty', stack.hasty, ['--validate-request', 'false'])]);
  const suite = new Suite(stack, { strict, lenient, hasty });
  const things = await world(stack);
  const good = successes(things);
  const missing = operations.filter((one) => !good[one.id] && !streams.has(one.id)).map((one) => one.id);
  if (missing.length) throw new Error(`no request is known for ${missing}`);
  for (const id of Object.keys(good)) {
    const operation = operations.find((one) => one.id === id);
    for (const request of good[id]) await suite.ask(operation, { ...request, valid: true }, 200);
  }
  for (const operation of operations) {
    for (const status of Object.keys(operation.responses)) {
      const name = `${operation.id} ${status}`;
      if (status === '200' || unreachable.has(status) || unreachable.has(name)) continue;
      const refusal = refusals(operation, { ...good[operation.id]?.[0], resolved: things.resolved })[status];
      if (!refusal) throw new Error(`no request is known for ${name}`);
      await suite.ask(operation, refusal(), Number(status));
    }
  }
  if (suite.wrong.length) throw new Error(suite.wrong.join('\n'));
  return `${operations.length} operations, ${suite.covered.size} answers declared and seen, ` +
    `${suite.asked} requests, no violation`;
}
