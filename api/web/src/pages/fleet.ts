// SPDX-License-Identifier: Apache-2.0
// Every robot, the worst first, live. Only rows that can be seen are drawn.
import { age, button, count, duration, fill, h, scoreText, setText, words } from '../dom';
import { onRobots, onState } from '../live';
import { link, remember, type Page } from '../page';
import { at, get, serviceNow, type Robot, type RobotState, type RobotUpdate, type ScoreBucket } from '../rest';
import { draw, ink, sizeOf, SPAN_S, Trace, type Size } from '../sparkline';
import { badge, empty, loading, ROBOT_STATES } from '../states';
import { onTheme } from '../theme';

const HISTORY_RESOLUTION_S = 10;
const HISTORY_AGE_MS = 60_000; // then it is loaded anew: between two updates may have been a spike
const HISTORIES_AT_ONCE = 3;
const SILENT_MS = 2000; // after which a stream that tells of no robot has none

interface Row {
  robot: RobotUpdate;
  rank: number;
  trace: Trace;
  element: HTMLLIElement;
  parts?: Parts; // while it can be seen
  shown?: RobotState;
  dirty: boolean;
  loadedAt: number;
}

interface Parts {
  state: HTMLElement;
  trouble: HTMLElement;
  canvas: HTMLCanvasElement;
  score: HTMLElement;
  limit: HTMLElement;
  age: HTMLElement;
}

/** What the alarm judges by: motion consistency where it is computed, else the paper's score. */
export function alarmScore(robot: RobotUpdate): { score?: number; threshold?: number } {
  if (robot.motion !== undefined || robot.motionConfirmed !== undefined) {
    return { score: robot.motionConfirmed ?? robot.motion, threshold: robot.motionThreshold };
  }
  return { score: robot.score, threshold: robot.threshold };
}

export function updateOf(robot: Robot): RobotUpdate {
  const { id, state, lastScanAt, trouble, incidentId, threshold, motionThreshold, lastScore } = robot;
  return { id, state, lastScanAt, trouble, incidentId, threshold, motionThreshold, score: lastScore?.score,
    motion: lastScore?.motion?.score, motionConfirmed: lastScore?.motion?.confirmed };
}

const byName = new Intl.Collator(undefined, { numeric: true });

