// SPDX-License-Identifier: Apache-2.0
// Scans as points in the plane, and one scan laid into the other's frame.
import type { Evidence, LaserScan, Pose } from '../rest';

/** Metres; x forward, y to the left (REP 103). */
export interface Point {
  x: number;
  y: number;
}

export const ORIGIN: Pose = { x: 0, y: 0, theta: 0 };

export function angle(scan: LaserScan, beam: number): number {
  return scan.angle_min + beam * scan.angle_increment;
}

/** Of the beam; undefined where it hit nothing. */
export function point(scan: LaserScan, beam: number): Point | undefined {
  const range = scan.ranges[beam];
  if (range === null || range === undefined) return undefined;
  if (range < scan.range_min || range > scan.range_max) return undefined;
  const at = angle(scan, beam);
  return { x: range * Math.cos(at), y: range * Math.sin(at) };
}

/** By beam. */
export function points(scan: LaserScan): (Point | undefined)[] {
  return scan.ranges.map((_, beam) => point(scan, beam));
}

/** A point of the frame that is at `pose`. */
export function placed({ x, y }: Point, pose: Pose): Point {
  const [c, s] = [Math.cos(pose.theta), Math.sin(pose.theta)];
  return { x: pose.x + c * x - s * y, y: pose.y + s * x + c * y };
}

/** Where the scan after is laid: as the lidar saw it move, as the wheels told it, or nowhere else. */
export type Laid = 'seen' | 'told' | 'raw';

export function poseOf({ motion }: Evidence, laid: Laid): Pose | undefined {
  return laid === 'raw' ? ORIGIN : motion?.[laid];
}

/** "1.34 m ahead to the left, turned 45° to the left". */
export function inWords({ x, y, theta }: Pose): string {
  const metres = Math.hypot(x, y);
  const degrees = (((theta * 180) / Math.PI + 540) % 360) - 180;
  const where = metres < 0.005 ? 'no way' : `${metres.toFixed(2)} m ${direction(x, y)}`;
  const side = degrees > 0 ? 'left' : 'right';
  const turn = Math.abs(degrees) < 0.5 ? 'no turn' : `turned ${Math.abs(degrees).toFixed(0)}° ${side}`;
  return `${where}, ${turn}`;
}

function direction(x: number, y: number): string {
  const octants = ['ahead', 'ahead to the left', 'to the left', 'back to the left', 'back',
    'back to the right', 'to the right', 'ahead to the right'];
  return octants[Math.round((Math.atan2(y, x) * 4) / Math.PI + 8) % 8]!;
}
