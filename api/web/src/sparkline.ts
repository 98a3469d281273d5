// SPDX-License-Identifier: Apache-2.0
// A small picture of a robot's last minutes: its score, its threshold, and where it went above.
import { fit } from './polar';
import { colour } from './theme';

export const SPAN_S = 600;
const MOST_POINTS = 720;

/** What is known of the last minutes: times in seconds, ascending. */
export class Trace {
  readonly times: number[] = [];
  readonly scores: number[] = [];
  threshold: number | undefined;

  add(time: number, score: number): void {
    const last = this.times.at(-1);
    if (last !== undefined && time <= last) return;
    this.times.push(time);
    this.scores.push(score);
    if (this.times.length > MOST_POINTS) {
      this.times.shift();
      this.scores.shift();
    }
  }

  /** What was stored, in place of everything up to its end: between two updates may be a spike. */
  addHistory(times: number[], scores: number[]): void {
    const end = times.at(-1) ?? -Infinity;
    const kept = this.times.findIndex((time) => time > end);
    const drop = kept < 0 ? this.times.length : kept;
    this.times.splice(0, drop, ...times);
    this.scores.splice(0, drop, ...scores);
  }
}

export interface Ink {
  line: string;
  idle: string; // while there is no threshold
  above: string;
  threshold: string;
}

export function ink(): Ink {
  return { line: colour('--accent'), idle: colour('--line-strong'), above: colour('--kidnapped'), threshold: colour('--line-strong') };
}

export interface Size {
  width: number;
  height: number;
}

/** Asking for it may lay the whole page out: where there are many, ask once. */
export function sizeOf(canvas: HTMLCanvasElement): Size {
  return { width: canvas.clientWidth, height: canvas.clientHeight };
}

/** Draws the `span` seconds before `now` (in seconds). */
export function draw(canvas: HTMLCanvasElement, trace: Trace, now: number, { line, idle, above, threshold }: Ink,
  { width, height }: Size, span = SPAN_S): void {
  const context = canvas.getContext('2d');
  if (!context || width === 0) return;
  fit(canvas, context, width, height);
  const { times, scores } = trace;
  const from = now - span;
  const limit = trace.threshold ?? 0;
  let most = 1.4 * limit;
  let first = times.length;
  while (first > 0 && times[first - 1]! >= from) most = Math.max(most, scores[--first]!);
  const x = (time: number) => ((time - from) / span) * width;
  const y = (score: number) => height - 2 - (score / (most || 1)) * (height - 4);
  if (limit > 0) {
    context.strokeStyle = threshold;
    context.setLineDash([3, 3]);
    stroke(context, () => { context.moveTo(0, y(limit)); context.lineTo(width, y(limit)); });
    context.setLineDash([]);
  }
  context.lineWidth = 1.5;
  context.lineJoin = 'round';
  context.strokeStyle = limit > 0 ? line : idle;
  const path = () => {
    for (let i = first; i < times.length; i++) {
      const gap = i === first || times[i]! - times[i - 1]! > 30;
      if (gap) context.moveTo(x(times[i]!), y(scores[i]!));
      else context.lineTo(x(times[i]!), y(scores[i]!));
    }
  };
  stroke(context, path);
  if (limit > 0 && most > 1.4 * limit) { // what is above the threshold, once more
    context.save();
    context.beginPath();
    context.rect(0, 0, width, y(limit));
    context.clip();
    context.strokeStyle = above;
    context.lineWidth = 2;
    stroke(context, path);
    context.restore();
  }
}

function stroke(context: CanvasRenderingContext2D, path: () => void): void {
  context.beginPath();
  path();
  context.stroke();
}
