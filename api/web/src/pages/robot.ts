// SPDX-License-Identifier: Apache-2.0
// One robot: its score against the threshold over any time, what it sees, how it is configured.
import { configTable } from '../config_table';
import { age, button, count, duration, fill, h, scoreText, setText, timeElement, words } from '../dom';
import { onAlert, onRobots } from '../live';
import { link, remember, type Page } from '../page';
import { polar } from '../polar';
import { poll } from '../poll';
import { scorePlot, type Mark } from '../plot';
import { at, get, getAll, Problem, serviceNow, type ConfigLevel, type Incident, type LaserScan, type Robot,
  type RobotUpdate } from '../rest';
import { loadSeries, resolutionFor, type ScoreKind, type Series } from '../series';
import { badge, empty, failed, isAbort, loading, ROBOT_STATES, sentence } from '../states';
import { updateOf } from './fleet';

const SPANS: [string, number][] = [['2 min', 120], ['1 h', 3600], ['6 h', 21600], ['1 d', 86400], ['7 d', 604800], ['30 d', 2592000]];
const KINDS: [ScoreKind, string][] = [['motion', 'Motion'], ['qs2ddtw', 'QS-2DDTW']];
const LEAST_MS = 1000;

export const robot: Page = (root, { id = '', query }) => {
  const stop = new AbortController();
  const disposals: (() => void)[] = [() => stop.abort()];
  root.append(loading(`Loading ${id}`));
  get<Robot>(at('/api/v1/robots', id), stop.signal).then((first) => {
    root.replaceChildren();
    const { element, now, dispose } = heading(id, first);
    const facts = nowCard(id, now);
    root.append(element, scoreCard(id, query, now, disposals),
      h('div', { class: 'columns' }, scanCard(id, disposals), facts.element, configCard(id, stop.signal)));
    disposals.push(dispose, facts.dispose);
  }).catch((error: unknown) => {
    if (isAbort(error)) return;
    const isGone = error instanceof Problem && error.status === 404;
    root.replaceChildren(h('h1', {}, id), isGone ? empty(`No robot is named ${id}.`, h('a', { href: link('fleet') }, 'All robots'))
      : failed(error, () => location.reload()));
  });
  return () => disposals.forEach((dispose) => dispose());
};

/** What is known of the robot now; the clocks of robots and the service may differ. */
interface Now {
  robot: Robot;
  time(): number; // by the robot's clock, in milliseconds
  ahead(): number; // the robot's clock, of the service's
}

function nowOf(robot: Robot): Now {
  const now: Now = {
    robot,
    time: () => serviceNow() + now.ahead(),
    ahead: () => now.robot.lastScore ? Date.parse(now.robot.lastScore.time) - Date.parse(now.robot.lastScanAt) : 0,
  };
  return now;
}

function heading(id: string, first: Robot): { element: HTMLElement; now: Now; dispose: () => void } {
  const now = nowOf(first);
  const state = h('span', {});
  const what = h('span', { class: 'muted' });
  const incident = h('span', {});
  let shown = '';
  const tell = (update: RobotUpdate) => {
    const key = [update.state, update.trouble, update.incidentId].join();
    if (key === shown) return;
    shown = key;
    fill(state, badge(update.state));
    setText(what, update.trouble ? now.robot.explanation ?? words(update.trouble) : '');
    fill(incident, update.incidentId && h('a', { href: link('incidents', update.incidentId) }, 'Open incident'));
  };
  tell(updateOf(first));
  const dispose = onRobots((changed) => changed.filter((one) => one.id === id).forEach(tell));
  const element = h('div', { class: 'head' }, h('a', { href: link('fleet') }, '‹ Fleet'), h('h1', {}, id), state, incident, what);
  return { element, now, dispose };
}

interface View {
  kind: ScoreKind;
  span: number; // seconds, up to now; where there is no `range`
  range?: [number, number]; // milliseconds, by the robot's clock
}

function viewOf(query: URLSearchParams): View {
  const from = Date.parse(query.get('from') ?? '');
  const to = Date.parse(query.get('to') ?? '');
  const span = Number(query.get('span'));
  return {
    kind: query.get('score') === 'qs2ddtw' ? 'qs2ddtw' : 'motion',
    span: SPANS.some(([, seconds]) => seconds === span) ? span : 3600,
    range: from < to ? [from, to] : undefined,
  };
}

