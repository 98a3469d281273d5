// SPDX-License-Identifier: Apache-2.0
// Server-Sent Events, which Prism cannot pass on as they come, held to their description.
import http from 'node:http';

import { asyncapi, misfit, misfitOfAnswer, openapi, operations } from './contract.mjs';
import { ask } from './http.mjs';
import { eventually } from './stack.mjs';

const stream = ['paths', '/api/v1/events', 'get', 'responses', '200', 'content', 'text/event-stream'];

/// Follows the events until close(); as the HTML Standard reads them.
class Follower {
  events = [];
  comments = 0;
  ended = false;

  constructor(stack, user, query = '', lastId = undefined) {
    const headers = { ...stack.as(user), ...(lastId ? { 'Last-Event-ID': lastId } : {}) };
    this.request = http.get({ port: stack.rest, host: '127.0.0.1', path: `/api/v1/events${query}`, headers },
      (response) => {
        this.response = response;
        let rest = '';
        response.setEncoding('utf8').on('data', (part) => {
          const blocks = (rest + part).split('\n\n');
          rest = blocks.pop();
          blocks.forEach((block) => this.take(block));
        }).on('close', () => { this.ended = true; }).on('error', () => {});
      }).on('error', () => { this.ended = true; });
  }

  take(block) {
    const event = {};
    for (const line of block.split('\n').filter(Boolean)) {
      const [, name, value] = /^([^:]*):? ?(.*)$/.exec(line);
      if (name === '') this.comments += 1;
      else event[name] = event[name] === undefined ? value : `${event[name]}\n${value}`;
    }
    if (event.data !== undefined) this.events.push({ ...event, data: JSON.parse(event.data) });
  }

  of(kind) { return this.events.filter((one) => one.event === kind); }
  close() { this.request.destroy(); }
}

function check(follower) {
  for (const { event, id, data } of follower.events) {
    const wrong = event === 'alert' ? misfit(asyncapi, ['components', 'schemas', 'Alert'], data)
      : event === 'robots' ? misfit(openapi, [...stream, 'schema', 'x-event-data', 'robots'], data)
        : event === 'gap' ? (Number.isInteger(data.since) ? '' : 'no since') : 'is not described';
    if (wrong) throw new Error(`event ${event}: ${wrong}: ${JSON.stringify(data)}`);
    if (!/^[0-9]+$/.test(id ?? '')) throw new Error(`event ${event} with id ${id}`);
  }
}

async function label(stack, incident, name) {
  await ask({ port: stack.rest, method: 'POST', path: `/api/v1/incidents/${incident}/label`,
    headers: { 'Content-Type': 'application/json', ...stack.as('operator') },
    body: JSON.stringify({ label: name, comment: String(Math.random()) }) });
}

export async function events(stack) {
  const [incident] = (await stack.get('/api/v1/incidents')).incidents;
  const first = new Follower(stack, 'viewer');
  await eventually('all robots at first', () => first.of('robots').length);
  const robots = (await stack.get('/api/v1/robots')).robots.map((one) => one.id).sort();
  const told = first.of('robots')[0].data.robots.map((one) => one.id).sort();
  if (String(told) !== String(robots)) throw new Error(`robots ${told}, not ${robots}`);
  await label(stack, incident.id, 'test');
  await eventually('an alert', () => first.of('alert').length === 1);
  const last = first.of('alert')[0];
  first.close();

  for (const name of ['kidnapping', 'false_alarm', 'test']) await label(stack, incident.id, name);
  const again = new Follower(stack, 'viewer', `?robot=${incident.robotId}`, last.id);
  await eventually('what was missed', () => again.of('alert').length >= 3);
  const labels = again.of('alert').map((one) => one.data.label);
  const seqs = again.of('alert').map((one) => one.data.seq - last.data.seq);
  if (String(labels) !== 'kidnapping,false_alarm,test' || String(seqs) !== '1,2,3') {
    throw new Error(`missed events came as ${labels}, ${seqs}`);
  }
  if (again.of('robots').some((one) => one.data.robots.some((robot) => robot.id !== incident.robotId))) {
    throw new Error('another robot was told of');
  }
  await eventually('a comment after 15 s of silence', () => again.comments || again.ended);

  stack.token('leaver', 'viewer');
  const leaver = await eventually('a new token is known', async () => {
    const one = new Follower(stack, 'leaver');
    await eventually('an answer', () => one.response || one.ended);
    return one.response?.statusCode === 200 ? one : one.close();
  });
  stack.revoke('leaver');
  await eventually('the stream of a revoked token ends', () => leaver.ended, 30);
  const busy = await eventually('too many requests', async () => {
    const answer = await ask({ port: stack.hasty, path: '/api/v1/events', headers: stack.as('viewer') });
    return answer.status === 429 && answer;
  });
  const wrong = misfitOfAnswer(operations.find((one) => one.id === 'getEvents'), busy);
  if (wrong) throw new Error(wrong);
  if (again.ended) throw new Error('a stream ended by itself');
  again.close();
  [first, again, leaver].forEach(check);
  const count = first.events.length + again.events.length + leaver.events.length;
  return `${count} events of three followers, all as described; resumed without loss; ended by revocation`;
}
