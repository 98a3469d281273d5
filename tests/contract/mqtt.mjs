// SPDX-License-Identifier: Apache-2.0
// Every topic of asyncapi.yaml by other people's clients, mqtt.js and mosquitto's, on 3.1.1 and 5.
import { execFileSync } from 'node:child_process';

import mqtt from 'mqtt';

import { asyncapi, misfit, resolved } from './contract.mjs';
import { eventually } from './stack.mjs';

const prefix = 'kidnapwatch/v1';
const robot = 'contract-1';
const versions = { '3.1.1': { library: 4, mosquitto: '311' }, 5: { library: 5, mosquitto: '5' } };

const channels = Object.entries(asyncapi.channels).map(([name, channel]) => ({
  name,
  pattern: new RegExp(`^${channel.address.replace('{prefix}', prefix).replace('{robot}', '[^/]+')}$`),
  topic: channel.address.replace('{prefix}', prefix).replace('{robot}', robot),
  operation: Object.values(asyncapi.operations).find((one) => one.channel.$ref === `#/channels/${name}`),
  messages: Object.keys(channel.messages),
}));
const sent = channels.filter((one) => one.operation.action === 'send');

/// What of a message of the service is not as its channel says. `properties` are those of MQTT 5, or
/// absent with 3.1.1.
function misfitOf(topic, payload, { qos, retain, properties, isFresh }) {
  const channel = sent.find((one) => one.pattern.test(topic));
  if (!channel) return 'no such topic';
  const [, pointer] = resolved(asyncapi, ['components', 'messages', channel.messages[0]]);
  const binding = channel.operation.bindings.mqtt;
  const text = JSON.parse(payload);
  const wrong = misfit(asyncapi, [...pointer, 'payload'], text);
  if (wrong) return wrong;
  if (qos !== undefined && qos !== binding.qos) return `QoS ${qos}`;
  if (isFresh === false && retain !== binding.retain) return `retained: ${retain}`;
  if (!properties) return '';
  if (properties.contentType !== 'application/json') return `content type ${properties.contentType}`;
  const headers = misfit(asyncapi, [...pointer, 'headers'], properties.userProperties ?? {});
  if (headers) return `user properties: ${headers}`;
  const left = properties.messageExpiryInterval;
  const most = binding.messageExpiryInterval;
  return (left === undefined) === (most === undefined) && !(left > most) ? '' : `expiry ${left}`;
}

/// Examples of what a robot sends, by channel: [payload, content type].
function examples(channel) {
  return channel.messages.flatMap((name) => {
    const message = asyncapi.components.messages[name];
    return message.contentType === 'application/json'
      ? message.examples.map((one) => [JSON.stringify(one.payload), message.contentType]) : [];
  });
}

/// {...} of nothing but a few kinds, as CBOR: what the example of a scan needs.
function cbor(value) {
  const head = (major, n) => n < 24 ? Buffer.from([major << 5 | n])
    : n < 65536 ? Buffer.from([major << 5 | 25, n >> 8, n & 255])
      : Buffer.from([major << 5 | 26, ...new Uint8Array(new Uint32Array([n]).buffer).reverse()]);
  if (value === null) return Buffer.from([0xf6]);
  if (typeof value === 'string') return Buffer.concat([head(3, Buffer.byteLength(value)), Buffer.from(value)]);
  if (Number.isInteger(value)) return head(0, value);
  if (typeof value === 'number') {
    const bytes = Buffer.alloc(9, 0xfb);
    bytes.writeDoubleBE(value, 1);
    return bytes;
  }
  if (Array.isArray(value)) return Buffer.concat([head(4, value.length), ...value.map(cbor)]);
  const entries = Object.entries(value);
  return Buffer.concat([head(5, entries.length), ...entries.flatMap((pair) => pair.map(cbor))]);
}

class Heard {
  seen = new Map();  // how many of each channel
  wrong = [];