export const fleet: Page = (root, { query }) => {
  const rows = new Map<string, Row>();
  const visible = new Set<Row>();
  const counts = new Map<RobotState | 'all', HTMLElement>();
  const stop = new AbortController();
  let wanted = ROBOT_STATES.find((state) => state === query.get('state'));
  let search = query.get('q') ?? '';
  let colours = ink();
  let isSorted = false;
  let isKnown = false; // what the fleet is, be it empty
  let size: Size | undefined; // of every canvas
  let frame = 0;
  let loads = 0;

  const list = h('ul', { class: 'fleet' });
  const nothing = h('div');
  const total = h('span', { class: 'muted' });
  const searchBox = h('input', { type: 'search', placeholder: 'Search robots', 'aria-label': 'Search robots', value: search,
    oninput: () => { search = searchBox.value; filtered(); } });
  const filters = h('div', { class: 'filters', role: 'group', 'aria-label': 'Show only' });
  const columns = h('div', { class: 'fleet-columns', 'aria-hidden': 'true' },
    ['State', 'Robot', `Score, last ${SPAN_S / 60} min`, 'Score / threshold', 'Last scan'].map((name) => h('span', {}, name)));

  const filterButton = (state: RobotState | 'all') => {
    const tally = h('span', { class: 'filter-count' });
    counts.set(state, tally);
    return button([state === 'all' ? 'All' : words(state), ' ', tally], () => {
      wanted = state === 'all' || state === wanted ? undefined : state;
      filtered();
    }, { class: `filter filter-${state}`, 'data-state': state });
  };

  const filtered = () => {
    remember({ state: wanted, q: search });
    press();
    isSorted = false;
    ask();
  };

  const press = () => {
    filters.querySelectorAll('button').forEach((one) =>
      one.setAttribute('aria-pressed', String(one.dataset['state'] === (wanted ?? 'all'))));
  };

  const ask = () => { frame ||= requestAnimationFrame(render); };

  const take = (robots: RobotUpdate[], isAll: boolean) => {
    isKnown = true;
    if (isAll) drop(new Set(robots.map(({ id }) => id)));
    const now = serviceNow() / 1000;
    for (const robot of robots) {
      let row = rows.get(robot.id);
      if (!row) {
        row = added(robot);
      } else if (row.robot.state !== robot.state) {
        isSorted = false;
      }
      row.robot = robot;
      row.dirty = true;
      const { score, threshold } = alarmScore(robot);
      row.trace.threshold = threshold;
      if (score !== undefined) row.trace.add(Math.min(now, Date.parse(robot.lastScanAt) / 1000), score);
    }
    ask();
  };

  const added = (robot: RobotUpdate): Row => {
    const element = h('li', {}, h('a', { class: 'fleet-id', href: link('robots', robot.id) }, robot.id));
    const row: Row = { robot, rank: 0, trace: new Trace(), element, dirty: true, loadedAt: 0 };
    rows.set(robot.id, row);
    byElement.set(element, row);
    isSorted = false;
    return row;
  };

  const drop = (kept: Set<string>) => {
    for (const [id, row] of rows) {
      if (kept.has(id)) continue;
      sight.unobserve(row.element);
      row.element.remove();
      visible.delete(row);
      rows.delete(id);
      isSorted = false;
    }
  };

  const byElement = new WeakMap<Element, Row>();
  const sight = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const row = byElement.get(target)!;
      if (isIntersecting) visible.add(row);
      else leave(row);
    }
    ask();
  }, { rootMargin: '240px' });

  const leave = (row: Row) => {
    visible.delete(row);
    if (!row.parts || row.element.contains(document.activeElement)) return;
    row.element.replaceChildren(row.element.firstElementChild!); // its canvas would take memory
    row.parts = undefined;
    row.shown = undefined;
  };

  const render = () => {
    frame = 0;
    if (!isSorted) sort();
    const now = serviceNow() / 1000;
    const dirty = [...visible].filter((row) => row.dirty || !row.parts);
    dirty.forEach((row) => refresh(row, row.parts ??= filledIn(row)));
    for (const { parts, trace } of dirty) {
      size ??= sizeOf(parts!.canvas); // once, after everything was changed
      draw(parts!.canvas, trace, now, colours, size);
    }
    void loadHistories();
  };

  const sort = () => {
    isSorted = true;
    const tally = new Map<string, number>();
    for (const row of rows.values()) {
      row.rank = ROBOT_STATES.indexOf(row.robot.state);
      tally.set(row.robot.state, (tally.get(row.robot.state) ?? 0) + 1);
    }
    counts.forEach((element, state) => setText(element, count(state === 'all' ? rows.size : tally.get(state) ?? 0)));
    const text = search.trim().toLowerCase();
    const shown = [...rows.values()]
      .filter(({ robot }) => (!wanted || robot.state === wanted) && robot.id.toLowerCase().includes(text))
      .sort((a, b) => a.rank - b.rank || byName.compare(a.robot.id, b.robot.id));
    arrange(shown);
    setText(total, shown.length === rows.size ? '' : `${count(shown.length)} of ${count(rows.size)}`);
    columns.hidden = shown.length === 0;
    if (isKnown) tellNothing(shown.length > 0);
  };

  /** Moves as few rows as possible; the focus stays where it is. */
  const arrange = (shown: Row[]) => {
    const focused = document.activeElement;
    const keep = new Set<Element>(shown.map(({ element }) => element));
    [...list.children].forEach((element) => { if (!keep.has(element)) { sight.unobserve(element); leave(byElement.get(element)!); element.remove(); } });
    let next = list.firstElementChild;
    for (const { element } of shown) {
      if (element === next) {
        next = next.nextElementSibling;
      } else {
        list.insertBefore(element, next);
        sight.observe(element);
      }
    }
    if (focused instanceof HTMLElement && focused !== document.activeElement && list.contains(focused)) focused.focus();
  };

  const tellNothing = (isSome: boolean) => {
    if (isSome) fill(nothing);
    else if (rows.size === 0) {
      fill(nothing, empty('No robot has been heard of yet.', 'A robot appears here with its first scan on ',
        h('code', {}, 'kidnapwatch/v1/ROBOT/scan'), '. To see some: ', h('code', {}, 'kidnapwatch simulate --robots 5 --rate 5')));
    } else {
      fill(nothing, empty('No robot matches.', button('Show all', () => {
        wanted = undefined;
        searchBox.value = search = '';
        filtered();
      })));
    }
  };

  const loadHistories = async () => {
    for (const row of visible) {
      if (loads >= HISTORIES_AT_ONCE) return;
      if (Date.now() - row.loadedAt < HISTORY_AGE_MS) continue;
      row.loadedAt = Date.now();
      loads++;
      try {
        await loadHistory(row, stop.signal);
        row.dirty = true;
      } catch {
        // The row shows what comes live; a minute later it is tried again.
      } finally {
        loads--;
      }
      if (stop.signal.aborted) return;
      ask();
    }
  };

  filters.append(filterButton('all'), ...ROBOT_STATES.map(filterButton));
  root.append(h('div', { class: 'head' }, h('h1', {}, 'Fleet'), total, h('div', { class: 'end' }, searchBox)),
    filters, columns, list, nothing);
  columns.hidden = true;
  press();
  fill(nothing, loading('Loading the fleet'));
  const offRobots = onRobots(take);
  let silence: ReturnType<typeof setTimeout> | undefined;
  const offState = onState((state) => {
    clearTimeout(silence);
    if (state === 'live') silence = setTimeout(() => { isKnown = true; isSorted = false; ask(); }, SILENT_MS);
    else if (state === 'reconnecting' && rows.size === 0) {
      fill(nothing, empty('The service does not answer.', 'This page shows the fleet as soon as it does.'));
    }
  });
  const redraw = () => { visible.forEach((row) => { row.dirty = true; }); ask(); };
  const resized = new ResizeObserver(() => { size = undefined; redraw(); });
  resized.observe(list);
  const offTheme = onTheme(() => { colours = ink(); redraw(); });
  const ticking = setInterval(redraw, 1000);
  return () => {
    stop.abort();
    offRobots();
    offState();
    clearTimeout(silence);
    resized.disconnect();
    offTheme();
    clearInterval(ticking);
    cancelAnimationFrame(frame);
    sight.disconnect();
  };
};

