// SPDX-License-Identifier: Apache-2.0
// Trying out a threshold on what was stored, and putting it in force.
import { fill, h, number, setText } from '../dom';
import { remember, type Page } from '../page';
import { at, get, getAll, Problem, send, type ConfigLevel, type Detector, type Incident,
  type Robot, type ThresholdPreview } from '../rest';
import { Said } from '../said';
import { can } from '../session';
import { failed, isAbort, loading, sentence } from '../states';
import { calibrate } from '../tuning/calibrate';
import { effect, spoken } from '../tuning/effect';
import { showRoc, tooLittle } from '../tuning/roc';
import { configPath, save } from '../tuning/save';
import { Strip } from '../tuning/strip';
import { configured, DETECTORS, Scale } from '../tuning/threshold';
import { Versions } from '../tuning/versions';

const DEBOUNCE_MS = 200;
const BUSY_MS = 400; // the service computes one preview at a time
const MOST_INCIDENTS = 1000;
const DAY_MS = 86_400_000;
const SPANS: [string, string][] = [['', 'All that is stored'], ['1', 'Last day'], ['7', 'Last 7 days'],
  ['30', 'Last 30 days']];

interface Loaded {
  level: ConfigLevel;
  incidents: Incident[];
  robots: Robot[];
  scale: Scale;
}

export const tuning: Page = (root, { query }) => {
  const chosen = {
    robot: query.get('robot') ?? '',
    detector: (query.get('detector') === 'qs2ddtw' ? 'qs2ddtw' : 'motion_consistency') as Detector,
    days: query.get('days') ?? '',
  };
  let threshold = Number(query.get('threshold')) || 0;
  let loaded: Loaded | undefined;
  let raised: { robotId: string; score: number }[] = [];
  let stopping = new AbortController();
  let timer: ReturnType<typeof setTimeout> | undefined;

  const body = h('div', {});
  const says = h('p', { class: 'hint' });
  const strip = new Strip(can('operator') ? (value) => move(value) : undefined);
  const slider = h('input', { type: 'range', id: 'threshold', min: 0, max: Scale.STEPS, step: 1,
    oninput: () => move(loaded!.scale.value(Number(slider.value) / Scale.STEPS)) });
  const exact = h('input', { type: 'number', id: 'exact', min: 0, step: 'any',
    onchange: () => { if (Number(exact.value) > 0) move(Number(exact.value)); } });
  const outcome = h('div', { class: 'outcome', 'aria-busy': 'false' });
  const said = new Said();
  const heard = h('p', { class: 'visually-hidden', role: 'status' });
  const saving = h('div', {});
  const roc = h('div', {});
  const versions = new Versions((text) => { said.say(text); void load(); });
  const scope = () => ({ detector: chosen.detector, ...(chosen.robot ? { robot: chosen.robot } : {}),
    ...since(chosen.days) });

  async function load(): Promise<void> {
    stopping.abort();
    stopping = new AbortController();
    const { signal } = stopping;
    if (!loaded) fill(body, loading());
    try {
      const query = { robot: chosen.robot || undefined, limit: 1000, ...since(chosen.days) };
      const [level, all, { robots }] = await Promise.all([
        get<ConfigLevel>(configPath(chosen.robot), signal),
        getAll<Incident>(at('/api/v1/incidents', query), 'incidents', MOST_INCIDENTS, signal),
        get<{ robots: Robot[] }>('/api/v1/robots', signal),
      ]);
      const incidents = all.filter((one) => decidedBy(chosen.detector, one));
      const now = inForce(level, chosen.detector, robots, chosen.robot);
      threshold ||= now;
      loaded = { level, incidents, robots,
        scale: Scale.around([...incidents.map(({ score }) => score), now, threshold]) };
      show();
      const labels = new Set(incidents.map(({ label }) => label));
      const isLabelled = labels.has('kidnapping') && labels.has('false_alarm');
      if (!isLabelled && all.length < MOST_INCIDENTS) fill(roc, tooLittle());
      else void showRoc(roc, { ...scope(), signal, use: can('operator') ? move : undefined });
      void versions.load(chosen.robot, signal);
    } catch (error) {
      if (!isAbort(error)) fill(body, failed(error, () => void load()));
    }
  }

  function show(): void {
    setText(says, DETECTORS[chosen.detector].says);
    if (scopes.childElementCount === 0) fill(scopes, scopeFields(chosen, loaded!.robots, choose));
    if (!body.contains(outcome)) fill(body, layout());
    move(threshold);
  }

  function layout(): HTMLElement[] {
    return [
      h('section', { class: 'card' }, h('h2', {}, 'Threshold'), says, strip.element,
        can('operator') ? h('div', { class: 'threshold row' },
          h('label', { for: 'threshold' }, 'Try'), slider, exact,
          h('label', { for: 'exact', class: 'visually-hidden' }, 'Exactly'))
          : h('p', { class: 'hint' }, 'To try out others takes the role operator.'),
        outcome),
      h('div', { class: 'tuning-columns' },
        h('div', {},
          h('section', { class: 'card' }, h('h2', {}, 'In force'), saving),
          can('operator') && h('section', { class: 'card' },
            h('h2', {}, 'For a rate of false alarms'), calibrate(scope, move))),
        h('section', { class: 'card' }, h('h2', {}, 'What labels say'), roc)),
      h('section', { class: 'card' }, h('h2', {}, 'History of the configuration'), versions.element),
    ];
  }

  function choose(name: 'robot' | 'detector' | 'days', value: string): void {
    Object.assign(chosen, { [name]: value });
    if (name !== 'days') threshold = 0;
    remember({ ...chosen, threshold: undefined });
    void load();
  }

  /** Has this threshold everywhere at once; the service is asked a moment later. */
  function move(value: number): void {
    if (!loaded) return;
    const { scale, level, incidents } = loaded;
    if (value !== threshold) raised = [];
    threshold = value;
    slider.value = String(Math.round(scale.position(value) * Scale.STEPS));
    slider.setAttribute('aria-valuetext', number(value));
    exact.value = String(value);
    strip.show({ scale, threshold, incidents, raised, inForce: configured(level, chosen.detector) });
    save(saving, { level, detector: chosen.detector, robot: chosen.robot, threshold,
      saved: (changed) => { said.say(`Saved as version ${changed.version}. It takes effect with the next scan.`); void load(); },
      reload: () => void load() });
    if (can('operator')) askSoon();
  }

  function askSoon(wait_ms = DEBOUNCE_MS): void {
    clearTimeout(timer);
    outcome.setAttribute('aria-busy', 'true');
    timer = setTimeout(() => void preview(), wait_ms);
  }

  async function preview(): Promise<void> {
    const asked = threshold;
    remember({ threshold: String(asked) });
    try {
      const found = await send<ThresholdPreview>('POST', '/api/v1/thresholds:preview',
        { ...scope(), threshold: asked });
      if (asked !== threshold || stopping.signal.aborted) return;
      raised = found.raisedIncidents;
      effect(outcome, found);
      setText(heard, spoken(found));
      const { scale, level, incidents } = loaded!;
      strip.show({ scale, threshold, incidents, raised, inForce: configured(level, chosen.detector) });
    } catch (error) {
      if (asked !== threshold || stopping.signal.aborted) return;
      if (error instanceof Problem && error.status === 503) return askSoon(BUSY_MS);
      fill(outcome, h('p', { class: 'error' }, sentence(error)));
    }
    outcome.setAttribute('aria-busy', 'false');
  }

  const scopes = h('form', { class: 'choosers', 'aria-label': 'What is tuned',
    onsubmit: (event: Event) => event.preventDefault() });
  root.append(h('div', { class: 'head' }, h('h1', {}, 'Tuning')), scopes, body, heard, said.element);
  void load();
  return () => {
    stopping.abort();
    clearTimeout(timer);
    strip.stop();
    said.stop();
  };
};

