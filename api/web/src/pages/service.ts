// SPDX-License-Identifier: Apache-2.0
// The service itself: how much it does, how fast, what it drops, and what is wrong with it.
import { age, count, duration, fill, h, number, setText, words, type Child } from '../dom';
import { histogram, quantile, seconds, since, total, type Histogram } from '../metrics';
import type { Page } from '../page';
import { poll } from '../poll';
import { call, get, type Counts, type Service } from '../rest';
import { draw, ink, sizeOf, Trace } from '../sparkline';
import { badge, failed, isAbort, loading } from '../states';
import { colour, onTheme } from '../theme';

const EVERY_MS = 2000;
const LATELY_MS = 60_000;
const HISTOGRAMS = [
  { name: 'kidnapwatch_scan_judging_seconds', title: 'From a scan’s arrival to its verdict' },
  { name: 'kidnapwatch_store_commit_seconds', title: 'Commits of the store' },
];
const MEANING: Record<string, string> = {
  scored: 'compared with the last good scan', first: 'nothing to compare with yet',
  not_comparable: 'too few beams that hit something', repeated: 'the stamp of the last scan again',
  out_of_order: 'older than the last scan', malformed: 'not in any known encoding', missing_field: 'a required field is absent',
  wrong_type: 'a field of the wrong type', no_beams: 'no ranges', too_many_beams: 'more than 65536 ranges',
  bad_geometry: 'angles or range limits that describe no lidar', too_large: 'the payload is above the limit',
  unknown_topic: 'no scan is expected on that topic', bad_robot_id: 'the topic’s robot id is not one',
  too_many_robots: 'the limit of robots is reached', overload: 'pushed out of a full queue, or above the robot’s rate',
  failed: 'a fault of the service, which its log explains',
};

/** What was asked at one time. */
interface Sample {
  at: number;
  status: Service;
  histograms: (Histogram | undefined)[];
}

export const service: Page = (root) => {
  const samples: Sample[] = [];
  const trace = new Trace();
  const state = h('span', {});
  const content = h('div', {}, loading('Loading the service’s state'));
  const canvas = h('canvas', { class: 'rate', role: 'img' });
  const about = h('span', { class: 'muted' });
  root.append(h('div', { class: 'head' }, h('h1', {}, 'Service'), state, about), content);

  const paint = () => {
    const [first, last] = [trace.times[0], trace.times.at(-1)];
    if (first !== undefined && last !== undefined) draw(canvas, trace, last, { ...ink(), idle: colour('--accent') }, sizeOf(canvas), Math.max(60, last - first));
  };

  const tell = () => {
    const now = samples.at(-1)!;
    const before = samples.at(-2);
    const lately = samples[0]!;
    const isOk = now.status.brokerConnected && now.status.storeHealthy;
    const how = !isOk ? 'kidnapped' : now.status.degraded.length > 0 ? 'suspect' : 'normal';
    fill(state, badge(how, !isOk ? 'not ready' : now.status.degraded.length > 0 ? 'degraded' : 'ready'));
    const rate = before && rates(before, now);
    if (rate) trace.add(now.at / 1000, rate['all'] ?? 0);
    setText(about, `Version ${now.status.version}, up for ${duration(age(now.status.startedAt))}`);
    fill(content, warnings(now.status),
      h('div', { class: 'tiles' }, tiles(now.status, rate)),
      h('section', { class: 'card' }, h('h2', {}, 'Scans per second since this page was opened'),
        canvas, h('p', { class: 'hint' }, `From 0 to ${number(Math.max(0, ...trace.scores))}.`)),
      h('div', { class: 'columns' }, HISTOGRAMS.map(({ title }, i) =>
        latency(title, now.histograms[i], lately === now ? undefined : lately.histograms[i]))),
      h('div', { class: 'columns' }, outcomes(now.status, rates(lately, now)), commands(now.status.commands)));
    canvas.setAttribute('aria-label', `${number(rate?.['all'])} scans per second now`);
    paint();
  };

  const load = async (signal: AbortSignal) => {
    try {
      const [status, metrics] = await Promise.all([get<Service>('/api/v1/service', signal),
        call('/metrics', { signal }).then((response) => response.text())]);
      const at = Date.now();
      if (samples.at(-1) && samples.at(-1)!.status.startedAt !== status.startedAt) samples.length = 0;
      samples.push({ at, status, histograms: HISTOGRAMS.map(({ name }) => histogram(metrics, name)) });
      while (samples.length > 2 && samples[0]!.at < at - LATELY_MS) samples.shift();
      tell();
    } catch (error) {
      if (isAbort(error)) return;
      samples.length = 0;
      fill(state);
      fill(content, failed(error));
    }
  };
  const stop = poll(load, () => EVERY_MS);
  const off = onTheme(paint);
  return () => { stop(); off(); };
};

/** Per second, by outcome, and of `all`; nothing where no time has passed. */
function rates(before: Sample, now: Sample): Counts | undefined {
  const elapsed = (now.at - before.at) / 1000;
  if (elapsed <= 0) return undefined;
  const result: Counts = { all: 0 };
  for (const [name, value] of Object.entries(now.status.scans)) {
    result[name] = (value - (before.status.scans[name] ?? 0)) / elapsed;
    result['all']! += result[name]!;
  }
  return result;
}

