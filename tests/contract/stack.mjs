// SPDX-License-Identifier: Apache-2.0
// A real mosquitto, the real service and simulated robots, started for the suite and ended with it.
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import net from 'node:net';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

import { ask } from './http.mjs';

export const repository = fileURLToPath(new URL('../..', import.meta.url));
const program = process.env.KIDNAPWATCH ??
  path.join(repository, 'build/release/service/kidnapwatch');

export async function freePort() {
  const server = net.createServer().listen(0, '127.0.0.1');
  await new Promise((done) => server.once('listening', done));
  const { port } = server.address();
  await new Promise((done) => server.close(done));
  return port;
}

/// Looks every 50 ms until `holds` gives something true, and gives that; throws after `patience_s`.
export async function eventually(what, holds, patience_s = 60) {
  const end = Date.now() + patience_s * 1000;
  while (true) {
    const found = await holds();
    if (found) return found;
    if (Date.now() > end) throw new Error(`not within ${patience_s} s: ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

export class Stack {
  folder = fs.mkdtempSync(path.join(os.tmpdir(), 'kidnapwatch-contract-'));
  children = [];
  tokensFile = path.join(this.folder, 'tokens.json');
  tokens = {};
  tokenIds = {};

  /// Starts a program that goes on until stop(); what it says is kept in NAME.log.
  start(name, file, args, options = {}) {
    const log = fs.openSync(path.join(this.folder, `${name}.log`), 'a');
    const child = spawn(file, args, { stdio: ['ignore', log, log], ...options });
    child.on('error', (error) => fs.writeSync(log, `${error}\n`));
    this.children.push(child);
    return child;
  }

  log(name) {
    return fs.readFileSync(path.join(this.folder, `${name}.log`), 'utf8');
  }

  stop() {
    for (const child of this.children.reverse()) child.kill('SIGTERM');
  }

  async startBroker() {
    this.broker = await freePort();
    const config = path.join(this.folder, 'mosquitto.conf');
    fs.writeFileSync(config, `listener ${this.broker} 127.0.0.1\nallow_anonymous true\n` +
      'set_tcp_nodelay true\nmax_queued_messages 100000\nmax_inflight_messages 0\n');
    const file = fs.existsSync('/usr/sbin/mosquitto') ? '/usr/sbin/mosquitto' : 'mosquitto';
    this.start('mosquitto', file, ['-c', config]);
    await eventually('the broker listens', () => new Promise((done) => {
      const socket = net.connect(this.broker, '127.0.0.1', () => done(socket.end() && true));
      socket.on('error', () => done(false));
    }));
  }

  /// A service of that name, with its own store; the port of its REST. All need tokens.
  async startService(name, flags) {
    this.start(name, program, ['serve', '--http-port', '0', '--http-auth', 'tokens',
      '--http-tokens-file', this.tokensFile,
      '--store-file', path.join(this.folder, `${name}.db`), '--mqtt-client-id', name, ...flags]);
    const port = await eventually(`${name} serves`,
      () => /serves http:\/\/[^,]*:(\d+),/.exec(this.log(name))?.[1]);
    return Number(port);
  }

  token(name, role, robots = []) {
    const made = spawnSync(program, ['token', 'create', '--name', name, '--role', role,
      ...robots.flatMap((robot) => ['--robot', robot]), '--http-tokens-file', this.tokensFile],
      { encoding: 'utf8' });
    this.tokens[name] = made.stdout.trim();
    this.tokenIds[name] = /token (\w+) was created/.exec(made.stderr)[1];
  }

  revoke(name) {
    execFileSync(program, ['token', 'revoke', this.tokenIds[name], '--http-tokens-file',
      this.tokensFile], { stdio: 'ignore' });
  }

  /// To its end: `kidnapwatch` with these words, and the broker's address.
  robots(...words) {
    return JSON.parse(execFileSync(program, [...words, '--broker', `mqtt://127.0.0.1:${this.broker}`],
      { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }));
  }

  /// The JSON that the service answers to a GET by the administrator.
  async get(target) {
    const answer = await ask({ port: this.rest, path: target, headers: this.as('admin') });
    return JSON.parse(answer.body);
  }

  as(name) {
    return { Authorization: `Bearer ${this.tokens[name]}` };
  }

  /// Everything that the checks stand on: `rest` is the port of a service with robots and incidents,
  /// `hasty` of one that has no broker and takes one request a second.
  async begin() {
    await this.startBroker();
    for (const role of ['viewer', 'operator', 'admin']) this.token(role, role);
    this.token('one-robots', 'viewer', ['sim-0001']);
    const url = `mqtt://127.0.0.1:${this.broker}`;
    this.rest = await this.startService('service',
      ['--mqtt-url', url, '--mqtt-scores-per-s', '10', '--http-rate-limit-per-s', '0']);
    this.hasty = await this.startService('hasty', ['--mqtt-url',
      `mqtt://127.0.0.1:${await freePort()}`, '--http-rate-limit-per-s', '1']);
    await eventually('the service is ready', async () =>
      (await ask({ port: this.rest, path: '/readyz' })).status === 200);
    this.robots('simulate', '--robots', '3', '--rate', '5', '--duration', '150',
      '--kidnap-every', '40', '--speed', '10');
    await eventually('incidents, some of them resolved', async () => {
      const states = (await this.get('/api/v1/incidents')).incidents.map((one) => one.state);
      return states.length >= 5 && states.includes('resolved') && states.includes('open');
    });
  }
}