  take(version, topic, payload, details) {
    const name = sent.find((one) => one.pattern.test(topic))?.name;
    const own = channels.some((one) => one.operation.action === 'receive' && one.pattern.test(topic));
    if (own || !topic.startsWith(`${prefix}/`)) return;
    const wrong = misfitOf(topic, payload, details);
    if (wrong) this.wrong.push(`${version} ${topic}: ${wrong}: ${payload}`);
    const key = `${version} ${name}`;
    this.seen.set(key, (this.seen.get(key) ?? 0) + 1);
  }

  lacks(version) {
    // With 3.1.1 a command is answered by no more than the alert.
    return sent.map((one) => one.name).filter((name) => !this.seen.has(`${version} ${name}`) &&
      !(name === 'response' && version.includes('3.1.1')));
  }
}

async function withLibrary(stack, version, heard) {
  const client = await mqtt.connectAsync(`mqtt://127.0.0.1:${stack.broker}`,
    { protocolVersion: versions[version].library, clean: true });
  client.on('message', (topic, payload, packet) => heard.take(`mqtt.js ${version}`, topic, payload,
    { qos: packet.qos, properties: version === '5' ? packet.properties : undefined }));
  await client.subscribeAsync(`${prefix}/#`, { qos: 1 });
  return client;
}

function subscribeWithMosquitto(stack, version, heard) {
  const child = stack.start(`mosquitto_sub-${version}`, 'mosquitto_sub', ['-h', '127.0.0.1',
    '-p', String(stack.broker), '-V', versions[version].mosquitto, '-q', '1', '-t', `${prefix}/#`,
    '-F', '%j'], { stdio: ['ignore', 'pipe', 'ignore'] });
  let rest = '';
  child.stdout.on('data', (part) => {
    const lines = (rest + part).split('\n');
    rest = lines.pop();
    for (const line of lines) {
      const message = JSON.parse(line);
      heard.take(`mosquitto_sub ${version}`, message.topic, message.payload, { qos: message.qos });
    }
  });
  return child;
}

/// Sends what robots send on every topic by every way, and sees it counted as good.
async function speak(stack, version, client) {
  const before = await stack.get('/api/v1/service');
  const scan = asyncapi.components.messages.scanJson.examples[0].payload;
  const stamped = (i) => ({ ...scan, ranges: Array.from({ length: 360 }, (_, k) => 2 + (k % 7) / 100),
    header: { ...scan.header, stamp: { sec: Math.floor(Date.now() / 1000) + i, nanosec: 0 } } });
  const properties = (type) => version === '5' ? { properties: { contentType: type } } : {};
  const topic = (name) => channels.find((one) => one.name === name).topic;
  await client.publishAsync(topic('scan'), JSON.stringify(stamped(0)), { qos: 1, ...properties('application/json') });
  await client.publishAsync(topic('scan'), cbor(stamped(1)), { qos: 1, ...properties('application/cbor') });
  for (const channel of channels.filter((one) => ['odom', 'particles'].includes(one.name))) {
    for (const [payload, type] of examples(channel)) {
      await client.publishAsync(channel.topic, payload, { qos: 1, ...properties(type) });
      mosquittoPub(stack, version, channel.topic, payload);
    }
  }
  mosquittoPub(stack, version, topic('scan'), JSON.stringify(stamped(2)));
  await eventually('three scans are counted as good', async () => {
    const now = (await stack.get('/api/v1/service')).scans;
    const good = (counts) => counts.scored + counts.first;
    const bad = (counts) => Object.values(counts).reduce((sum, one) => sum + one, 0) - good(counts);
    if (bad(now) > bad(before.scans)) throw new Error(`refused: ${JSON.stringify(now)}`);
    return good(now) >= good(before.scans) + 3;
  });
}

function mosquittoPub(stack, version, topic, payload, ...more) {
  execFileSync('mosquitto_pub', ['-h', '127.0.0.1', '-p', String(stack.broker), '-q', '1', '-V',
    versions[version].mosquitto, '-t', topic, '-s', ...more], { input: payload });
}

