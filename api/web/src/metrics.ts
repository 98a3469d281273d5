// SPDX-License-Identifier: Apache-2.0
// The histograms among the metrics for Prometheus (text format 0.0.4), and what they tell.

export interface Histogram {
  bounds: number[]; // upper, in seconds; the last is infinite
  counts: number[]; // in each bucket alone
  sum: number;
}

/** The histogram of this name (without labels but `le`); undefined where there is none. */
export function histogram(text: string, name: string): Histogram | undefined {
  const result: Histogram = { bounds: [], counts: [], sum: 0 };
  let before = 0;
  for (const line of text.split('\n')) {
    if (line.startsWith(`${name}_sum `)) result.sum = Number(line.split(' ')[1]);
    const bucket = line.startsWith(`${name}_bucket{`) && /le="([^"]+)"\} (\S+)/.exec(line);
    if (!bucket) continue;
    const upTo = Number(bucket[2]);
    result.bounds.push(bucket[1] === '+Inf' ? Infinity : Number(bucket[1]));
    result.counts.push(upTo - before);
    before = upTo;
  }
  return result.bounds.length > 0 ? result : undefined;
}

export function total({ counts }: Histogram): number {
  return counts.reduce((sum, one) => sum + one, 0);
}

/** What came since `old`; all of it where the service was started anew meanwhile. */
export function since(now: Histogram, old: Histogram): Histogram {
  const counts = now.counts.map((one, i) => one - (old.counts[i] ?? 0));
  return counts.some((one) => one < 0) ? now : { bounds: now.bounds, counts, sum: now.sum - old.sum };
}

/** As Prometheus' histogram_quantile: even within a bucket; the last bound where it is beyond. */
export function quantile({ bounds, counts }: Histogram, q: number): number | undefined {
  const all = counts.reduce((sum, one) => sum + one, 0);
  if (all === 0) return undefined;
  let seen = 0;
  for (let i = 0; i < counts.length; i++) {
    const inside = counts[i]!;
    if (seen + inside >= q * all && inside > 0) {
      const low = i === 0 ? 0 : bounds[i - 1]!;
      return Number.isFinite(bounds[i]) ? low + (bounds[i]! - low) * (q * all - seen) / inside : low;
    }
    seen += inside;
  }
  return undefined;
}

/** "0.5 ms", "25 ms", "2.5 s". */
export function seconds(value: number | undefined): string {
  if (value === undefined) return '–';
  if (value >= 1) return `${Number(value.toPrecision(3))} s`;
  return `${Number((value * 1000).toPrecision(value < 0.01 ? 2 : 3))} ms`;
}
