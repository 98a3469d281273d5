// SPDX-License-Identifier: Apache-2.0
// Random requests, right and wrong, made from openapi.yaml: what comes back must be as it says.
import { misfit, misfitOfAnswer, misfitOfProblem, openapi, operations, resolved } from './contract.mjs';
import { ask } from './http.mjs';

const inParallel = 8;

/// A seeded source of chance (mulberry32).
class Chance {
  constructor(seed) { this.state = seed >>> 0; }
  number() {
    this.state = (this.state + 0x6d2b79f5) >>> 0;
    let t = this.state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  }
  below(n) { return Math.floor(this.number() * n); }
  of(list) { return list[this.below(list.length)]; }
  is(share) { return this.number() < share; }
}

const nasty = ['', '%20', '0', '-1', 'null', 'NaN', '1e999', '9223372036854775808', '..', '.', '%00',
  '%FF', '%C3%28', '%2F', '%', '%zz', '%F0%9F%A4%96', "'%20OR%201=1--", '<script>', 'a'.repeat(300),
  '{id}', '*', '+', 'r%C3%B6bot', '2026-02-30T00:00:00Z', '2026-01-01', '0001-01-01T00:00:00Z',
  '9999-12-31T23:59:59.999999999Z', '2026-01-01T00:00:00%2B14:00', '1', 'true', '[]'];
const values = [null, true, false, 0, -1, 1e308, -1e308, 1e-320, 0.5, '', 'x', [], {}, [[]],
  { a: 1 }, 9007199254740993, 'a'.repeat(3000), '\u0000', '\ud83e\udd16'];

/// A value that fits the schema, often at its bounds.
function fitting(chance, schema, at) {
  if (schema?.$ref) return fitting(chance, ...resolved(openapi, at));
  if (schema.const !== undefined) return schema.const;
  if (schema.enum) return chance.of(schema.enum);
  const type = Array.isArray(schema.type) ? chance.of(schema.type) : schema.type;
  switch (type) {
    case 'object': return fittingObject(chance, schema, at);
    case 'array': {
      const all = Array.from({ length: chance.below(4) }, () =>
        fitting(chance, schema.items, [...at, 'items']));
      return schema.uniqueItems ? [...new Set(all)] : all;
    }
    case 'number': case 'integer': return fittingNumber(chance, schema, type);
    case 'string': return fittingText(chance, schema);
    case 'boolean': return chance.is(0.5);
    case 'null': return null;
    default: return chance.of(values);
  }
}

function fittingObject(chance, schema, at) {
  const object = {};
  for (const [name, member] of Object.entries(schema.properties ?? {})) {
    if (schema.required?.includes(name) || chance.is(0.3)) {
      object[name] = fitting(chance, member, [...at, 'properties', name]);
    }
  }
  return object;
}

function fittingNumber(chance, schema, type) {
  const step = type === 'integer' ? 1 : 1e-6;
  const low = schema.minimum ?? (schema.exclusiveMinimum ?? -1000) + step;
  const high = schema.maximum ?? (schema.exclusiveMaximum ?? low + 100_000) - step;
  const value = chance.of([low, high, low + chance.number() * (high - low),
    low + chance.number() * Math.min(100, high - low)]);
  return type === 'integer' ? Math.round(value) : value;
}

function fittingText(chance, schema) {
  if (schema.format === 'date-time') {
    const time = new Date(Date.now() - chance.below(7200_000)).toISOString();
    return chance.of([time, time.replace('Z', '+00:00'), '2020-01-01T00:00:00Z', '2100-01-01T00:00:00.5-03:30']);
  }
  if (schema.pattern === '^[0-9]{1,18}$' || schema.pattern === '^[1-9][0-9]{0,17}$') return String(1 + chance.below(1e9));
  const text = chance.of(['x', 'r1', 'robot:1', 'a b', '\u00e4\u2603', 'A'.repeat(64)]);
  return schema.pattern ? text.replace(/[^A-Za-z0-9_.:-]/g, '-') : text;
}

/// The value, spoilt in one place.
function spoilt(chance, value) {
  if (value === null || typeof value !== 'object' || chance.is(0.1)) return chance.of(values);
  const copy = structuredClone(value);
  const keys = Object.keys(copy);
  const how = chance.below(4);
  if (how === 0 || keys.length === 0) copy[chance.of(['colour', '__proto__x', '', 'Threshold'])] = 1;
  else if (how === 1) delete copy[chance.of(keys)];
  else copy[chance.of(keys)] = how === 2 ? chance.of(values) : spoilt(chance, copy[chance.of(keys)]);
  return copy;
}

