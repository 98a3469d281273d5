// SPDX-License-Identifier: Apache-2.0
// A robot's scores over a stretch of time, as few or as many as a plot can show.
import { at, getAll, type RobotState, type Score, type ScoreBucket } from './rest';

export type ScoreKind = 'motion' | 'qs2ddtw';

/** Columns of equal length, by time; null where there is no value. */
export interface Series {
  kind: ScoreKind;
  resolution: number; // seconds of the longest; 0: every scan
  time: number[]; // seconds since 1970, by the robot's clock
  min: (number | null)[];
  max: (number | null)[];
  mean: (number | null)[];
  confirmed: (number | null)[]; // the highest; of motion only
  threshold: (number | null)[];
  state: (RobotState | null)[];
}

const MOST_POINTS = 800;
const RESOLUTIONS = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14400, 28800, 43200, 86400];
const SINGLE_SCANS_S = 120; // at most, one by one

/** Seconds of a bucket for a stretch of time; 0: every scan. */
export function resolutionFor(seconds: number): number {
  if (seconds <= SINGLE_SCANS_S) return 0;
  return RESOLUTIONS.find((one) => seconds / one <= MOST_POINTS) ?? 86400;
}

/**
 * From and to in milliseconds since 1970, by the robot's clock. Where single scans are not kept any
 * more, what is left of them: minutes, or hours.
 */
export async function loadSeries(robot: string, kind: ScoreKind, from: number, to: number,
  signal?: AbortSignal): Promise<Series> {
  const resolution = resolutionFor((to - from) / 1000);
  const range = { from: new Date(from).toISOString(), to: new Date(to).toISOString(), limit: 1000 };
  if (resolution === 0) {
    const path = at('/api/v1/robots', robot, 'scores', range);
    const scores = await getAll<Score>(path, 'scores', 5000, signal);
    if (scores.length > 0) return fromScores(scores, kind);
  }
  const path = at('/api/v1/robots', robot, 'scores', { ...range, resolution: resolution || 1 });
  return fromBuckets(await getAll<ScoreBucket>(path, 'buckets', 5000, signal), kind, resolution);
}

export function fromScores(scores: Score[], kind: ScoreKind): Series {
  const series = none(kind, 0);
  for (const one of scores) {
    const value = kind === 'motion' ? one.motion?.score : one.score;
    add(series, one.time, 0, value, value, value, one.motion?.confirmed,
      kind === 'motion' ? one.motion?.threshold : one.threshold, one.state);
  }
  return series;
}

export function fromBuckets(buckets: ScoreBucket[], kind: ScoreKind, resolution: number): Series {
  const series = none(kind, Math.max(resolution, ...buckets.map((one) => one.seconds)));
  let before = 0; // seconds of the last one
  for (const one of buckets) {
    const spread = kind === 'motion' ? one.motion : one.score;
    add(series, one.time, before, spread?.min, spread?.max, spread?.mean, one.motionConfirmed?.max,
      kind === 'motion' ? one.motionThreshold : one.threshold, one.state);
    before = one.seconds;
  }
  return series;
}

function none(kind: ScoreKind, resolution: number): Series {
  return { kind, resolution, time: [], min: [], max: [], mean: [], confirmed: [], threshold: [], state: [] };
}

/** `before`: seconds of the bucket before. */
function add(series: Series, iso: string, before: number, min: number | undefined, max: number | undefined,
  mean: number | undefined, confirmed: number | undefined, threshold: number | undefined,
  state: RobotState | null): void {
  const time = Date.parse(iso) / 1000;
  const last = series.time.at(-1);
  if (last !== undefined && time - last > Math.max(5, 3 * before)) {
    push(series, last + (before || 0.001), null, null, null, null, null, null); // a gap is seen as one
  }
  push(series, time, min ?? null, max ?? null, mean ?? null,
    series.kind === 'motion' ? confirmed ?? null : null, threshold ?? null, state);
}

function push(series: Series, time: number, min: number | null, max: number | null, mean: number | null,
  confirmed: number | null, threshold: number | null, state: RobotState | null): void {
  series.time.push(time);
  series.min.push(min);
  series.max.push(max);
  series.mean.push(mean);
  series.confirmed.push(confirmed);
  series.threshold.push(threshold);
  series.state.push(state);
}
