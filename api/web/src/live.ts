// SPDX-License-Identifier: Apache-2.0
// The one event stream that all pages share. Read through fetch(), because EventSource sends no token.
import { call, Problem, type Alert, type RobotUpdate } from './rest';

export type StreamState = 'off' | 'connecting' | 'live' | 'reconnecting';
type Unsubscribe = () => void;

const LONGEST_PAUSE_MS = 15_000;
const SILENT_MS = 40_000; // the service says something every 15 s at least

const alertListeners = new Set<(alert: Alert) => void>();
const robotListeners = new Set<(changed: RobotUpdate[], all: boolean) => void>();
const stateListeners = new Set<(state: StreamState) => void>();
const gapListeners = new Set<() => void>();

let fleet = new Map<string, RobotUpdate>();
let isFirst = true;
let state: StreamState = 'off';
let lastId: string | undefined;
let stopping: AbortController | undefined;

/** Every change of an incident, in order, once. */
export function onAlert(fn: (alert: Alert) => void): Unsubscribe {
  return listen(alertListeners, fn);
}

/** At once all robots that are known (`all`), then those that changed; `all` again after a reconnect. */
export function onRobots(fn: (changed: RobotUpdate[], all: boolean) => void): Unsubscribe {
  if (state !== 'off' && !isFirst) fn([...fleet.values()], true);
  return listen(robotListeners, fn);
}

/** At once, and whenever it changes. */
export function onState(fn: (state: StreamState) => void): Unsubscribe {
  fn(state);
  return listen(stateListeners, fn);
}

/** Events were missed for good: load everything anew. */
export function onGap(fn: () => void): Unsubscribe {
  return listen(gapListeners, fn);
}

/** The latest of a robot. */
export function robotNow(id: string): RobotUpdate | undefined {
  return fleet.get(id);
}

/** Reads until stop(), reconnecting for ever. */
export function start(): void {
  stop();
  stopping = new AbortController();
  void run(stopping.signal);
}

export function stop(): void {
  stopping?.abort();
  stopping = undefined;
  fleet = new Map();
  isFirst = true;
  lastId = undefined;
  become('off');
}

function listen<T>(listeners: Set<T>, fn: T): Unsubscribe {
  listeners.add(fn);
  return () => listeners.delete(fn);
}

function become(next: StreamState): void {
  if (next === state) return;
  state = next;
  stateListeners.forEach((fn) => fn(next));
}

async function run(stopped: AbortSignal): Promise<void> {
  become('connecting');
  for (let failures = 0; !stopped.aborted;) {
    try {
      await read(stopped, () => { failures = 0; });
    } catch (error) {
      if (stopped.aborted || (error instanceof Problem && error.status === 401)) break;
    }
    if (stopped.aborted) break;
    become('reconnecting');
    await pause(Math.min(LONGEST_PAUSE_MS, 500 * 2 ** failures++) * (0.5 + Math.random() / 2), stopped);
  }
  if (!stopped.aborted) become('off');
}

function pause(milliseconds: number, stopped: AbortSignal): Promise<void> {
  return new Promise((done) => {
    const timer = setTimeout(done, milliseconds);
    stopped.addEventListener('abort', () => { clearTimeout(timer); done(); }, { once: true });
  });
}

/** One connection, until it ends or says nothing for too long. */
async function read(stopped: AbortSignal, opened: () => void): Promise<void> {
  const cut = new AbortController();
  const onStop = () => cut.abort();
  stopped.addEventListener('abort', onStop, { once: true });
  let silence = setTimeout(onStop, SILENT_MS);
  try {
    const headers: Record<string, string> = { Accept: 'text/event-stream' };
    if (lastId !== undefined) headers['Last-Event-ID'] = lastId;
    const response = await call('/api/v1/events', { headers, signal: cut.signal, cache: 'no-store' });
    opened();
    const mayHaveMissed = state === 'reconnecting' && lastId === undefined; // it starts anew, not where it was
    isFirst = true;
    become('live');
    if (mayHaveMissed) gapListeners.forEach((fn) => fn());
    const parser = new EventParser(dispatch);
    const reader = response.body!.pipeThrough(new TextDecoderStream()).getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      clearTimeout(silence);
      silence = setTimeout(onStop, SILENT_MS);
      parser.push(value);
    }
  } finally {
    clearTimeout(silence);
    stopped.removeEventListener('abort', onStop);
    cut.abort();
  }
}

export interface ServerEvent {
  type: string;
  data: string;
  id?: string;
}

/** The text/event-stream format (HTML, section 9.2.6), fed piece by piece. */
export class EventParser {
  private rest = '';
  private event: ServerEvent = { type: 'message', data: '' };
  private hasData = false;

  constructor(private readonly emit: (event: ServerEvent) => void) {}

  push(text: string): void {
    const lines = (this.rest + text).split('\n');
    this.rest = lines.pop()!;
    lines.forEach((line) => this.line(line.endsWith('\r') ? line.slice(0, -1) : line));
  }

  private line(line: string): void {
    if (line === '') {
      if (this.hasData) this.emit(this.event);
      this.event = { type: 'message', data: '' };
      this.hasData = false;
      return;
    }
    const colon = line.indexOf(':');
    if (colon === 0) return; // a comment: the connection is alive
    const field = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? '' : line.slice(colon + 1).replace(/^ /, '');
    if (field === 'event') this.event.type = value;
    else if (field === 'id') this.event.id = value;
    else if (field === 'data') {
      this.event.data += (this.hasData ? '\n' : '') + value;
      this.hasData = true;
    }
  }
}

function dispatch({ type, data, id }: ServerEvent): void {
  if (id !== undefined) lastId = id;
  if (type === 'alert') {
    const alert = JSON.parse(data) as Alert;
    alertListeners.forEach((fn) => fn(alert));
  } else if (type === 'robots') {
    const { robots } = JSON.parse(data) as { robots: RobotUpdate[] };
    take(robots);
  } else if (type === 'gap') {
    gapListeners.forEach((fn) => fn());
  }
}

function take(robots: RobotUpdate[]): void {
  const all = isFirst; // each connection begins with the whole fleet
  isFirst = false;
  if (all) fleet = new Map();
  robots.forEach((robot) => fleet.set(robot.id, robot));
  robotListeners.forEach((fn) => fn(robots, all));
}