/// Every example of a command, about a robot that has an open incident.
async function command(stack, version, client) {
  const [incident] = (await stack.get('/api/v1/incidents?state=open')).incidents;
  if (!incident) throw new Error('no incident is open');
  const topic = `${prefix}/${incident.robotId}/command`;
  const said = asyncapi.components.messages.command.examples.map((one) => one.payload);
  const ordered = [...said.filter((one) => one.command !== 'relocalized'),
    said.find((one) => one.command === 'relocalized')];
  const before = await commands(stack);
  for (const [i, one] of ordered.entries()) {
    const payload = JSON.stringify({ ...one, ...(one.incidentId ? { incidentId: incident.id } : {}) });
    const properties = version === '5' ? { properties: { contentType: 'application/json',
      responseTopic: `${prefix}/${incident.robotId}/response`, correlationData: Buffer.from(`${i}`) } } : {};
    if (i % 2) mosquittoPub(stack, version, topic, payload, ...(version === '5'
      ? ['-D', 'publish', 'response-topic', `${prefix}/${incident.robotId}/response`] : []));
    else await client.publishAsync(topic, payload, { qos: 1, ...properties });
    await eventually(`${payload} is carried out`, async () =>
      (await commands(stack)).done === before.done + i + 1);
  }
  const after = await stack.get(`/api/v1/incidents/${incident.id}`);
  if (after.state !== 'resolved' || after.label !== 'false_alarm') throw new Error(JSON.stringify(after));
}

const commands = async (stack) => (await stack.get('/api/v1/service')).commands;

/// What is retained comes to who subscribes late, marked as such; nothing else does.
async function retained(stack, version) {
  const client = await mqtt.connectAsync(`mqtt://127.0.0.1:${stack.broker}`,
    { protocolVersion: versions[version].library });
  const names = new Set();
  const wrong = [];
  client.on('message', (topic, payload, packet) => {
    const channel = sent.find((one) => one.pattern.test(topic));
    if (packet.retain && !channel?.operation.bindings.mqtt.retain) wrong.push(topic);
    if (packet.retain) names.add(channel?.name);
  });
  await client.subscribeAsync(`${prefix}/#`, { qos: 1 });
  const expected = sent.filter((one) => one.operation.bindings.mqtt.retain).map((one) => one.name);
  await eventually('retained messages', () => expected.every((name) => names.has(name)));
  await client.endAsync();
  if (wrong.length) throw new Error(`retained: ${wrong}`);
}

export async function everyTopic(stack) {
  const heard = new Heard();
  const clients = {};
  const children = [];
  for (const version of Object.keys(versions)) {
    clients[version] = await withLibrary(stack, version, heard);
    children.push(subscribeWithMosquitto(stack, version, heard));
  }
  for (const version of Object.keys(versions)) {
    stack.robots('simulate', '--robots', '1', '--rate', '5', '--duration', '30', '--kidnap-every',
      '25', '--speed', '10', '--name', `mqtt-${version[0]}`);
    await eventually('an incident is open', async () =>
      (await stack.get(`/api/v1/incidents?state=open&robot=mqtt-${version[0]}-0001`)).incidents.length);
    await speak(stack, version, clients[version]);
    await command(stack, version, clients[version]);
    await retained(stack, version);
  }
  const listeners = ['mqtt.js', 'mosquitto_sub'].flatMap((tool) =>
    Object.keys(versions).map((version) => `${tool} ${version}`));
  await eventually('every topic is heard', () => listeners.every((one) => !heard.lacks(one).length), 20)
    .catch(() => { throw new Error(listeners.map((one) => `${one} lacks ${heard.lacks(one)}`).join('; ')); });
  for (const client of Object.values(clients)) await client.endAsync();
  for (const child of children) child.kill();
  if (heard.wrong.length) throw new Error(heard.wrong.slice(0, 20).join('\n'));
  const count = [...heard.seen.values()].reduce((sum, one) => sum + one, 0);
  return `${channels.length} topics by ${listeners.join(', ')} and mosquitto_pub; ${count} messages, ` +
    'all as described';
}