function scoreCard(id: string, query: URLSearchParams, now: Now, disposals: (() => void)[]): HTMLElement {
  const view = viewOf(query);
  let marks: Mark[] = [];
  let series: Series | undefined;
  let stopPolling: () => void = () => undefined;
  const message = h('div', {});
  const about = h('span', { class: 'hint', role: 'status' });
  const plot = scorePlot({
    label: `Score of ${id} against its threshold`,
    onZoom: (from, to) => look([from * 1000, Math.max(to * 1000, from * 1000 + LEAST_MS)]),
    hrefOfMany: () => link('incidents', undefined, { robot: id }),
  });

  const range = (): [number, number] => view.range ?? [now.time() - view.span * 1000, now.time()];

  const look = (to?: [number, number], span = view.span) => {
    view.range = to;
    view.span = span;
    remember({ score: view.kind === 'motion' ? undefined : view.kind, span: to ? undefined : String(view.span),
      from: to && new Date(to[0]).toISOString(), to: to && new Date(to[1]).toISOString() });
    press();
    restart();
  };

  const restart = () => {
    stopPolling();
    void loadMarks().catch(() => undefined);
    const isLive = view.range === undefined;
    stopPolling = poll(load, () => isLive ? Math.max(2000, resolutionFor(view.span) * 1000) : 3_600_000);
  };

  const load = async (signal: AbortSignal) => {
    const [from, to] = range();
    try {
      series = await loadSeries(id, view.kind, from, to, signal);
      show(from, to);
    } catch (error) {
      if (!isAbort(error)) fill(message, failed(error, restart));
    }
  };

  const show = (from: number, to: number) => {
    if (!series) return;
    plot.show(series, marks, { from: from / 1000, to: to / 1000 });
    const bucket = series.resolution === 0 ? 'every scan' : `lowest to highest of each ${duration(series.resolution)}`;
    setText(about, series.time.length > 0 ? `Shown: ${bucket}.` : '');
    if (series.time.length > 0) fill(message);
    else fill(message, h('p', { class: 'state' }, 'No scores in this time. ', lastScan()));
  };

  const lastScan = () => {
    const last = now.robot.lastScore && Date.parse(now.robot.lastScore.time);
    return last ? button('Go to the last scan', () => look([last - 110_000, last + 10_000])) : 'The robot has not sent two scans yet.';
  };

  const loadMarks = async () => {
    const [from, to] = range().map((time) => time - now.ahead());
    const found = await getAll<Incident>(at('/api/v1/incidents', { robot: id, limit: 1000,
      from: new Date(from! - 60_000).toISOString(), to: new Date(to! + 60_000).toISOString() }), 'incidents', 2000);
    marks = found.map((one) => ({ time: Date.parse(one.afterTime) / 1000, href: link('incidents', one.id),
      label: `Incident: ${one.cause}, ${words(one.state)}` }));
    const [left, right] = range();
    show(left, right);
  };

  const zoom = (factor: number, shift = 0) => {
    const [from, to] = range();
    const half = Math.max(LEAST_MS, (to - from) * factor) / 2;
    const middle = (from + to) / 2 + shift * (to - from);
    look([middle - half, middle + half]);
  };

  const kinds = KINDS.map(([kind, name]) => button(name, () => { view.kind = kind; look(view.range); }, { 'data-key': kind }));
  const spans = SPANS.map(([name, seconds]) => button(name, () => look(undefined, seconds), { 'data-key': seconds }));
  const press = () => {
    kinds.forEach((one) => one.setAttribute('aria-pressed', String(one.dataset['key'] === view.kind)));
    spans.forEach((one) => one.setAttribute('aria-pressed', String(!view.range && one.dataset['key'] === String(view.span))));
  };
  press();
  restart();
  disposals.push(() => stopPolling(), plot.dispose,
    onAlert((alert) => { if (alert.robotId === id) void loadMarks().catch(() => undefined); }));
  return h('section', { class: 'card', 'aria-label': 'Score' },
    h('div', { class: 'row tools' },
      h('div', { class: 'group', role: 'group', 'aria-label': 'Which score' }, kinds),
      h('div', { class: 'group', role: 'group', 'aria-label': 'Time up to now' }, spans),
      h('div', { class: 'group', role: 'group', 'aria-label': 'Move' },
        button('←', () => zoom(1, -0.5), { 'aria-label': 'Earlier', title: 'Earlier' }),
        button('→', () => zoom(1, 0.5), { 'aria-label': 'Later', title: 'Later' }),
        button('+', () => zoom(0.4), { 'aria-label': 'Zoom in', title: 'Zoom in' }),
        button('−', () => zoom(2.5), { 'aria-label': 'Zoom out', title: 'Zoom out' }))),
    plot.element, message,
    h('div', { class: 'row' }, stateLegend(), h('span', { class: 'hint only-mouse' }, 'Drag over the plot to look closer.'), about));
}

