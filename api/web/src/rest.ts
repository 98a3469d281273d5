// SPDX-License-Identifier: Apache-2.0
// The REST API: its types (api/openapi.yaml spells them), and calls of it.

export type RobotState = 'unknown' | 'normal' | 'suspect' | 'kidnapped' | 'degraded' | 'stale';
export type IncidentState = 'open' | 'acknowledged' | 'resolved';
export type IncidentKind = 'teleport' | 'carry';
export type IncidentLabel = 'kidnapping' | 'false_alarm' | 'test';
export type Cause = 'teleport' | 'carry' | 'displaced' | 'slip';
export type Trouble = 'blind' | 'odometry' | 'noise' | 'crowd';
export type Role = 'viewer' | 'operator' | 'admin';
export type Detector = 'motion_consistency' | 'qs2ddtw';
export type Counts = Record<string, number>;

export interface Me {
  name: string;
  role: Role;
  robots?: string[];
}

export interface Pose {
  x: number;
  y: number;
  theta: number;
}

export interface Stamp {
  sec: number;
  nanosec: number;
}

export interface MotionScore {
  score: number;
  confirmed?: number;
  threshold?: number;
  carry: number;
}

export interface Score {
  time: string;
  referenceTime: string;
  score: number;
  scorePerBeam: number;
  standardized: boolean;
  threshold?: number;
  motion?: MotionScore;
  state: RobotState;
  detectors?: Record<string, number>;
}

export interface Spread {
  min: number;
  max: number;
  mean: number;
}

export interface ScoreBucket {
  time: string;
  seconds: number;
  scores: number;
  score?: Spread;
  scorePerBeam?: Spread;
  motion?: Spread;
  motionConfirmed?: Spread;
  carry?: Spread;
  threshold?: number;
  motionThreshold?: number;
  state: RobotState;
}

export interface Robot {
  id: string;
  state: RobotState;
  trouble?: Trouble;
  explanation?: string;
  lastScanAt: string;
  incidentId?: string;
  threshold?: number;
  motionThreshold?: number;
  ownMotionThreshold?: number;
  calibration: { pairs: number; needed: number };
  lastScore?: Score;
  scans: Counts;
}

/** What the event stream tells of a robot: all of it each time. */
export interface RobotUpdate {
  id: string;
  state: RobotState;
  lastScanAt: string;
  trouble?: Trouble;
  incidentId?: string;
  score?: number;
  threshold?: number;
  motion?: number;
  motionConfirmed?: number;
  motionThreshold?: number;
}

interface Care {
  acknowledgedBy?: string;
  resolvedBy?: string;
  shelvedUntil?: string;
  label?: IncidentLabel;
  comment?: string;
}

export interface Incident extends Care {
  id: string;
  robotId: string;
  seq: number;
  kind: IncidentKind;
  cause: Cause;
  state: IncidentState;
  openedAt: string;
  resolvedAt?: string;
  beforeTime: string;
  afterTime: string;
  scanTime: string;
  detector: string;
  score: number;
  threshold: number;
  explanation: string;
  configVersion: number;
}

/** A change of an incident, as on MQTT. */
export interface Alert extends Care {
  schema: string;
  eventId: string;
  incidentId: string;
  seq: number;
  type: 'opened' | 'updated' | 'acknowledged' | 'unacknowledged' | 'shelved' | 'resolved' | 'labelled';
  kind: IncidentKind;
  cause: Cause;
  robotId: string;
  state: IncidentState;
  severity: 'critical' | 'info';
  timestamp: string;
  openedAt: string;
  resolvedAt?: string;
  scanStamp: Stamp;
  beforeStamp: Stamp;
  afterStamp: Stamp;
  detector: string;
  score?: number;
  threshold?: number;
  explanation: string;
  configVersion: number;
}

export interface LaserScan {
  header: { stamp: Stamp; frame_id: string };
  angle_min: number;
  angle_max: number;
  angle_increment: number;
  range_min: number;
  range_max: number;
  ranges: (number | null)[];
  odom?: Pose;
}

export interface Evidence {
  before: LaserScan;
  after: LaserScan;
  scores: Score[];
  /** The paper's path between both scans: [beam before, beam after, cost] of each step. */
  warping?: { cost: number; standardized: boolean; steps: [number, number, number][] };
  motion?: {
    seen: Pose;
    told?: Pose;
    violating: { before: number[]; after: number[] };
  };
}

export interface IncidentChange {
  time: string;
  author: string;
  action: string;
  seq: number;
  state: IncidentState;
  shelvedUntil?: string;
  label?: IncidentLabel;
  comment?: string;
}

export interface DetectionConfig {
  alarm?: 'motion_consistency' | 'qs2ddtw' | 'either' | 'both';
  dissimilarity?: Record<string, string | number>;
  motion?: { threshold_min?: number; sensor?: { x_m?: number; y_m?: number; theta_rad?: number } };
  calibration?: { false_alarm_rate?: number; warmup_pairs?: number; window_pairs?: number };
  threshold?: number | null;
  detectors?: string[];
  stale_after_s?: number;
  resolve_after_s?: number;
  resync_scans?: number;
}

export interface ConfigLevel {
  robotId?: string;
  version: number;
  since: string;
  author: string;
  values: DetectionConfig;
  effective: DetectionConfig;
  origins: Record<string, 'default' | 'fleet' | 'robot'>;
}

