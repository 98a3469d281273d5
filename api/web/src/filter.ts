// SPDX-License-Identifier: Apache-2.0
// Which incidents the inbox shows: in the page's address, in the API's query, and for live ones.
import type { Incident } from './rest';

export const FILTERS = ['robot', 'state', 'kind', 'label', 'time', 'from', 'to'] as const;

/**
 * Empty texts filter nothing. `time` is a span that ends now ('1h', '24h', '7d'), or 'custom' for
 * `from` and `to`, which are as <input type="datetime-local"> has them: local, without a zone.
 */
export type Filter = Record<(typeof FILTERS)[number], string>;

const HOUR_MS = 3_600_000;
const SPANS_MS: Record<string, number> = {
  '1h': HOUR_MS, '24h': 24 * HOUR_MS, '7d': 7 * 24 * HOUR_MS,
};

export function filterFrom(query: URLSearchParams): Filter {
  return Object.fromEntries(FILTERS.map((name) => [name, query.get(name) ?? ''])) as Filter;
}

export function isEmpty(filter: Filter): boolean {
  return FILTERS.every((name) => filter[name] === '');
}

/** Milliseconds since 1970; undefined where that side is open. */
export function bounds(filter: Filter, now_ms: number): { from?: number; to?: number } {
  const span = SPANS_MS[filter.time];
  if (span !== undefined) return { from: now_ms - span };
  if (filter.time !== 'custom') return {};
  const time = (text: string) => (Number.isNaN(Date.parse(text)) ? undefined : Date.parse(text));
  return { from: time(filter.from), to: time(filter.to) };
}

/** The parameters of GET /incidents. */
export function queryOf(filter: Filter, now_ms: number): Record<string, string | undefined> {
  const { from, to } = bounds(filter, now_ms);
  const iso = (time?: number) => (time === undefined ? undefined : new Date(time).toISOString());
  return {
    robot: filter.robot || undefined, state: filter.state || undefined,
    kind: filter.kind || undefined, label: filter.label || undefined, from: iso(from), to: iso(to),
  };
}

/** Whether GET /incidents would have answered with it. */
export function matches(incident: Incident, filter: Filter, now_ms: number): boolean {
  const { from, to } = bounds(filter, now_ms);
  const opened = Date.parse(incident.openedAt);
  const is = (wanted: string, value?: string) => wanted === '' || wanted === value;
  return is(filter.robot, incident.robotId) && is(filter.state, incident.state) &&
    is(filter.kind, incident.kind) && is(filter.label, incident.label) &&
    (from === undefined || opened >= from) && (to === undefined || opened < to);
}
