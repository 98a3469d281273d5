// SPDX-License-Identifier: Apache-2.0
// Both scans of an incident over each other, what the warping matched, and what cannot be.
import { h } from '../dom';
import { beamPoints, fit, robot, type Point } from '../polar';
import type { Evidence, Pose } from '../rest';
import { colour, onTheme } from '../theme';

export interface Shown {
  evidence: Evidence;
  /** Of the scan after, in the frame of the one before. */
  pose: Pose;
  warping: boolean;
  violations: boolean;
  /** The step of the warping to be pointed at. */
  step?: number;
}

/** Dear steps are drawn last, over the cheap ones. */
export const COSTS = ['--cost-0', '--cost-1', '--cost-2', '--cost-3', '--cost-4'];
const MARGIN = 0.06;
const ORIGIN: Point = [0, 0];

/** Which of the five colours. */
export function costClass(cost: number, dearest: number): number {
  return Math.min(COSTS.length - 1, Math.floor((COSTS.length * cost) / (dearest || 1)));
}

export class Picture {
  readonly element = h('canvas', { class: 'picture', role: 'img' });
  private shown?: Shown;
  private readonly resized = new ResizeObserver(() => this.draw());
  private readonly stopTheme = onTheme(() => this.draw());

  constructor() {
    this.resized.observe(this.element);
  }

  /** `words` is what is to be seen, for who does not. */
  show(shown: Shown, words: string): void {
    this.shown = shown;
    this.element.setAttribute('aria-label', words);
    this.draw();
  }

  stop(): void {
    this.resized.disconnect();
    this.stopTheme();
  }

  private draw(): void {
    if (!this.shown || this.element.clientWidth === 0) return;
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    const context = this.element.getContext('2d')!;
    fit(this.element, context, width, height);
    drawAll(context, width, height, this.shown);
  }
}

type ToScreen = (point: Point) => Point;
type Beams = (Point | null)[];

function drawAll(context: CanvasRenderingContext2D, width: number, height: number, shown: Shown): void {
  const { evidence, pose } = shown;
  const before = beamPoints(evidence.before);
  const after = beamPoints(evidence.after, pose);
  const here: Point = [pose.x, pose.y];
  const all = [...before, ...after, ORIGIN, here].filter((one): one is Point => one !== null);
  const { to, scale } = fitted(all, width, height);
  rings(context, to, scale, Math.max(...all.map(([x, y]) => Math.hypot(x, y))));
  if (shown.warping) warping(context, to, evidence, before, after);
  dots(context, to, before, '--before', 2);
  dots(context, to, after, '--after', 2);
  if (shown.violations) {
    violations(context, to, pick(before, evidence.motion?.violating.before));
    violations(context, to, pick(after, evidence.motion?.violating.after));
  }
  robot(context, to(ORIGIN), 0, colour('--before'));
  robot(context, to(here), pose.theta, colour('--after'));
  if (shown.step !== undefined) pointAt(context, to, evidence, before, after, shown.step);
  scaleBar(context, width, height, scale);
}

/** The robot before is looking up: x is up, y to the left. */
function fitted(all: Point[], width: number, height: number): { to: ToScreen; scale: number } {
  const [xs, ys] = [all.map(([x]) => x), all.map(([, y]) => y)];
  const [top, bottom] = [Math.max(...xs), Math.min(...xs)];
  const [left, right] = [Math.max(...ys), Math.min(...ys)];
  const room = 1 - 2 * MARGIN;
  const scale = Math.min((room * width) / (left - right || 1), (room * height) / (top - bottom || 1));
  const [cx, cy] = [(left + right) / 2, (top + bottom) / 2];
  return { scale, to: ([x, y]) => [width / 2 - (y - cx) * scale, height / 2 - (x - cy) * scale] };
}

function ringStep_m(scale: number): number {
  return [0.5, 1, 2, 5, 10, 20, 50].find((metres) => metres * scale >= 45) ?? 100;
}

function rings(context: CanvasRenderingContext2D, to: ToScreen, scale: number, farthest_m: number): void {
  const [x, y] = to(ORIGIN);
  const step_m = ringStep_m(scale);
  context.strokeStyle = colour('--line');
  context.lineWidth = 1;
  for (let metres = step_m; metres <= farthest_m + step_m; metres += step_m) {
    context.beginPath();
    context.arc(x, y, metres * scale, 0, 2 * Math.PI);
    context.stroke();
  }
}

function dots(context: CanvasRenderingContext2D, to: ToScreen, all: Beams, name: string,
  radius: number): void {
  context.fillStyle = colour(name);
  context.beginPath();
  for (const one of all) {
    if (!one) continue;
    const [x, y] = to(one);
    context.moveTo(x + radius, y);
    context.arc(x, y, radius, 0, 2 * Math.PI);
  }
  context.fill();
}

function warping(context: CanvasRenderingContext2D, to: ToScreen, { warping: path }: Evidence,
  before: Beams, after: Beams): void {
  if (!path) return;
  const dearest = Math.max(...path.steps.map(([, , cost]) => cost));
  COSTS.forEach((name, wanted) => {
    context.strokeStyle = colour(name);
    context.lineWidth = wanted === 0 ? 0.75 : 1;
    context.beginPath();
    for (const [i, j, cost] of path.steps) {
      const [from, onto] = [before[i], after[j]];
      if (!from || !onto || costClass(cost, dearest) !== wanted) continue;
      context.moveTo(...to(from));
      context.lineTo(...to(onto));
    }
    context.stroke();
  });
}

function pick(all: Beams, beams: number[] = []): Beams {
  return beams.map((beam) => all[beam] ?? null);
}

/** Rings around the points, so that they differ by more than their colour. */
function violations(context: CanvasRenderingContext2D, to: ToScreen, all: Beams): void {
  context.strokeStyle = colour('--kidnapped');
  context.lineWidth = 1.2;
  context.beginPath();
  for (const one of all) {
    if (!one) continue;
    const [x, y] = to(one);
    context.moveTo(x + 3.5, y);
    context.arc(x, y, 3.5, 0, 2 * Math.PI);
  }
  context.stroke();
}

function pointAt(context: CanvasRenderingContext2D, to: ToScreen, { warping: path }: Evidence,
  before: Beams, after: Beams, step: number): void {
  const found = path?.steps[step];
  const [from, onto] = [found && before[found[0]], found && after[found[1]]];
  if (!from || !onto) return;
  context.strokeStyle = colour('--text');
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(...to(from));
  context.lineTo(...to(onto));
  context.stroke();
  dots(context, to, [from], '--before', 5);
  dots(context, to, [onto], '--after', 5);
}

function scaleBar(context: CanvasRenderingContext2D, width: number, height: number, scale: number): void {
  const metres = ringStep_m(scale);
  const [right, y] = [width - 12, height - 12];
  context.strokeStyle = colour('--muted');
  context.fillStyle = colour('--muted');
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(right - metres * scale, y - 4);
  context.lineTo(right - metres * scale, y);
  context.lineTo(right, y);
  context.lineTo(right, y - 4);
  context.stroke();
  context.font = '12px system-ui, sans-serif';
  context.textAlign = 'right';
  context.fillText(`${metres} m`, right, y - 7);
}