export interface ConfigChange {
  version: number;
  since: string;
  author: string;
  robotId?: string;
  values: DetectionConfig;
}

export interface ThresholdPreview {
  detector: Detector;
  threshold: number;
  scores: number;
  observedHours: number;
  kept: number;
  lost: number;
  raised: number;
  falseAlarmsPerDay: { now: number; then: number };
  lostIncidents: Incident[];
  raisedIncidents: { robotId: string; time: string; score: number }[];
  values: DetectionConfig;
}

export interface Calibration {
  detector: Detector;
  falseAlarmRate: number;
  threshold: number;
  scores: number;
  observedHours: number;
  above: number;
  abovePerDay: number;
  values: DetectionConfig;
}

export interface Rate {
  count: number;
  rate: number;
  low: number;
  high: number;
}

export interface LabelledRoc {
  detector: Detector;
  kidnappings: number;
  falseAlarms: number;
  area: { value: number; low: number; high: number };
  points: { threshold?: number; falseAlarms: number; found: number }[];
  suggestion?: { threshold: number; found: Rate; falseAlarms: Rate; values: DetectionConfig };
}

export interface Service {
  version: string;
  startedAt: string;
  robots: number;
  brokerConnected: boolean;
  storeHealthy: boolean;
  queuedScans: number;
  queuedWrites: number;
  lostWrites: number;
  storeBytes: number;
  degraded: { name: string; what: string }[];
  scans: Counts;
  commands: Counts;
}

/** What went wrong: RFC 9457, or status 0 where the service does not answer. */
export class Problem extends Error {
  constructor(readonly status: number, readonly detail: string, readonly field?: string) {
    super(detail);
  }
}

export const ME = '/api/v1/me';
const TOKEN = 'kidnapwatch.token';
let refused: () => void = () => undefined;

/** Called when the service asks for a token, or for another one; but for ME, whose caller knows. */
export function onUnauthorized(act: () => void): void {
  refused = act;
}

export function token(): string | null {
  return sessionStorage.getItem(TOKEN);
}

export function keepToken(secret: string | null): void {
  if (secret) sessionStorage.setItem(TOKEN, secret);
  else sessionStorage.removeItem(TOKEN);
}

let ahead_ms = 0; // how far this machine's clock is ahead of the service's

/** The service's time, in milliseconds since 1970: this machine's clock may be wrong. */
export function serviceNow(): number {
  return Date.now() - ahead_ms;
}

/** From the Date header, which tells whole seconds. */
function setClock(response: Response): void {
  const date = Date.parse(response.headers.get('Date') ?? '');
  const ahead = Date.now() - date;
  if (!Number.isNaN(date)) ahead_ms = Math.abs(ahead - 500) < 1500 ? 0 : ahead - 500;
}

/** fetch() with the token. Throws Problem for anything but 2xx (AbortError where aborted). */
export async function call(path: string, options: RequestInit = {}): Promise<Response> {
  const headers = new Headers(options.headers);
  const secret = token();
  if (secret) headers.set('Authorization', `Bearer ${secret}`);
  let response: Response;
  try {
    response = await fetch(path, { ...options, headers });
  } catch (error) {
    if (options.signal?.aborted) throw error;
    throw new Problem(0, 'The service does not answer.');
  }
  setClock(response);
  if (response.ok) return response;
  const problem = await problemOf(response);
  if (response.status === 401 && path !== ME) refused();
  throw problem;
}

async function problemOf(response: Response): Promise<Problem> {
  try {
    const { detail, field } = await response.json() as { detail?: string; field?: string };
    return new Problem(response.status, detail ?? response.statusText, field);
  } catch {
    return new Problem(response.status, response.statusText);
  }
}

export async function get<T>(path: string, signal?: AbortSignal): Promise<T> {
  return await (await call(path, { signal, headers: { Accept: 'application/json' } })).json() as T;
}

/** All pages of a list, up to `most` items: follows `next`. */
export async function getAll<T>(path: string, member: string, most = 10_000, signal?: AbortSignal): Promise<T[]> {
  const all: T[] = [];
  for (let next: string | undefined = path; next && all.length < most;) {
    const page: Record<string, unknown> = await get(next, signal);
    all.push(...page[member] as T[]);
    next = page['next'] as string | undefined;
  }
  return all;
}

/** POST, PUT, PATCH, DELETE; the answer's JSON. */
export async function send<T>(method: string, path: string, body?: unknown,
  headers: Record<string, string> = {}): Promise<T> {
  const response = await call(path, {
    method,
    headers: { 'Content-Type': 'application/json', Accept: 'application/json', ...headers },
    body: body === undefined ? undefined : JSON.stringify(body),
  });
  return await response.json() as T;
}

/** A path with its segments and parameters encoded: at('/api/v1/robots', id, 'scores', {from}). */
export function at(base: string, ...parts: (string | Record<string, string | number | undefined>)[]): string {
  let path = base;
  const query = new URLSearchParams();
  for (const part of parts) {
    if (typeof part === 'string') path += `/${encodeURIComponent(part)}`;
    else for (const [name, value] of Object.entries(part)) if (value !== undefined) query.set(name, String(value));
  }
  const text = query.toString();
  return text ? `${path}?${text}` : path;
}
