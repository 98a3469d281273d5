// SPDX-License-Identifier: Apache-2.0
// A real broker, a real service with tokens, and simulated robots, in a folder of their own.
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, openSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { setTimeout as pause } from 'node:timers/promises';

const PROGRAM = process.env.KIDNAPWATCH;

/** Awaits what `ask` gives; throws with `what` after so many seconds. */
export async function eventually(what, ask, seconds = 20) {
  const until = Date.now() + 1000 * seconds;
  for (;;) {
    const found = await ask();
    if (found) return found;
    if (Date.now() > until) throw new Error(`not within ${seconds} s: ${what}`);
    await pause(50);
  }
}

async function freePort() {
  const server = createServer();
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const { port } = server.address();
  await new Promise((done) => server.close(done));
  return port;
}

export class Stack {
  folder = mkdtempSync(join(tmpdir(), 'kidnapwatch-web-'));
  tokens = {};
  #running = [];

  /** Broker, service and a token for each role. */
  static async started() {
    const stack = new Stack();
    await stack.#startBroker();
    for (const role of ['viewer', 'operator', 'admin']) stack.tokens[role] = stack.#token(role);
    await stack.#startService();
    return stack;
  }

  async stop() {
    for (const child of this.#running.reverse()) {
      if (child.exitCode === null && child.signalCode === null) {
        child.kill('SIGTERM');
        await new Promise((done) => child.once('exit', done));
      }
    }
    rmSync(this.folder, { recursive: true });
  }

  /** `kidnapwatch simulate` with these words; `done` resolves when it ends. */
  simulate(...words) {
    const child = this.#spawn('simulate', PROGRAM,
      ['simulate', '--broker', this.broker, '--rate', '5', ...words]);
    child.done = new Promise((resolve, reject) => child.once('exit', (code, signal) =>
      (code === 0 || signal ? resolve() : reject(new Error(this.log('simulate'))))));
    return child;
  }

  /** When each scan of these robots was at the broker: stamp in seconds to milliseconds since 1970. */
  scanTimes(robot) {
    const times = new Map();
    const child = this.#spawn('listen', 'mosquitto_sub', ['-h', '127.0.0.1', '-p', String(this.port),
      '-t', `kidnapwatch/v1/${robot}/scan`, '-F', '%U %p'], 'pipe');
    createInterface({ input: child.stdout }).on('line', (line) => {
      const [, at, sec, nanosec] = /^(\S+) .*?"sec":(\d+),"nanosec":(\d+)/.exec(line) ?? [];
      if (at) times.set(`${sec}.${nanosec.padStart(9, '0')}`, 1000 * Number(at));
    });
    return times;
  }

  async api(method, path, body, role = 'admin', headers = {}) {
    const answer = await fetch(this.url + path, { method,
      headers: { Authorization: `Bearer ${this.tokens[role]}`, 'Content-Type': 'application/json', ...headers },
      body: body === undefined ? undefined : JSON.stringify(body) });
    if (!answer.ok) throw new Error(`${method} ${path}: ${answer.status} ${await answer.text()}`);
    return await answer.json();
  }

  log(name) {
    return readFileSync(join(this.folder, `${name}.log`), 'utf8');
  }

  #spawn(name, program, words, stdout) {
    const log = openSync(join(this.folder, `${name}.log`), 'a');
    const child = spawn(program, words, { stdio: ['ignore', stdout ?? log, log] });
    this.#running.push(child);
    return child;
  }

  async #startBroker() {
    this.port = await freePort();
    this.broker = `mqtt://127.0.0.1:${this.port}`;
    const settings = join(this.folder, 'mosquitto.conf');
    writeFileSync(settings, [`listener ${this.port} 127.0.0.1`, 'allow_anonymous true',
      'set_tcp_nodelay true', 'max_queued_messages 100000', 'max_inflight_messages 0', ''].join('\n'));
    this.#spawn('mosquitto', 'mosquitto', ['-c', settings]);
  }

  #token(role) {
    const said = execFileSync(PROGRAM, ['token', 'create', '--name', `${role}-test`, '--role', role,
      '--http-tokens-file', join(this.folder, 'tokens.json')],
    { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
    return said.trim().split(/\s+/).at(-1);
  }

  async #startService() {
    this.#spawn('serve', PROGRAM, ['serve', '--mqtt-url', this.broker, '--http-port', '0',
      '--http-auth', 'tokens', '--http-tokens-file', join(this.folder, 'tokens.json'),
      '--http-rate-limit-per-s', '500', '--store-file', join(this.folder, 'store.db'),
      '--detection', '{"detectors":["ndt_qs"]}']);
    await eventually('the service is ready', async () => {
      this.url = /serves (http:[^,]*),/.exec(this.log('serve'))?.[1];
      return this.url && (await fetch(`${this.url}/readyz`)).status === 200;
    });
  }
}