function warnings({ degraded }: Service): Child {
  return degraded.length > 0 && h('section', { class: 'card warning', role: 'alert' }, h('h2', {}, 'What is wrong'),
    h('ul', {}, degraded.map(({ name, what }) => h('li', {}, h('strong', {}, words(name)), ': ', what))));
}

function megabytes(bytes: number): string {
  const size = bytes / 1e6;
  return size < 1000 ? `${number(size)} MB` : `${number(size / 1000)} GB`;
}

function tiles(status: Service, rate: Counts | undefined): HTMLElement[] {
  const tile = (name: string, value: Child, isBad = false) =>
    h('dl', { class: `tile${isBad ? ' is-bad' : ''}` }, h('dt', {}, name), h('dd', {}, value));
  return [
    tile('Scans/s', rate ? number(rate['all']) : '…'),
    tile('Robots', count(status.robots)),
    tile('Broker', status.brokerConnected ? 'connected' : 'not connected', !status.brokerConnected),
    tile('Store', status.storeHealthy ? 'healthy' : 'not writing', !status.storeHealthy),
    tile('Store size', megabytes(status.storeBytes)),
    tile('Scans waiting', count(status.queuedScans)),
    tile('Records waiting', count(status.queuedWrites)),
    tile('Records lost', count(status.lostWrites), status.lostWrites > 0),
  ];
}

function latency(title: string, all: Histogram | undefined, before: Histogram | undefined): HTMLElement {
  const card = h('section', { class: 'card' }, h('h2', {}, title));
  if (!all || total(all) === 0) {
    card.append(h('p', { class: 'muted' }, 'None yet.'));
    return card;
  }
  const lately = before && since(all, before);
  const row = (name: string, value: (of: Histogram) => string) => h('tr', {}, h('th', { scope: 'row' }, name),
    h('td', { class: 'number' }, lately && total(lately) > 0 ? value(lately) : '–'), h('td', { class: 'number' }, value(all)));
  const most = Math.max(...all.counts);
  const shown = all.bounds.slice(0, all.counts.findLastIndex((one) => one > 0) + 1);
  card.append(
    h('table', {}, h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, h('span', { class: 'visually-hidden' }, 'Share')),
      h('th', { scope: 'col', class: 'number' }, 'last minute'), h('th', { scope: 'col', class: 'number' }, 'since the start'))),
    h('tbody', {}, [0.5, 0.95, 0.99].map((q) => row(`${q * 100} % within`, (of) => seconds(quantile(of, q)))),
      row('mean', (of) => seconds(of.sum / total(of))), row('how many', (of) => count(total(of))))),
    h('table', { class: 'bars' }, h('caption', {}, 'Since the start, by duration'),
      h('tbody', {}, shown.map((bound, i) => bar(bound === Infinity ? 'longer' : `≤ ${seconds(bound)}`,
        all.counts[i]!, most, total(all))))));
  return card;
}

function bar(name: string, value: number, most: number, all: number): HTMLElement {
  const fillOf = h('span', { class: 'bar-fill' });
  fillOf.style.width = value === 0 ? '0' : `max(2px, ${(value / most) * 100}%)`;
  const share = (value / all) * 100;
  return h('tr', {}, h('th', { scope: 'row' }, name), h('td', { class: 'bar-cell' }, fillOf),
    h('td', { class: 'number' }, value === 0 ? '0' : share < 0.1 ? count(value) : `${share.toFixed(1)} %`));
}

function outcomes({ scans }: Service, rate: Counts | undefined): HTMLElement {
  const all = Object.values(scans).reduce((sum, one) => sum + one, 0);
  const dropped = Object.entries(scans).filter(([name, value]) => value > 0 && name !== 'scored')
    .sort((a, b) => b[1] - a[1]);
  const row = ([name, value]: [string, number]) => h('tr', {},
    h('th', { scope: 'row' }, words(name), h('span', { class: 'hint meaning' }, MEANING[name])),
    h('td', { class: 'number' }, count(value)), h('td', { class: 'number' }, rate ? number(rate[name]) : '…'));
  return h('section', { class: 'card' }, h('h2', {}, 'What became of the scans'),
    h('div', { class: 'table-wrap' }, h('table', {}, h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'Outcome'),
      h('th', { scope: 'col', class: 'number' }, 'Scans'), h('th', { scope: 'col', class: 'number' }, 'per second'))),
    h('tbody', {}, row(['scored', scans['scored'] ?? 0]), dropped.map(row),
      h('tr', {}, h('th', { scope: 'row' }, 'all'), h('td', { class: 'number' }, count(all)),
        h('td', { class: 'number' }, rate ? number(rate['all']) : '…'))))),
    dropped.length === 0 && h('p', { class: 'hint' }, 'Nothing was dropped.'));
}

function commands(counts: Counts): HTMLElement {
  const some = Object.entries(counts).filter(([, value]) => value > 0);
  return h('section', { class: 'card' }, h('h2', {}, 'Commands by MQTT'), some.length === 0
    ? h('p', { class: 'muted' }, 'None came.')
    : h('table', {}, h('tbody', {}, some.map(([name, value]) =>
      h('tr', {}, h('th', { scope: 'row' }, words(name)), h('td', { class: 'number' }, count(value)))))));
}
