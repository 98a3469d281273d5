// SPDX-License-Identifier: Apache-2.0
// Past incidents by their score, a row for each label, and the threshold as a line to be dragged.
import { fill, number, svg, words } from '../dom';
import { link } from '../page';
import type { Incident } from '../rest';
import type { Scale } from './threshold';

export interface Marks {
  scale: Scale;
  threshold: number;
  inForce?: number;
  incidents: Incident[];
  /** Scores of what would be new. */
  raised: { robotId: string; score: number }[];
}

const ROWS = ['kidnapping', 'test', 'not labelled', 'false_alarm', 'new'];
const ROW_PX = 30;
const LEFT_PX = 96;
const AXIS_PX = 26;
const TOP_PX = 18;
const HEIGHT_PX = TOP_PX + ROWS.length * ROW_PX + AXIS_PX;

/** Only for the eye: the text beside it says the same. `moved` is told where the line is dragged. */
export class Strip {
  readonly element = svg('svg', { class: 'strip', 'aria-hidden': 'true', height: HEIGHT_PX });
  private readonly resized = new ResizeObserver(() => this.draw());
  private marks?: Marks;

  constructor(private readonly moved?: (threshold: number) => void) {
    this.resized.observe(this.element);
    if (moved) {
      this.element.classList.add('strip-movable');
      this.element.addEventListener('pointerdown', (event) => this.press(event));
      this.element.addEventListener('pointermove', (event) => this.drag(event));
    }
  }

  show(marks: Marks): void {
    this.marks = marks;
    this.draw();
  }

  stop(): void {
    this.resized.disconnect();
  }

  private get width(): number {
    return Math.max(this.element.clientWidth, 200);
  }

  private x(value: number): number {
    return LEFT_PX + this.marks!.scale.position(value) * (this.width - LEFT_PX - 14);
  }

  private press(event: PointerEvent): void {
    if ((event.target as Element).closest('a')) return; // a dot is a link
    this.element.setPointerCapture(event.pointerId);
    this.drag(event);
  }

  private drag(event: PointerEvent): void {
    if (!this.marks || !this.element.hasPointerCapture(event.pointerId)) return;
    const x = event.clientX - this.element.getBoundingClientRect().left;
    this.moved!(this.marks.scale.value((x - LEFT_PX) / (this.width - LEFT_PX - 14)));
  }

  private draw(): void {
    if (!this.marks) return;
    const { incidents, raised, threshold, inForce } = this.marks;
    this.element.setAttribute('viewBox', `0 0 ${this.width} ${HEIGHT_PX}`);
    fill(this.element, this.grid(),
      incidents.map((incident, i) => this.dot(incident, i)),
      raised.map(({ robotId, score }, i) => this.cross(robotId, score, i)),
      inForce !== undefined && this.line(inForce, 'strip-now', 'in force'),
      this.line(threshold, 'strip-threshold', number(threshold)));
  }

  private grid(): SVGElement[] {
    const bottom = HEIGHT_PX - AXIS_PX;
    const rows = ROWS.flatMap((row, i) => {
      const y = TOP_PX + i * ROW_PX;
      return [
        svg('line', { x1: 0, x2: this.width, y1: y, y2: y, class: 'strip-grid' }),
        svg('text', { x: 0, y: y + ROW_PX / 2 + 4, class: 'strip-text' }, words(row)),
      ];
    });
    const ticks = this.marks!.scale.ticks().flatMap((tick) => [
      svg('line', { x1: this.x(tick), x2: this.x(tick), y1: TOP_PX, y2: bottom,
        class: 'strip-grid' }),
      svg('text', { x: this.x(tick), y: HEIGHT_PX - 8, 'text-anchor': 'middle',
        class: 'strip-text' }, number(tick)),
    ]);
    return [...rows, ...ticks,
      svg('line', { x1: 0, x2: this.width, y1: bottom, y2: bottom, class: 'strip-grid' }),
      svg('text', { x: 0, y: HEIGHT_PX - 8, class: 'strip-text' }, 'score')];
  }

  private dot(incident: Incident, i: number): SVGElement {
    const row = ROWS.indexOf(incident.label ?? 'not labelled');
    const isKept = incident.score > this.marks!.threshold;
    return svg('a', { href: link('incidents', incident.id), tabindex: -1 },
      svg('title', {}, `${incident.robotId}: ${number(incident.score)}`),
      svg('circle', { cx: this.x(incident.score), cy: y(row, i), r: 5,
        class: `dot dot-${incident.label ?? 'none'} ${isKept ? '' : 'dot-lost'}` }));
  }

  private cross(robotId: string, score: number, i: number): SVGElement {
    const [cx, cy] = [this.x(score), y(ROWS.length - 1, i)];
    return svg('path', { d: `M${cx - 4} ${cy - 4}l8 8m-8 0l8 -8`, class: 'cross' },
      svg('title', {}, `${robotId}: ${number(score)}`));
  }

  private line(value: number, kind: string, text: string): SVGElement {
    const x = Math.min(Math.max(this.x(value), LEFT_PX), this.width - 8);
    const isLeft = kind === 'strip-now' || x > this.width - 70;
    return svg('g', { class: kind },
      svg('line', { x1: x, x2: x, y1: TOP_PX - 6, y2: HEIGHT_PX - AXIS_PX }),
      kind === 'strip-threshold' &&
        svg('rect', { x: x - 7, y: (TOP_PX + HEIGHT_PX - AXIS_PX) / 2 - 12, width: 14, height: 24,
          rx: 4 }),
      svg('text', { x: isLeft ? x - 5 : x + 5, y: TOP_PX - 5, 'text-anchor': isLeft ? 'end' : 'start',
        class: 'strip-text' }, text));
  }
}

/** Spread over the height of the row, so that dots do not hide each other. */
function y(row: number, i: number): number {
  return TOP_PX + row * ROW_PX + ROW_PX / 2 + (((i * 7) % 11) - 5) * 1.5;
}
