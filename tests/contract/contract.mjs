// SPDX-License-Identifier: Apache-2.0
// openapi.yaml and asyncapi.yaml: their operations, and what of a value does not fit a schema.
import fs from 'node:fs';
import path from 'node:path';

import Ajv2020 from 'ajv/dist/2020.js';
import addFormats from 'ajv-formats';
import YAML from 'yaml';

import { repository } from './stack.mjs';

const read = (name) =>
  YAML.parse(fs.readFileSync(path.join(repository, 'api', name), 'utf8'), { merge: true });
export const openapi = read('openapi.yaml');
export const asyncapi = read('asyncapi.yaml');

const ajv = new Ajv2020.default({ strict: false, allErrors: false });
addFormats.default(ajv);
ajv.addSchema(openapi, 'openapi');
ajv.addSchema({ components: asyncapi.components }, 'asyncapi');

const escaped = (name) => encodeURIComponent(String(name).replaceAll('~', '~0').replaceAll('/', '~1'));

/// What of the value does not fit the schema at this path of the document; empty if all does.
export function misfit(document, pointer, value) {
  const name = document === openapi ? 'openapi' : 'asyncapi';
  const reference = `${name}#/${pointer.map(escaped).join('/')}`;
  const validate = ajv.getSchema(reference) ?? ajv.compile({ $ref: reference });
  return validate(value) ? '' : ajv.errorsText(validate.errors, { dataVar: 'it' });
}

/// [what `$ref` points to, its path]; or as given.
export function resolved(document, pointer) {
  const value = pointer.reduce((at, key) => at[key], document);
  if (!value?.$ref) return [value, pointer];
  return resolved(document, value.$ref.slice(2).split('/').map((key) =>
    key.replaceAll('~1', '/').replaceAll('~0', '~')));
}

const methods = ['get', 'put', 'post', 'patch', 'delete'];

/// Every operation: {id, method, path, pattern, parameters, bodies: {type: pointer}, responses}.
export const operations = Object.entries(openapi.paths).flatMap(([target, item]) =>
  methods.filter((method) => item[method]).map((method) => {
    const at = ['paths', target, method];
    const operation = item[method];
    const parametersOf = (where, list) => (list ?? []).map((_, i) =>
      resolved(openapi, [...where, 'parameters', i])).map(([parameter, pointer]) =>
      ({ ...parameter, pointer: [...pointer, 'schema'] }));
    const bodies = Object.keys(operation.requestBody?.content ?? {}).map((type) =>
      [type, [...at, 'requestBody', 'content', type, 'schema']]);
    return {
      id: operation.operationId,
      method: method.toUpperCase(),
      path: target,
      pattern: new RegExp(`^${target.replaceAll('.', '\\.').replace(/\{[^}]*\}/g, '[^/]+')}$`),
      parameters: [...parametersOf(['paths', target], item.parameters),
        ...parametersOf(at, operation.parameters)],
      bodies: Object.fromEntries(bodies),
      bodyRequired: operation.requestBody?.required ?? false,
      open: operation.security?.length === 0,
      responses: Object.fromEntries(Object.keys(operation.responses).map((status) =>
        [status, resolved(openapi, [...at, 'responses', status])])),
    };
  }));

const problem = ['components', 'schemas', 'Problem'];

export function misfitOfProblem(answer) {
  if (answer.type !== 'application/problem+json') return `${answer.type} is no problem`;
  const wrong = misfit(openapi, problem, JSON.parse(answer.body));
  return wrong || (JSON.parse(answer.body).status === answer.status ? '' : 'names another status');
}

/// What of an answer is not as the operation's description says; empty if all is.
export function misfitOfAnswer(operation, answer, isHead = false) {
  if (!operation.responses[answer.status]) return `status ${answer.status} is not declared`;
  const [response, pointer] = operation.responses[answer.status];
  for (const [name, value] of Object.entries(answer.headers)) {
    const declared = Object.keys(response.headers ?? {}).find((one) => one.toLowerCase() === name);
    if (!declared) continue;
    const [header, at] = resolved(openapi, [...pointer, 'headers', declared]);
    const said = header.schema.type === 'integer' ? Number(value) : value;
    const wrong = misfit(openapi, [...at, 'schema'], said);
    if (wrong) return `header ${name}: ${wrong}`;
  }
  if (isHead || !response.content) return answer.body === '' ? '' : 'has a body';
  if (!response.content[answer.type]) return `content type ${answer.type} is not declared`;
  if (answer.type === 'application/problem+json') return misfitOfProblem(answer);
  if (answer.type !== 'application/json') return '';
  return misfit(openapi, [...pointer, 'content', answer.type, 'schema'], JSON.parse(answer.body));
}
