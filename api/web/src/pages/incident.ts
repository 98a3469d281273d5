// SPDX-License-Identifier: Apache-2.0
// One incident: what happened, what it was concluded from, and who did what.
import { tell } from '../ask';
import { ACTIONS, incidentOf, isShelved, mayCare, perform, type Action } from '../care';
import { button, fill, h, localTime, number, timeElement, words, type Child } from '../dom';
import { movement, scanFigure } from '../evidence/figure';
import { scorePlots } from '../evidence/scores';
import * as keys from '../keys';
import { onAlert } from '../live';
import { link, type Page } from '../page';
import { at, get, Problem, type Evidence, type Incident, type IncidentChange } from '../rest';
import { Said } from '../said';
import { badge, empty, failed, isAbort, loading, sentence } from '../states';

const SERVICE = 'kidnapwatch'; // the author of what nobody did
const DETECTORS: Record<string, string> = { motion_consistency: 'Motion consistency', qs2ddtw: 'QS-2DDTW' };

export const incident: Page = (root, { id = '' }) => {
  const stopping = new AbortController();
  const { signal } = stopping;
  const stops: (() => void)[] = [];
  const path = (...parts: string[]) => at('/api/v1/incidents', id, ...parts);
  const head = h('div', {});
  const actions = h('div', { class: 'row actions', role: 'group', 'aria-label': 'Actions' });
  const said = new Said();
  const facts = h('div', {});
  const timeline = h('ol', { class: 'timeline' });
  const picture = h('div', {});
  const plots = h('div', { class: 'score-plots' });
  let now: Incident | undefined;
  let evidence: Evidence | undefined;
  let stopEvidence: () => void = () => undefined;

  async function load(): Promise<void> {
    fill(root, loading('Loading the incident'));
    try {
      show(await get<Incident>(path(), signal));
      fill(root, head, actions, said.element, h('div', { class: 'incident-columns' },
        h('section', { class: 'card' }, h('h2', {}, 'Both scans'), picture),
        h('section', { class: 'card' }, h('h2', {}, 'Facts'), facts,
          h('h2', {}, 'Who did what'), timeline)),
      h('section', { class: 'card' }, h('h2', {}, 'What the detectors said'), plots));
      await Promise.all([loadEvidence(), loadTimeline()]);
    } catch (error) {
      if (error instanceof Problem && error.status === 404) fill(root, crumbs(), gone());
      else if (!isAbort(error)) fill(root, failed(error, () => void load()));
    }
  }

  async function loadEvidence(): Promise<void> {
    try {
      evidence = await get<Evidence>(path('evidence'), signal);
    } catch (error) {
      if (isAbort(error)) return;
      fill(picture, error instanceof Problem && error.status === 404
        ? empty('Its scans are kept no longer.') : failed(error, () => void loadEvidence()));
      return;
    }
    stopEvidence();
    const ends = [scanFigure(picture, evidence), scorePlots(plots, evidence, now!)];
    stopEvidence = () => ends.forEach((end) => end());
    show(now!);
  }

  async function loadTimeline(): Promise<void> {
    try {
      const { history } = await get<{ history: IncidentChange[] }>(path('history'), signal);
      fill(timeline, history.map((change, i) => entry(change, history[i - 1])));
    } catch (error) {
      if (!isAbort(error)) fill(timeline, h('li', {}, sentence(error)));
    }
  }

  function show(incident: Incident): void {
    if (now && now.seq > incident.seq) return;
    now = incident;
    fill(head, heading(incident));
    fill(facts, factList(incident, evidence));
    const focused = (document.activeElement as HTMLElement | null)?.dataset['action'];
    fill(actions, mayCare() && ACTIONS.filter((action) => action.fits(incident)).map((action) =>
      button([action.says, ' ', h('kbd', {}, action.key)], () => void care(action),
        { 'data-action': action.name, class: action.name === 'ack' ? 'primary' : '' })),
    button('Copy link', () => void copyLink(said), { 'data-action': 'copy' }),
    button('Download evidence', () => void download(), { 'data-action': 'download' }));
    if (focused) actions.querySelector<HTMLElement>(`[data-action=${focused}], button`)?.focus();
  }

  async function care(action: Action): Promise<void> {
    if (!now || !mayCare()) return;
    if (!action.fits(now)) {
      said.say(`Not ${action.says.toLowerCase()}d: it is ${now.state}.`);
      return;
    }
    try {
      const [changed] = await perform(action, [now]);
      if (!changed) return;
      show(changed);
      said.say(`${action.done}.`);
      void loadTimeline();
    } catch (error) {
      said.say(sentence(error));
    }
    // The button that a dialog would give the focus back to may have gone with the state.
    if (document.activeElement === document.body) {
      actions.querySelector<HTMLElement>(`[data-action=${action.name}], button`)?.focus();
    }
  }

  async function download(): Promise<void> {
    try {
      const [incident, evidence, { history }] = await Promise.all([
        get<Incident>(path()), get<Evidence>(path('evidence')),
        get<{ history: IncidentChange[] }>(path('history'))]);
      saveFile(`incident-${incident.robotId}-${id}.json`, { incident, history, evidence });
    } catch (error) {
      said.say(sentence(error));
    }
  }

  stops.push(onAlert((alert) => {
    if (alert.incidentId !== id || !now) return;
    const { afterTime } = now;
    show(incidentOf(alert));
    if (now.afterTime !== afterTime) void loadEvidence(); // it jumped again
    void loadTimeline();
  }));
  stops.push(keys.listen([
    ...(mayCare() ? ACTIONS.map((action) => (
      { keys: [action.key], says: action.says, act: () => void care(action) })) : []),
    { keys: ['b'], says: 'Back to the incidents', act: () => { location.hash = link('incidents'); } },
  ]));
  void load();
  return () => {
    stopping.abort();
    said.stop();
    stopEvidence();
    stops.forEach((stop) => stop());
  };
};

