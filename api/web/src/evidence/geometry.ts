// SPDX-License-Identifier: Apache-2.0
// Where the scan after is laid in the frame of the one before, and such poses in words.
import type { Evidence, Pose } from '../rest';

export const ORIGIN: Pose = { x: 0, y: 0, theta: 0 };

/** Where the scan after is laid: as the lidar saw it move, as the wheels told it, or nowhere else. */
export type Laid = 'seen' | 'told' | 'raw';

export function poseOf({ motion }: Evidence, laid: Laid): Pose | undefined {
  return laid === 'raw' ? ORIGIN : motion?.[laid];
}

/** "1.34 m ahead to the left, turned 45° to the left". */
export function inWords({ x, y, theta }: Pose): string {
  const metres = Math.hypot(x, y);
  const degrees = (((theta * 180) / Math.PI + 540) % 360) - 180;
  const where = metres < 0.005 ? 'no move' : `${metres.toFixed(2)} m ${direction(x, y)}`;
  const side = degrees > 0 ? 'left' : 'right';
  const turn = Math.abs(degrees) < 0.5 ? 'no turn' : `turned ${Math.abs(degrees).toFixed(0)}° ${side}`;
  return `${where}, ${turn}`;
}

function direction(x: number, y: number): string {
  const octants = ['ahead', 'ahead to the left', 'to the left', 'back to the left', 'back',
    'back to the right', 'to the right', 'ahead to the right'];
  return octants[Math.round((Math.atan2(y, x) * 4) / Math.PI + 8) % 8]!;
}
