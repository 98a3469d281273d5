// SPDX-License-Identifier: Apache-2.0
// What all detectors said around the moment: a small plot each, over one time.
import uPlot from 'uplot';
import { h, number, setText } from '../dom';
import type { Evidence, Incident, Score } from '../rest';
import { colour, onTheme } from '../theme';

const HEIGHT_PX = 130;
const CARRY_ALARM = 30; // MotionScore.carry in api/openapi.yaml

interface Trace {
  title: string;
  values: (number | undefined)[];
  limits: (number | undefined)[];
}

const NAMES: Record<string, string> = {
  ndt_qe: 'NDT Qe', ndt_qs: 'NDT Qs', ndt_qh: 'NDT Qh', ndt_qo: 'NDT Qo',
  mcw: 'Maximum current weight', me: 'Measurement entropy',
};

export function traces(scores: Score[]): Trace[] {
  const none = scores.map(() => undefined);
  const motionLimit = scores.map(({ motion }) => motion?.threshold);
  const others = [...new Set(scores.flatMap(({ detectors }) => Object.keys(detectors ?? {})))].sort();
  const all: Trace[] = [
    { title: 'Motion, confirmed by the next scan', limits: motionLimit,
      values: scores.map(({ motion }) => motion?.confirmed) },
    { title: 'Motion, of the scan alone', limits: motionLimit,
      values: scores.map(({ motion }) => motion?.score) },
    { title: 'QS-2DDTW', limits: scores.map(({ threshold }) => threshold),
      values: scores.map(({ score }) => score) },
    { title: 'Carry', limits: scores.map(({ motion }) => motion && CARRY_ALARM),
      values: scores.map(({ motion }) => motion?.carry) },
    ...others.map((name) => ({ title: NAMES[name] ?? name.toUpperCase(), limits: none,
      values: scores.map(({ detectors }) => detectors?.[name]) })),
  ];
  return all.filter(({ values }) => values.some((value) => value !== undefined));
}

/** The value at the scan after the jump, or at the one that confirmed it. */
function inWords({ title, values, limits }: Trace, scores: Score[], incident: Incident): string {
  const at = (time: string) => scores.findIndex((score) => score.time === time);
  const [jump, confirmed] = [at(incident.afterTime), at(incident.scanTime)];
  const before = values.slice(0, Math.max(jump, 0)).filter((one): one is number => one !== undefined);
  const highest = before.length > 0 ? `, at most ${number(Math.max(...before))} before` : '';
  const limit = limits[jump];
  return `${title}: ${number(values[jump])} at the jump, ${number(values[confirmed])} when it was ` +
    `confirmed${highest}${limit === undefined ? '' : `; threshold ${number(limit)}`}`;
}

/** Fills `root`; returns how to stop. */
export function scorePlots(root: HTMLElement, { scores }: Evidence, incident: Incident): () => void {
  const jump_ms = Date.parse(incident.afterTime);
  const seconds = scores.map(({ time }) => (Date.parse(time) - jump_ms) / 1000);
  const sync = uPlot.sync(`incident-${incident.id}`);
  root.replaceChildren();
  const panels = traces(scores).map((trace) => {
    const value = h('span', { class: 'muted' });
    const box = h('div', { role: 'img', 'aria-label': inWords(trace, scores, incident) });
    root.append(h('figure', { class: 'score-plot' },
      h('figcaption', {}, h('b', {}, trace.title), ' ', value), box));
    return new Panel(box, trace, seconds, value, sync.key);
  });
  const resized = new ResizeObserver(() => panels.forEach((panel) => panel.resize()));
  resized.observe(root);
  const stopTheme = onTheme(() => panels.forEach((panel) => panel.build()));
  return () => {
    resized.disconnect();
    stopTheme();
    panels.forEach((panel) => panel.stop());
  };
}

class Panel {
  private plot?: uPlot;
  private readonly jump: number;

  constructor(private readonly box: HTMLElement, private readonly trace: Trace,
    private readonly seconds: number[], private readonly value: HTMLElement,
    private readonly key: string) {
    this.jump = Math.max(seconds.findIndex((second) => second >= 0), 0);
    this.build();
  }

  build(): void {
    this.stop();
    const { values, limits } = this.trace;
    const none = (all: (number | undefined)[]) => all.map((one) => one ?? null);
    this.plot = new uPlot(this.options(), [this.seconds, none(values), none(limits)], this.box);
  }

  resize(): void {
    this.plot?.setSize({ width: this.box.clientWidth, height: HEIGHT_PX });
  }

  stop(): void {
    this.plot?.destroy();
    this.plot = undefined;
  }

  private options(): uPlot.Options {
    const axis = { stroke: colour('--muted'), grid: { stroke: colour('--line'), width: 1 },
      ticks: { stroke: colour('--line'), width: 1, size: 4 } };
    return {
      width: this.box.clientWidth || 300, height: HEIGHT_PX, legend: { show: false },
      cursor: { sync: { key: this.key }, y: false, points: { size: 7 } },
      scales: { x: { time: false }, y: { range: (_, low, high) => this.range(low, high) } },
      axes: [
        { ...axis, size: 24, values: (_, ticks) => ticks.map((tick) => `${tick > 0 ? '+' : ''}${tick} s`) },
        { ...axis, size: 44, space: 28 },
      ],
      series: [
        {},
        { stroke: colour('--after'), width: 1.5, points: { show: false } },
        { stroke: colour('--kidnapped'), width: 1.5, dash: [5, 4], points: { show: false } },
      ],
      hooks: { draw: [markJump], setCursor: [(plot) => this.tell(plot.cursor.idx)] },
    };
  }

  /** From nothing to what is highest, threshold and all, with room above. */
  private range(low: number, high: number): [number, number] {
    return [Math.min(0, low), 1.1 * Math.max(high, low + 1e-6)];
  }

  private tell(index: number | null | undefined): void {
    const limit = this.trace.limits[index ?? this.jump];
    const of = limit === undefined ? '' : `, threshold ${number(limit)}`;
    setText(this.value, index === null || index === undefined ? (of && of.slice(2))
      : `${number(this.trace.values[index])} at ${this.seconds[index]!.toFixed(1)} s${of}`);
  }
}

function markJump(plot: uPlot): void {
  const x = Math.round(plot.valToPos(0, 'x', true)) + 0.5;
  const { top, height } = plot.bbox;
  plot.ctx.save();
  plot.ctx.strokeStyle = colour('--text');
  plot.ctx.setLineDash([2, 3]);
  plot.ctx.beginPath();
  plot.ctx.moveTo(x, top);
  plot.ctx.lineTo(x, top + height);
  plot.ctx.stroke();
  plot.ctx.restore();
}