function stateLegend(): HTMLElement {
  return h('ul', { class: 'legend', 'aria-label': 'Colours of the band below the plot' }, ROBOT_STATES.map((state) =>
    h('li', {}, h('span', { class: `swatch swatch-${state}` }), state)));
}

function scanCard(id: string, disposals: (() => void)[]): HTMLElement {
  const view = polar(`The last two scans of ${id} from above`);
  const about = h('p', { class: 'hint' });
  view.element.hidden = true;
  setText(about, 'Waiting for two scans.');
  const load = async (signal: AbortSignal) => {
    try {
      const { before, after } = await get<{ before?: LaserScan; after?: LaserScan }>(at('/api/v1/robots', id, 'scans'), signal);
      if (!after) return;
      view.element.hidden = false;
      view.draw([...before ? [{ name: 'scan before', scan: before, colour: '--before' }] : [],
        { name: 'last scan', scan: after, colour: '--after' }]);
      const hits = after.ranges.filter((range) => range !== null).length;
      setText(about, `${count(hits)} of ${count(after.ranges.length)} beams hit something, up to ${after.range_max.toFixed(1)} m.`);
    } catch (error) {
      if (!isAbort(error)) setText(about, sentence(error));
    }
  };
  disposals.push(poll(load, () => 1000), view.dispose);
  return h('section', { class: 'card' }, h('h2', {}, 'What its lidar sees'), view.element, about);
}

function nowCard(id: string, now: Now): { element: HTMLElement; dispose: () => void } {
  const facts = h('dl', { class: 'facts' });
  const tell = () => fill(facts, factsOf(now.robot).map(([name, value]) => [h('dt', {}, name), h('dd', {}, value)]));
  tell();
  const dispose = poll(async (signal) => {
    now.robot = await get<Robot>(at('/api/v1/robots', id), signal);
    tell();
  }, () => 2000);
  return { element: h('section', { class: 'card' }, h('h2', {}, 'Now'), facts), dispose };
}

function factsOf(robot: Robot): [string, Node | string][] {
  const { lastScore, calibration, scans } = robot;
  const arrived = Object.values(scans).reduce((sum, one) => sum + one, 0);
  const dropped = Object.entries(scans).filter(([name, number]) => name !== 'scored' && name !== 'first' && number > 0);
  const facts: [string, Node | string][] = [
    ['Last scan', h('span', {}, `${duration(age(robot.lastScanAt))} ago, `, timeElement(robot.lastScanAt))],
    ['Motion consistency', `${scoreText(lastScore?.motion?.confirmed ?? lastScore?.motion?.score)} of ${scoreText(robot.motionThreshold)}`],
    ['Own threshold', scoreText(robot.ownMotionThreshold)],
    ['Carry', lastScore?.motion ? `${scoreText(lastScore.motion.carry)} of 30.0` : '–'],
    ['QS-2DDTW', `${scoreText(lastScore?.score)} of ${scoreText(robot.threshold)}`],
    ['Learned from', calibration.pairs < calibration.needed
      ? `${count(calibration.pairs)} of ${count(calibration.needed)} pairs of scans needed` : `${count(calibration.pairs)} pairs of scans`],
    ['Scans', `${count(arrived)} since the service started`],
  ];
  for (const [name, number] of dropped) facts.push([words(name), count(number)]);
  return facts;
}

function configCard(id: string, signal: AbortSignal): HTMLElement {
  const content = h('div', {}, loading());
  const load = () => get<ConfigLevel>(at('/api/v1/robots', id, 'config'), signal).then((level) => {
    fill(content, configTable(level), h('p', { class: 'hint' }, level.version === 0 ? 'As the service was started.' :
      [`Version ${level.version}, by ${level.author}, `, timeElement(level.since), '.']));
  }).catch((error: unknown) => { if (!isAbort(error)) fill(content, failed(error, () => void load())); });
  void load();
  return h('section', { class: 'card' },
    h('div', { class: 'row card-head' }, h('h2', {}, 'Configuration in force'),
      h('a', { href: link('tuning', undefined, { robot: id }) }, 'Tune the threshold')), content);
}
