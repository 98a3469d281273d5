// SPDX-License-Identifier: Apache-2.0
// Scores against their threshold over time, the robot's states below, incidents as marks above.
import uPlot from 'uplot';
import { h, localTime, number, scoreText, setText } from './dom';
import type { Series } from './series';
import { colour, onTheme } from './theme';

export interface Mark {
  time: number; // seconds since 1970
  href: string;
  label: string;
}

export interface ScorePlot {
  element: HTMLElement;
  /** `from` and `to`, in seconds, are what the axis shows; `threshold` draws a line of its own. */
  show(series: Series, marks?: Mark[], axis?: { from: number; to: number }, threshold?: number): void;
  dispose(): void;
}

export interface PlotOptions {
  label: string;
  height?: number;
  /** A stretch was dragged over: seconds since 1970. */
  onZoom?: (from: number, to: number) => void;
  /** Where marks lead that are too near each other to be told apart. */
  hrefOfMany?: (from: number, to: number) => string;
}

interface Shown {
  series: Series;
  marks: Mark[];
  axis?: { from: number; to: number };
  threshold?: number;
}

/** What is drawn with the same lines. */
const shape = ({ series, threshold }: Shown) => `${series.kind} ${series.resolution > 0} ${threshold !== undefined}`;

const BAND_HEIGHT = 7;
const BAND_GAP = 4;
const NEAR_PX = 20;

export function scorePlot(options: PlotOptions): ScorePlot {
  const holder = h('div', { class: 'plot-holder' });
  const summary = h('figcaption', { class: 'visually-hidden' });
  const element = h('figure', { class: 'plot', 'aria-label': options.label }, holder, summary);
  let chart: uPlot | undefined;
  let shown: Shown | undefined;

  const build = () => {
    chart?.destroy();
    chart = undefined;
    if (!shown || holder.clientWidth === 0) return;
    chart = new uPlot(settings(options, () => shown!, holder.clientWidth), columns(shown), holder);
  };
  const resized = new ResizeObserver(() => {
    if (!chart) build();
    else if (chart.width !== holder.clientWidth) chart.setSize({ width: holder.clientWidth, height: chart.height });
  });
  resized.observe(holder);
  const off = onTheme(build);

  return {
    element,
    show(series, marks = [], axis, threshold) {
      if (chart && chart.select.width > 0) return; // somebody drags over it
      const old = shown;
      shown = { series, marks, axis, threshold };
      setText(summary, told(series));
      if (!chart || !old || shape(old) !== shape(shown)) {
        build();
      } else {
        chart.setData(columns(shown));
      }
    },
    dispose() {
      resized.disconnect();
      off();
      chart?.destroy();
    },
  };
}

/** The plot in a sentence. */
function told({ time, max, threshold }: Series): string {
  let peak = -1;
  max.forEach((value, i) => { if (value !== null && (peak < 0 || value > max[peak]!)) peak = i; });
  if (peak < 0) return 'No scores in this time.';
  const limit = threshold.findLast((value) => value !== null);
  return `The highest score is ${number(max[peak])} at ${localTime(new Date(time[peak]! * 1000))}; the threshold is ${
    number(limit)}.`;
}

function columns({ series, threshold }: Shown): uPlot.AlignedData {
  const wanted = series.time.map(() => threshold ?? null);
  return [series.time, series.min, series.max, series.mean, series.confirmed, series.threshold, wanted];
}

function settings(options: PlotOptions, shown: () => Shown, width: number): uPlot.Options {
  const { series, threshold } = shown();
  const isBuckets = series.resolution > 0;
  const value = (_: uPlot, raw: number | null) => scoreText(raw);
  const axis: uPlot.Axis = {
    stroke: colour('--muted'), grid: { stroke: colour('--line'), width: 1 }, ticks: { stroke: colour('--line'), size: 4 },
    font: '12px system-ui, sans-serif',
  };
  const line = (label: string, stroke: string, more: Partial<uPlot.Series> = {}): uPlot.Series =>
    ({ label, stroke: colour(stroke), width: 1.5, value, points: { show: false }, ...more });
  return {
    width, height: options.height ?? 280,
    padding: [18, 10, 0, 0],
    legend: { live: true },
    cursor: { drag: { x: true, y: false, setScale: false }, points: { size: 6 } },
    scales: {
      x: { range: (_, least, most) => [shown().axis?.from ?? least, shown().axis?.to ?? most] },
      y: { range: (_, __, most) => [0, highest(most, shown())] },
    },
    bands: [{ series: [2, 1], fill: colour('--band') }],
    axes: [{ ...axis, gap: BAND_HEIGHT + 2 * BAND_GAP + 2, values: clockTicks }, { ...axis, size: 52, values: (_, ticks) => ticks.map((tick) => number(tick)) }],
    series: [
      { label: 'Time', value: (_, raw) => raw === null ? '–' : localTime(new Date(raw * 1000)) },
      line('Lowest', '--accent', { width: 0, show: isBuckets }),
      line(isBuckets ? 'Highest' : 'Score', '--accent', { points: { show: () => shown().series.time.length < 150, size: 4 } }),
      line('Mean', '--before', { width: 1, show: isBuckets, dash: [2, 3] }),
      line('Confirmed', '--seen', { show: series.kind === 'motion' }),
      line('Threshold', '--kidnapped', { dash: [6, 4] }),
      line('Proposed', '--suspect', { show: threshold !== undefined, dash: [3, 3] }),
    ],
    hooks: {
      draw: [(u) => states(u, shown().series), (u) => place(u, shown().marks, options)],
      setSelect: [(u) => selected(u, options.onZoom)],
    },
  };
}