function filledIn({ element }: Row): Parts {
  const parts: Parts = {
    state: h('span', { class: 'fleet-state' }), trouble: h('span', { class: 'fleet-trouble' }),
    canvas: h('canvas', { class: 'fleet-spark', 'aria-hidden': 'true' }),
    score: h('span', { class: 'fleet-score' }), limit: h('span', { class: 'muted' }), age: h('span', { class: 'fleet-age' }),
  };
  element.append(parts.state, parts.trouble, parts.canvas,
    h('span', { class: 'fleet-value' }, h('span', { class: 'visually-hidden' }, 'Score '), parts.score,
      h('span', { class: 'muted' }, ' / '), parts.limit),
    parts.age);
  return parts;
}

function refresh(row: Row, parts: Parts): void {
  const { robot } = row;
  if (row.shown !== robot.state) {
    fill(parts.state, badge(robot.state));
    row.shown = robot.state;
  }
  tellTrouble(parts.trouble, robot);
  const { score, threshold } = alarmScore(robot);
  setText(parts.score, scoreText(score));
  parts.score.classList.toggle('is-above', score !== undefined && threshold !== undefined && score > threshold);
  setText(parts.limit, threshold === undefined ? 'learning' : scoreText(threshold));
  setText(parts.age, duration(age(robot.lastScanAt)));
  row.dirty = false;
}

function tellTrouble(element: HTMLElement, { trouble, incidentId }: RobotUpdate): void {
  const key = incidentId ?? trouble ?? '';
  if (element.dataset['key'] === key) return;
  element.dataset['key'] = key;
  fill(element, incidentId ? h('a', { href: link('incidents', incidentId) }, 'Open incident') : trouble && words(trouble));
}

/** The last minutes as stored; their times are the robot's, so they are moved to the service's clock. */
async function loadHistory({ robot, trace }: Row, signal: AbortSignal): Promise<void> {
  const { lastScore, lastScanAt } = await get<Robot>(at('/api/v1/robots', robot.id), signal);
  if (!lastScore) return;
  const robotNow = Date.parse(lastScore.time);
  const ahead = (robotNow - Date.parse(lastScanAt)) / 1000;
  const { buckets } = await get<{ buckets: ScoreBucket[] }>(at('/api/v1/robots', robot.id, 'scores',
    { from: new Date(robotNow - SPAN_S * 1000).toISOString(), resolution: HISTORY_RESOLUTION_S }), signal);
  const times: number[] = [];
  const scores: number[] = [];
  for (const bucket of buckets) {
    const spread = bucket.motionConfirmed ?? bucket.motion ?? bucket.score;
    if (!spread) continue;
    times.push(Date.parse(bucket.time) / 1000 + HISTORY_RESOLUTION_S / 2 - ahead);
    scores.push(spread.max);
  }
  times.pop(); // the last bucket is not over yet
  scores.pop();
  trace.addHistory(times, scores);
}