const broken = ['', '{', '{"a":', '{"threshold": NaN}', '{"threshold": 1,}', '\ufeff{}', '[1,2',
  '{"a":1,"a":2}', '"text"', 'null', '{"threshold": 1e999}', '{"a":"\u0001"}', '{} {}', 'true',
  '['.repeat(20_000), '{"a":'.repeat(5_000), '{"threshold": 00}', "{'a': 1}", '\x00\x00'];

/// Whether the contract refuses this parameter's value, as it stands in the query.
function isRefused(parameter, text) {
  let value;
  try {
    value = decodeURIComponent(text);
  } catch {
    return false;  // of bytes that are no text the contract says nothing
  }
  const isNumber = parameter.schema.type === 'integer' && /^-?[0-9]+$/.test(value);
  return misfit(openapi, parameter.pointer, isNumber ? Number(value) : value) !== '';
}

/// The query; whether the contract allows it, and whether it refuses it.
function query(chance, operation) {
  const parts = [];
  let fits = true;
  let refused = false;
  for (const parameter of operation.parameters.filter((one) => one.in === 'query')) {
    if (!chance.is(0.35)) continue;
    const good = chance.is(0.75);
    fits &&= good;
    const value = good ? encodeURIComponent(fitting(chance, parameter.schema, parameter.pointer))
      : chance.of(nasty);
    parts.push(`${parameter.name}=${value}`);
    refused ||= isRefused(parameter, value);
    if (chance.is(0.02)) { parts.push(`${parameter.name}=${value}`); fits = false; refused = true; }
  }
  if (chance.is(0.05)) { parts.push(`${chance.of(['colour', 'Limit', '%FF', '__proto__'])}=1`); fits = false; refused = true; }
  return [parts.length ? `?${parts.join('&')}` : '', fits, refused];
}

/// The body, its content type, and whether the contract allows both.
function body(chance, operation) {
  const types = Object.keys(operation.bodies);
  if (types.length === 0) {
    return chance.is(0.03) ? { body: '{}', type: 'application/json' } : { fits: true };
  }
  if (!operation.bodyRequired && chance.is(0.1)) return { type: types[0], fits: true };
  const type = chance.is(0.95) ? chance.of(types)
    : chance.of(['text/plain', 'application/xml', '', 'application/jsonx', 'multipart/form-data']);
  const at = operation.bodies[types.includes(type) ? type : types[0]];
  const [schema, pointer] = resolved(openapi, at);
  const kind = chance.number();
  if (kind < 0.12) return { body: chance.of(broken), type };
  if (kind < 0.125) return { body: JSON.stringify({ comment: 'x'.repeat(66_000) }), type };
  const good = fitting(chance, schema, pointer);
  const value = kind < 0.65 ? good : spoilt(chance, good);
  const fits = types.includes(type) && misfit(openapi, at, value) === '';
  return { body: JSON.stringify(value), type, fits, refused: types.includes(type) && !fits };
}

function headers(chance, stack, operation) {
  const user = chance.is(0.85) ? 'admin' : chance.of(['viewer', 'operator', 'nobody', 'none']);
  const all = {};
  if (user === 'nobody') all.Authorization = chance.of(['Bearer x', 'Basic eDp5', 'Bearer', 'x', 'Bearer  ']);
  else if (user !== 'none') Object.assign(all, stack.as(user));
  if (chance.is(0.3)) {
    all.Accept = chance.of(['application/json', 'text/csv', '*/*', 'text/csv;q=0.1', 'x', 'image/png',
      'text/csv;q=abc, */*;q=0.5', 'text/html', 'text/event-stream']);
  }
  for (const name of ['If-Match', 'If-None-Match']) {
    if (chance.is(0.1)) all[name] = chance.of(['"1"', '*', 'W/"1"', '"0"', 'x', '"1", "2"', ',', '"']);
  }
  if (chance.is(0.03)) all['Last-Event-ID'] = chance.of(['0', '1', '5', 'x', '-1', '999999999999999999']);
  if (chance.is(0.02)) all['Accept-Encoding'] = chance.of(['gzip', 'br', 'identity;q=0', '*']);
  if (chance.is(0.003)) all['X-Long'] = 'x'.repeat(chance.of([4000, 9000, 12_000]));
  if (chance.is(0.01)) all.Expect = chance.of(['100-continue', 'x']);
  return { all, user, isPlain: user === 'admin' && !all['If-Match'] && !all['Last-Event-ID'] };
}

function target(chance, operation, things) {
  let fits = true;
  const path = operation.path.replace(/\{id\}/, () => {
    if (chance.is(0.15)) { fits = false; return chance.of(nasty); }
    return encodeURIComponent(chance.of(things(operation)));
  });
  return [path, fits];
}

function elsewhere(chance) {
  const level = () => chance.of(['api', 'v1', 'robots', 'incidents', 'config', 'history', 'evidence',
    'ack', 'metrics', 'v2', 'openapi.json', ...nasty]);
  return `/${Array.from({ length: chance.below(6) }, level).join('/')}`;
}

