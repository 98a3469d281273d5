// SPDX-License-Identifier: Apache-2.0
// What is tuned: whose threshold, of which detector, and where the configuration has it.
import type { ConfigLevel, DetectionConfig, Detector } from '../rest';

export const DETECTORS: Record<Detector, { title: string; path: string; says: string }> = {
  motion_consistency: {
    title: 'Motion consistency', path: 'motion.threshold_min',
    says: 'What the lidar sees, held against how the wheels say the robot moved. No robot’s ' +
      'threshold is below this one; one whose driving is rougher has a higher one of its own.',
  },
  qs2ddtw: {
    title: 'QS-2DDTW', path: 'threshold',
    says: 'How unlike two scans are (the paper’s score). Without a threshold here, each ' +
      'robot has its own, calibrated.',
  },
};

/** The threshold that is in force by the configuration; undefined where robots have their own. */
export function configured({ effective }: ConfigLevel, detector: Detector): number | undefined {
  const value = detector === 'qs2ddtw' ? effective.threshold : effective.motion?.threshold_min;
  return value ?? undefined;
}

/** What to PATCH a level with; null has it inherited. */
export function patch(detector: Detector, threshold: number | null): object {
  return detector === 'qs2ddtw' ? { threshold } : { motion: { threshold_min: threshold } };
}

export function raisesAlarms({ effective }: ConfigLevel, detector: Detector): boolean {
  return effective.alarm === detector || effective.alarm === 'either' || effective.alarm === 'both';
}

/** "motion.threshold_min = 6.5" of each member that is set. */
export function lines(values: DetectionConfig): string[] {
  const flat = (value: unknown, path: string): string[] =>
    value !== null && typeof value === 'object' && !Array.isArray(value)
      ? Object.entries(value).flatMap(([name, inner]) => flat(inner, path ? `${path}.${name}` : name))
      : [`${path} = ${JSON.stringify(value)}`];
  return flat(values, '');
}

/** Positions of a slider on a logarithmic scale. */
export class Scale {
  static readonly STEPS = 400;

  constructor(readonly low: number, readonly high: number) {}

  /** Around these values, with room on both sides. */
  static around(values: number[]): Scale {
    const usable = values.filter((value) => Number.isFinite(value) && value > 0);
    if (usable.length === 0) return new Scale(1, 100);
    return new Scale(Math.min(...usable) / 2, Math.max(...usable) * 1.6);
  }

  /** 0 to 1. */
  position(value: number): number {
    return Math.log(value / this.low) / Math.log(this.high / this.low);
  }

  /** With three digits, as people would write it. */
  value(position: number): number {
    const clamped = Math.min(Math.max(position, 0), 1);
    return Number((this.low * (this.high / this.low) ** clamped).toPrecision(3));
  }

  /** 1, 2 and 5 of every decade; only 1 if there are many. */
  ticks(): number[] {
    const many = this.high / this.low > 300;
    const found: number[] = [];
    for (let exponent = Math.floor(Math.log10(this.low)); 10 ** exponent <= this.high; ++exponent) {
      for (const factor of many ? [1] : [1, 2, 5]) {
        const tick = Number((factor * 10 ** exponent).toPrecision(3));
        if (tick >= this.low && tick <= this.high) found.push(tick);
      }
    }
    return found;
  }
}