function since(days: string): { from?: string } {
  const span = Number(days) * DAY_MS;
  return span > 0 ? { from: new Date(Date.now() - span).toISOString() } : {};
}

/** A carry has a threshold of its own. */
function decidedBy(detector: Detector, { detector: by, kind }: Incident): boolean {
  return kind !== 'carry' && (detector === 'motion_consistency') === (by === 'motion_consistency');
}

/** Where robots have their own: this robot's, or the middle one of all. */
function inForce(level: ConfigLevel, detector: Detector, robots: Robot[], robot: string): number {
  const own = robots.filter(({ id, threshold }) => threshold && (robot === '' || id === robot))
    .map(({ threshold }) => threshold!).sort((a, b) => a - b);
  return configured(level, detector) ?? own[Math.floor(own.length / 2)] ?? 100;
}

function scopeFields(chosen: { robot: string; detector: Detector; days: string }, robots: Robot[],
  choose: (name: 'robot' | 'detector' | 'days', value: string) => void): HTMLElement[] {
  const select = (name: 'robot' | 'detector' | 'days', label: string, options: [string, string][]) =>
    h('label', {}, h('span', {}, label),
      h('select', { name, onchange: (event: Event) =>
        choose(name, (event.target as HTMLSelectElement).value) },
      options.map(([value, text]) => h('option', { value, selected: value === chosen[name] }, text))));
  return [
    select('robot', 'Robots', [['', 'The fleet'],
      ...robots.map(({ id }): [string, string] => [id, id])]),
    select('detector', 'Detector', Object.entries(DETECTORS).map(([name, { title }]) => [name, title])),
    select('days', 'Tried out on', SPANS),
  ];
}