/** A little above the highest score and threshold. */
function highest(most: number | null, { series, threshold = 0 }: Shown): number {
  const limit = Math.max(threshold, ...series.threshold.map((one) => one ?? 0));
  return 1.08 * Math.max(most ?? 0, 1.25 * limit, 1e-3);
}

function clockTicks(_: uPlot, ticks: number[], __: number, ___: number, step: number): string[] {
  let lastDay = '';
  return ticks.map((tick) => {
    const time = new Date(tick * 1000);
    const day = time.toLocaleDateString(undefined, { month: 'short', day: 'numeric' });
    const isNew = day !== lastDay;
    lastDay = day;
    if (step >= 86400) return day;
    const text = time.toLocaleTimeString(undefined, {
      hour: '2-digit', minute: '2-digit', second: step < 60 ? '2-digit' : undefined, hourCycle: 'h23' });
    return isNew && ticks.length > 1 && time.getHours() === 0 ? `${text}\n${day}` : text;
  });
}

/** The robot's state over time, in the gap between plot and axis. */
function states(u: uPlot, { time, state, resolution }: Series): void {
  const ratio = uPlot.pxRatio;
  const top = u.bbox.top + u.bbox.height + BAND_GAP * ratio;
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(u.bbox.left, top, u.bbox.width, BAND_HEIGHT * ratio);
  u.ctx.clip();
  for (let i = 0; i < time.length;) {
    let end = i + 1;
    while (end < time.length && state[end] === state[i]) end++;
    const from = u.valToPos(time[i]!, 'x', true);
    const to = u.valToPos(time[end] ?? time[end - 1]! + (resolution || 1), 'x', true);
    if (state[i]) {
      u.ctx.fillStyle = colour(`--${state[i]}`);
      u.ctx.fillRect(from, top, Math.max(to - from, 2 * ratio), BAND_HEIGHT * ratio);
    }
    i = end;
  }
  u.ctx.restore();
}

function selected(u: uPlot, onZoom: PlotOptions['onZoom']): void {
  const { left, width } = u.select;
  if (width < 4) return;
  u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  onZoom?.(u.posToVal(left, 'x'), u.posToVal(left + width, 'x'));
}

/** Links above the plot; those too near each other become one with a count. Elements are kept, and with
 * them the focus. */
function place(u: uPlot, marks: Mark[], options: PlotOptions): void {
  const placed = marks.map((mark) => ({ ...mark, x: u.valToPos(mark.time, 'x') }))
    .filter(({ x }) => x >= 0 && x <= u.over.clientWidth).sort((a, b) => a.x - b.x);
  const elements = [...u.over.querySelectorAll<HTMLAnchorElement>('.mark')];
  let used = 0;
  for (let i = 0; i < placed.length;) {
    let end = i + 1;
    while (end < placed.length && placed[end]!.x - placed[i]!.x < NEAR_PX) end++;
    const element = elements[used++] ?? u.over.appendChild(h('a', { class: 'mark' }));
    point(element, placed.slice(i, end), options);
    i = end;
  }
  elements.slice(used).forEach((element) => element.remove());
}

function point(element: HTMLAnchorElement, marks: (Mark & { x: number })[], { hrefOfMany }: PlotOptions): void {
  const first = marks[0]!;
  const last = marks.at(-1)!;
  const isMany = marks.length > 1 && hrefOfMany !== undefined;
  const label = isMany ? `${marks.length} incidents` : first.label;
  element.href = isMany ? hrefOfMany(first.time, last.time) : first.href;
  element.title = label;
  element.setAttribute('aria-label', label);
  setText(element, isMany ? String(marks.length) : '');
  element.style.left = `${(first.x + last.x) / 2}px`;
}
