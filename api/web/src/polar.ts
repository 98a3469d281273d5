// SPDX-License-Identifier: Apache-2.0
// Scans as their lidar saw them, from above: the robot in the middle, ahead is up.
import { h } from './dom';
import type { LaserScan, Pose } from './rest';
import { colour, onTheme } from './theme';

/** Metres; x ahead, y to the left. */
export type Point = [number, number];

export interface Layer {
  name: string; // in the legend
  scan: LaserScan;
  colour: string; // a custom property: '--after'
  pose?: Pose; // of the scan in the frame that is drawn
}

export interface Painter {
  context: CanvasRenderingContext2D; // in CSS pixels
  at(point: Point): Point; // where it is drawn
}

export interface Polar {
  element: HTMLElement;
  /** `over` paints on top of the layers. */
  draw(layers: Layer[], over?: (painter: Painter) => void): void;
  dispose(): void;
}

/** Where each beam hit, by index; null where it hit nothing. */
export function beamPoints(scan: LaserScan, pose: Pose = { x: 0, y: 0, theta: 0 }): (Point | null)[] {
  return scan.ranges.map((range, beam) => {
    if (range === null || range < scan.range_min || range > scan.range_max) return null;
    const angle = scan.angle_min + beam * scan.angle_increment + pose.theta;
    return [pose.x + range * Math.cos(angle), pose.y + range * Math.sin(angle)];
  });
}

/** `label` says to whom cannot see it what is drawn. */
export function polar(label: string): Polar {
  const canvas = h('canvas', { class: 'polar-canvas', role: 'img', 'aria-label': label });
  const legend = h('ul', { class: 'legend' });
  const element = h('figure', { class: 'polar' }, canvas, legend);
  let layers: Layer[] = [];
  let over: ((painter: Painter) => void) | undefined;
  let reach = 0;
  let frame = 0;

  const paint = () => {
    frame = 0;
    const size = canvas.clientWidth;
    const context = canvas.getContext('2d');
    if (size === 0 || !context) return;
    fit(canvas, context, size, size);
    const points = layers.map(({ scan, pose }) => beamPoints(scan, pose));
    reach = steady(reach, farthest(points.flat()));
    const scale = (size / 2 - 8) / reach;
    const at = ([x, y]: Point): Point => [size / 2 - y * scale, size / 2 - x * scale];
    rings(context, size, reach, scale);
    layers.forEach((layer, i) => dots(context, points[i]!, at, colour(layer.colour), size));
    robot(context, at([0, 0]), 0);
    over?.({ context, at });
  };
  const ask = () => { frame ||= requestAnimationFrame(paint); };
  const resized = new ResizeObserver(ask);
  resized.observe(canvas);
  const off = onTheme(() => { tell(legend, layers); ask(); });

  return {
    element,
    draw(next, paintOver) {
      const isSame = next.map(key).join() === layers.map(key).join();
      layers = next;
      over = paintOver;
      if (!isSame) tell(legend, layers);
      ask();
    },
    dispose() {
      cancelAnimationFrame(frame);
      resized.disconnect();
      off();
    },
  };
}

const key = (layer: Layer) => `${layer.name} ${layer.colour}`;

/** Sharp on every screen, and empty. */
export function fit(canvas: HTMLCanvasElement, context: CanvasRenderingContext2D, width: number, height: number): void {
  const ratio = devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
}

function tell(legend: HTMLElement, layers: Layer[]): void {
  legend.replaceChildren(...layers.map((layer) => {
    const swatch = h('span', { class: 'swatch' });
    swatch.style.background = colour(layer.colour);
    return h('li', {}, swatch, layer.name);
  }));
}

function farthest(points: (Point | null)[]): number {
  let square = 0;
  for (const point of points) {
    if (point) square = Math.max(square, point[0] ** 2 + point[1] ** 2);
  }
  return Math.sqrt(square) || 1;
}

/** Changes seldom, so that a live picture does not breathe. */
function steady(before: number, needed: number): number {
  return needed > before || needed < 0.6 * before ? needed * 1.08 : before;
}

/** 1, 2 or 5 times a power of ten, for about three rings. */
function ringStep(reach: number): number {
  const rough = reach / 3;
  const power = 10 ** Math.floor(Math.log10(rough));
  return ([1, 2, 5].find((step) => step * power >= rough) ?? 10) * power;
}

function rings(context: CanvasRenderingContext2D, size: number, reach: number, scale: number): void {
  const step = ringStep(reach);
  context.strokeStyle = colour('--line');
  context.fillStyle = colour('--muted');
  context.font = '11px system-ui, sans-serif';
  context.lineWidth = 1;
  for (let radius = step; radius * scale < size / 2; radius += step) {
    context.beginPath();
    context.arc(size / 2, size / 2, radius * scale, 0, 2 * Math.PI);
    context.stroke();
    const y = size / 2 + radius * scale;
    if (y < size - 4) context.fillText(`${Number(radius.toPrecision(2))} m`, size / 2 + 4, y - 4);
  }
}

function dots(context: CanvasRenderingContext2D, points: (Point | null)[], at: (point: Point) => Point,
  style: string, size: number): void {
  const side = Math.max(2, size / 140);
  context.fillStyle = style;
  for (const point of points) {
    if (!point) continue;
    const [x, y] = at(point);
    context.fillRect(x - side / 2, y - side / 2, side, side);
  }
}

/** An arrow where a robot is, `theta` to the left of up. */
export function robot(context: CanvasRenderingContext2D, [x, y]: Point, theta: number, style = colour('--text')): void {
  context.save();
  context.translate(x, y);
  context.rotate(-theta);
  context.fillStyle = style;
  context.beginPath();
  context.moveTo(0, -9);
  context.lineTo(6, 7);
  context.lineTo(0, 3.5);
  context.lineTo(-6, 7);
  context.fill();
  context.restore();
}