function made(chance, stack, things) {
  const operation = chance.of(operations);
  const [path, pathFits] = target(chance, operation, things);
  const [search, queryFits, queryRefused] = query(chance, operation);
  const content = body(chance, operation);
  const head = headers(chance, stack, operation);
  const method = chance.is(0.9) ? operation.method
    : chance.of(['GET', 'HEAD', 'POST', 'PUT', 'PATCH', 'DELETE', 'OPTIONS', 'TRACE', 'PROPFIND', 'X']);
  const request = { port: stack.rest, method,
    path: chance.is(0.07) ? elsewhere(chance) + search : path + search,
    headers: { ...head.all, ...(content.type ? { 'Content-Type': content.type } : {}) },
    body: content.body ?? (['POST', 'PUT', 'PATCH'].includes(method) ? '' : undefined), stream_ms: 20 };
  const isAsMade = request.path === path + search && method === operation.method;
  const isRight = isAsMade && pathFits && queryFits && content.fits && head.isPlain;
  return { request, isRight, isWrong: isAsMade && (content.refused || queryRefused) };
}

/// The operation that the request meets, by its path and method (HEAD is answered as GET).
function met(request) {
  const path = request.path.split('?')[0];
  const method = request.method === 'HEAD' ? 'GET' : request.method;
  const here = operations.filter((one) => one.pattern.test(path));
  return { operation: here.find((one) => one.method === method), methods: here.map((one) => one.method) };
}

/// What HTTP itself refuses, wherever it is asked: the description says so once for all operations.
const refusedByHttp = new Set([400, 408, 413, 417, 431, 505]);

/// Rules between members, which schemas do not tell: `to` and `from`, and what a patch makes of a level.
const isRule = (request, answer) =>
  request.method === 'PATCH' || /must not be before|window_pairs|warmup_pairs|bytes/.test(answer.body);

function misfitOf({ request, isRight, isWrong }, answer) {
  const { operation, methods } = met(request);
  if (answer.status >= 500 && answer.status !== 503) return 'a fault of the service';
  const isHead = request.method === 'HEAD';
  if (!operation) {
    if (isHead) return answer.body === '' ? '' : 'has a body';
    if (methods.length ? ![405, 400].includes(answer.status) : ![404, 400, 405].includes(answer.status)) {
      return refusedByHttp.has(answer.status) ? misfitOfProblem(answer) : `status ${answer.status} where nothing is`;
    }
    return misfitOfProblem(answer);
  }
  if (!operation.responses[answer.status] && refusedByHttp.has(answer.status)) {
    return isHead ? '' : misfitOfProblem(answer);
  }
  const wrong = misfitOfAnswer(operation, answer, isHead);
  if (wrong) return wrong;
  if (isWrong && answer.status < 300) return 'takes what the contract refuses';
  if (isRight && [400, 415].includes(answer.status) && !isRule(request, answer)) {
    return 'refuses what the contract allows';
  }
  return '';
}

export async function randomRequests(stack, { requests, seed }) {
  const chance = new Chance(Number(seed));
  const robots = (await stack.get('/api/v1/robots')).robots.map((one) => one.id);
  const incidents = (await stack.get('/api/v1/incidents')).incidents.map((one) => one.id);
  const things = (operation) => operation.path.startsWith('/assets') ? ['app.js', 'style.css', 'none']
    : operation.path.includes('/incidents/') ? [...incidents, 'nobody']
      : operation.path.includes('/history/') ? ['1', '2', '999999'] : [...robots, 'nobody'];
  const statuses = {};
  const wrong = [];
  let left = Number(requests);
  const one = async () => {
    while (left-- > 0 && wrong.length < 40) {
      const trial = made(chance, stack, things);
      const answer = await ask(trial.request).catch((error) => ({ error }));
      const misfit = answer.error ? String(answer.error) : misfitOf(trial, answer);
      statuses[answer.status] = (statuses[answer.status] ?? 0) + 1;
      if (misfit) wrong.push(told(trial.request, answer, misfit));
    }
  };
  await Promise.all(Array.from({ length: inParallel }, one));
  if (wrong.length) throw new Error(`seed ${seed}:\n${wrong.join('\n')}`);
  if (!(statuses[200] > requests / 10)) throw new Error('hardly a request was answered with success');
  return `${requests} requests, seed ${seed}: ${JSON.stringify(statuses)}, all as described`;
}

function told(request, answer, misfit) {
  const { method, path, headers: sent, body: content } = request;
  return `${misfit}: ${method} ${path} ${JSON.stringify({ ...sent, Authorization: undefined }).slice(0, 200)} ` +
    `${(content ?? '').slice(0, 200)} -> ${answer.status} ${answer.type} ${(answer.body ?? '').slice(0, 300)}`;
}
