// SPDX-License-Identifier: Apache-2.0
// What people do about incidents: who may, when, and the questions it takes.
import { ask } from './ask';
import { count, h, type Child } from './dom';
import { at, send, type Alert, type Incident, type IncidentLabel, type Stamp } from './rest';
import { can } from './session';

export interface Action {
  name: 'ack' | 'unack' | 'resolve' | 'shelve' | 'label';
  key: string;
  says: string;
  done: string;
  /** Whether the incident's state allows it. */
  fits: (incident: Incident) => boolean;
  /** The body to send; null where the person thought better of it. */
  body: (incidents: Incident[]) => Promise<object | null>;
}

export const ACTIONS: Action[] = [
  { name: 'ack', key: 'a', says: 'Acknowledge', done: 'Acknowledged',
    fits: ({ state }) => state === 'open', body: async () => ({}) },
  { name: 'unack', key: 'u', says: 'Unacknowledge', done: 'Open again',
    fits: ({ state }) => state === 'acknowledged', body: async () => ({}) },
  { name: 'resolve', key: 'r', says: 'Resolve', done: 'Resolved',
    fits: ({ state }) => state !== 'resolved', body: askToResolve },
  { name: 'shelve', key: 's', says: 'Shelve', done: 'Shelved',
    fits: ({ state }) => state !== 'resolved', body: askHowLong },
  { name: 'label', key: 'l', says: 'Label', done: 'Labelled', fits: () => true, body: askForLabel },
];

export function mayCare(): boolean {
  return can('operator');
}

export function isShelved(incident: Incident, now_ms = Date.now()): boolean {
  return incident.state !== 'resolved' && incident.shelvedUntil !== undefined &&
    Date.parse(incident.shelvedUntil) > now_ms;
}

/** The incidents as they are then; none where the person thought better of it. Throws Problem. */
export async function perform(action: Action, incidents: Incident[]): Promise<Incident[]> {
  const fitting = incidents.filter(action.fits);
  const body = fitting.length > 0 ? await action.body(fitting) : null;
  const changed: Incident[] = [];
  for (const { id } of body === null ? [] : fitting) {
    changed.push(await send<Incident>('POST', at('/api/v1/incidents', id, action.name), body));
  }
  return changed;
}

/** "agv-1", or "3 incidents". */
export function named(incidents: Incident[]): string {
  return incidents.length === 1 ? incidents[0]!.robotId : `${count(incidents.length)} incidents`;
}

function commentField(incidents: Incident[]): Child {
  const text = incidents.length === 1 ? (incidents[0]!.comment ?? '') : '';
  return h('p', { class: 'field' }, h('label', { for: 'comment' }, 'Comment (optional)'),
    h('textarea', { id: 'comment', name: 'comment', maxlength: 2000, rows: 3 }, text));
}

function withComment(body: object, form: FormData): object {
  const comment = String(form.get('comment') ?? '').trim();
  return comment === '' ? body : { ...body, comment };
}

function choices(name: string, legend: string, options: [string, string][], chosen?: string): Child {
  return h('fieldset', {}, h('legend', {}, legend), options.map(([value, text], i) =>
    h('label', { class: 'choice' },
      h('input', { type: 'radio', name, value, required: true,
        checked: value === chosen, autofocus: chosen ? value === chosen : i === 0 }), ' ', text)));
}

async function askToResolve(incidents: Incident[]): Promise<object | null> {
  const form = await ask(`Resolve ${named(incidents)}?`, 'Resolve',
    h('p', {}, 'The robot knows where it is again. A resolved incident stays resolved: the next ' +
      'kidnapping is another.'),
    commentField(incidents));
  return form && withComment({}, form);
}

const SHELVING: [string, string][] = [
  ['900', '15 minutes'], ['3600', '1 hour'], ['28800', '8 hours'], ['custom', 'Other'],
];

async function askHowLong(incidents: Incident[]): Promise<object | null> {
  const minutes = h('input', { type: 'number', name: 'minutes', min: 1, max: 10080, value: 30,
    'aria-label': 'Minutes' });
  const hours = h('span', { class: 'row custom' }, minutes, 'minutes, a week at most');
  const options = incidents.some((incident) => isShelved(incident))
    ? [...SHELVING, ['0', 'No longer: call somebody again'] as [string, string]] : SHELVING;
  const form = await ask(`Shelve ${named(incidents)}`, 'Shelve',
    h('p', {}, 'Its alerts call nobody until then. It goes on otherwise.'),
    choices('seconds', 'For', options, '900'), hours, commentField(incidents));
  if (!form) return null;
  const chosen = form.get('seconds');
  const seconds = chosen === 'custom' ? 60 * Number(form.get('minutes')) : Number(chosen);
  return withComment({ seconds }, form);
}

export const LABELS: IncidentLabel[] = ['kidnapping', 'false_alarm', 'test'];
const MEANS: Record<IncidentLabel, string> = {
  kidnapping: 'Kidnapping: the robot was moved',
  false_alarm: 'False alarm: it was where it believed to be',
  test: 'Test: somebody tried it out',
};

async function askForLabel(incidents: Incident[]): Promise<object | null> {
  const label = incidents.length === 1 ? incidents[0]!.label : undefined;
  const form = await ask(`${named(incidents)}: what was it?`, 'Label',
    choices('label', 'Label', LABELS.map((one) => [one, MEANS[one]]), label ?? 'kidnapping'),
    commentField(incidents),
    h('p', { class: 'hint' }, 'Thresholds are judged by labels: see Tuning.'));
  return form && withComment({ label: form.get('label') }, form);
}

function iso({ sec, nanosec }: Stamp): string {
  const whole = new Date(sec * 1000).toISOString().slice(0, 19);
  return `${whole}.${String(nanosec).padStart(9, '0')}Z`;
}

/** The incident that an alert tells of. */
export function incidentOf(alert: Alert): Incident {
  const { incidentId, robotId, seq, kind, cause, state, openedAt, resolvedAt, detector } = alert;
  const { explanation, configVersion, acknowledgedBy, resolvedBy, shelvedUntil } = alert;
  return {
    id: incidentId, robotId, seq, kind, cause, state, openedAt, resolvedAt, detector, explanation,
    configVersion, acknowledgedBy, resolvedBy, shelvedUntil, label: alert.label,
    comment: alert.comment, score: alert.score ?? NaN, threshold: alert.threshold ?? NaN,
    beforeTime: iso(alert.beforeStamp), afterTime: iso(alert.afterStamp),
    scanTime: iso(alert.scanStamp),
  };
}
