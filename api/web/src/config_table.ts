// SPDX-License-Identifier: Apache-2.0
// A configuration, member by member, with the level that each value comes from.
import { h, words } from './dom';
import type { ConfigLevel } from './rest';

/** {"motion": {"threshold_min": 6}} as [["motion.threshold_min", 6]]. */
export function members(values: object, path = ''): [string, unknown][] {
  return Object.entries(values).flatMap(([name, value]): [string, unknown][] =>
    value !== null && typeof value === 'object' && !Array.isArray(value)
      ? members(value as object, `${path}${name}.`) : [[`${path}${name}`, value]]);
}

function text(value: unknown): string {
  if (value === null) return 'each robot’s own';
  if (Array.isArray(value)) return value.length > 0 ? value.join(', ') : 'none';
  return String(value);
}

/** What somebody set first; the defaults folded away. */
export function configTable({ effective, origins }: ConfigLevel): HTMLElement {
  const all = members(effective);
  const set = all.filter(([path]) => (origins[path] ?? 'default') !== 'default');
  const rest = all.filter(([path]) => (origins[path] ?? 'default') === 'default');
  const table = (rows: [string, unknown][]) => h('table', { class: 'config' },
    h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'Setting'), h('th', { scope: 'col' }, 'Value'),
      h('th', { scope: 'col' }, 'From'))),
    h('tbody', {}, rows.map(([path, value]) => h('tr', {},
      h('th', { scope: 'row' }, h('code', {}, path)), h('td', {}, words(text(value))),
      h('td', {}, origins[path] ?? 'default')))));
  return h('div', {},
    set.length > 0 ? table(set) : h('p', { class: 'muted' }, 'Nobody changed anything: all values are defaults.'),
    rest.length > 0 && h('details', {}, h('summary', {}, `${rest.length} defaults`), table(rest)));
}