function crumbs(): HTMLElement {
  return h('span', { class: 'crumbs' }, h('a', { href: link('incidents') }, '‹ Incidents'));
}

function gone(): HTMLElement {
  return empty('There is no such incident.', 'It may be older than what is kept, or of a robot that ' +
    'this token does not show.');
}

/** What is other than before; the alert of a label is an update. */
function entry(change: IncidentChange, before?: IncidentChange): HTMLElement {
  const { time, author, action, shelvedUntil, label, comment } = change;
  const isLabelled = label !== undefined && label !== before?.label;
  const isCommented = comment !== undefined && comment !== before?.comment;
  const did = isLabelled ? ['labelled it ', words(label)]
    : action === 'shelved' && shelvedUntil ? ['shelved it until ', timeElement(shelvedUntil)]
      : action === 'updated' ? (isCommented ? 'commented' : author === SERVICE ? 'saw it jump again' : 'updated it')
        : `${words(action)} it`;
  return h('li', {}, timeElement(time), ' ', h('b', {}, author), ' ', did,
    isCommented && h('span', { class: 'detail' }, comment));
}

function heading(incident: Incident): Child {
  const { robotId, explanation, state, openedAt, cause } = incident;
  return [
    h('div', { class: 'head' }, crumbs(), badge(state),
      isShelved(incident) && h('span', { class: 'tag' }, 'shelved'),
      incident.label && h('span', { class: `tag tag-${incident.label}` }, words(incident.label)),
      h('span', { class: 'muted' }, words(cause), ', ', timeElement(openedAt))),
    h('h1', { class: 'headline' }, robotId, ': ', explanation),
    h('p', { class: 'what' }, whatHappened(incident)),
    incident.comment && h('blockquote', { class: 'comment' }, incident.comment),
  ];
}

/** The evidence in a sentence. */
function whatHappened({ beforeTime, afterTime, detector, score, threshold, kind }: Incident): string {
  const apart = (Date.parse(afterTime) - Date.parse(beforeTime)) / 1000;
  const times = score / threshold;
  const by = `${DETECTORS[detector] ?? detector} scored ${number(score)}, ` +
    `${times >= 1.05 ? `${number(times, 2)} times ` : 'with '}a threshold of ${number(threshold)}.`;
  return kind === 'carry' ? `Little by little, over ${number(apart)} s. ${by}`
    : `Between two scans, ${number(apart)} s apart. ${by}`;
}

function factList(incident: Incident, evidence?: Evidence): HTMLElement {
  const { robotId, beforeTime, afterTime, scanTime, configVersion, resolvedAt } = incident;
  return h('dl', { class: 'facts' },
    h('dt', {}, 'Robot'), h('dd', {}, h('a', { href: link('robots', robotId) }, robotId)),
    evidence && movement(evidence),
    h('dt', {}, 'Scan before'), h('dd', {}, exact(beforeTime)),
    h('dt', {}, 'Scan after'), h('dd', {}, exact(afterTime)),
    h('dt', {}, 'Confirmed by'), h('dd', {}, exact(scanTime)),
    resolvedAt && [h('dt', {}, 'Resolved'), h('dd', {}, timeElement(resolvedAt),
      ` by ${incident.resolvedBy ?? 'rule: its scans fitted together again'}`)],
    incident.acknowledgedBy && [h('dt', {}, 'Looked after by'), h('dd', {}, incident.acknowledgedBy)],
    isShelved(incident) && [h('dt', {}, 'Shelved until'), h('dd', {}, timeElement(incident.shelvedUntil))],
    h('dt', {}, 'Configuration'),
    h('dd', {}, h('a', { href: link('tuning', undefined, { robot: robotId }) },
      configVersion === 0 ? 'as delivered' : `version ${configVersion}`)),
    h('dt', {}, 'Id'), h('dd', {}, h('code', {}, incident.id)));
}

/** To the millisecond: scans are that near. */
function exact(iso: string): HTMLElement {
  return h('time', { datetime: iso, title: iso },
    `${localTime(new Date(iso))}.${iso.slice(20, 23)}`);
}

/** A plain http:// page has no clipboard: there the address is shown, to be copied. */
async function copyLink(said: Said): Promise<void> {
  try {
    await navigator.clipboard.writeText(location.href);
    said.say('The link is copied.');
  } catch {
    await tell('Copy this link', h('input', { value: location.href, readonly: true,
      'aria-label': 'Link', onfocus: (event: Event) => (event.target as HTMLInputElement).select() }));
  }
}

function saveFile(name: string, content: unknown): void {
  const file = new Blob([JSON.stringify(content, null, 1)], { type: 'application/json' });
  const url = URL.createObjectURL(file);
  h('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
