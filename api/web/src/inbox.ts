// SPDX-License-Identifier: Apache-2.0
// The list of incidents: one of them is current, and keys move it (roving tabindex); some may be
// selected.
import { age, duration, h, localTime, number, setText, words } from './dom';
import { isShelved, labelText } from './care';
import { link } from './page';
import type { Incident } from './rest';
import { badge } from './states';

const MOST = 1000; // rows; older ones are a filter away

export class Inbox {
  readonly element = h('ol', { class: 'inbox', 'aria-label': 'Incidents' });
  private readonly incidents = new Map<string, Incident>();
  private readonly rows = new Map<string, HTMLLIElement>();
  private readonly chosen = new Set<string>();
  private currentId?: string;

  /** `onSelection` is called when something is selected or no longer. */
  constructor(private readonly onSelection: () => void, private readonly canSelect: boolean) {}

  get size(): number {
    return this.rows.size;
  }

  get current(): Incident | undefined {
    return this.currentId === undefined ? undefined : this.incidents.get(this.currentId);
  }

  get selected(): Incident[] {
    return [...this.chosen].map((id) => this.incidents.get(id)!);
  }

  has(id: string): boolean {
    return this.rows.has(id);
  }

  clear(): void {
    this.incidents.clear();
    this.rows.clear();
    this.chosen.clear();
    this.element.replaceChildren();
    this.onSelection();
  }

  /** Shows it as it is now, in its place: newest first. Older news of it are ignored. */
  put(incident: Incident): void {
    const known = this.incidents.get(incident.id);
    if (known && known.seq > incident.seq) return;
    this.incidents.set(incident.id, incident);
    const row = this.rowOf(incident);
    const old = this.rows.get(incident.id);
    this.rows.set(incident.id, row);
    if (old) replace(old, row);
    else this.insert(row);
    if (this.rows.size > MOST) this.drop(this.element.lastElementChild as HTMLLIElement);
    if (this.currentId === undefined) this.makeCurrent(incident.id);
  }

  /** Ids are UUIDv7: they sort by time. From the end, where pages are appended. */
  private insert(row: HTMLLIElement): void {
    let before = this.element.lastElementChild as HTMLLIElement | null;
    while (before && before.dataset['id']! < row.dataset['id']!) {
      before = before.previousElementSibling as HTMLLIElement | null;
    }
    if (before) before.after(row);
    else this.element.prepend(row);
  }

  /** The last one of the list: what is older may not have been loaded. */
  get oldestId(): string | undefined {
    return (this.element.lastElementChild as HTMLLIElement | null)?.dataset['id'];
  }

  /** Has the incident's row be the current one. */
  makeCurrent(id: string): void {
    const before = this.currentId === undefined ? undefined : this.rows.get(this.currentId);
    if (before) setTabbable(before, false);
    this.currentId = id;
    const row = this.rows.get(id);
    if (row) setTabbable(row, true);
  }

  /** Moves the focus by so many rows; to the current one if it was elsewhere. */
  move(by: number): void {
    const rows = [...this.element.children] as HTMLLIElement[];
    if (rows.length === 0) return;
    const at = rows.findIndex((row) => row.dataset['id'] === this.currentId);
    const isInside = this.element.contains(document.activeElement);
    const to = at < 0 || !isInside ? Math.max(at, 0) : at + by;
    this.focus(rows[Math.min(Math.max(to, 0), rows.length - 1)]!.dataset['id']!);
  }

  focus(id: string): void {
    this.makeCurrent(id);
    const target = this.rows.get(id)?.querySelector('a');
    target?.focus();
    target?.scrollIntoView({ block: 'nearest' });
  }

  toggle(id: string): void {
    if (!this.chosen.delete(id)) this.chosen.add(id);
    const box = this.rows.get(id)?.querySelector('input');
    if (box) box.checked = this.chosen.has(id);
    this.onSelection();
  }

  unselect(): void {
    [...this.chosen].forEach((id) => this.toggle(id));
  }

  /** "3 min ago" grows old. */
  tick(): void {
    this.rows.forEach((row, id) => setText(row.querySelector('time')!,
      ago(this.incidents.get(id)!.openedAt)));
  }

  private drop(row: HTMLLIElement): void {
    const id = row.dataset['id']!;
    if (this.chosen.has(id)) this.toggle(id);
    if (this.currentId === id) this.currentId = undefined;
    this.incidents.delete(id);
    this.rows.delete(id);
    row.remove();
  }

  private rowOf(incident: Incident): HTMLLIElement {
    const { id, robotId, state, cause, explanation, score, threshold, openedAt } = incident;
    const isCurrent = id === this.currentId;
    const select = this.canSelect && h('input', {
      type: 'checkbox', 'aria-label': `Select ${robotId}, ${localTime(new Date(openedAt))}`,
      checked: this.chosen.has(id), tabindex: isCurrent ? 0 : -1,
      onchange: () => this.toggle(id), onfocus: () => this.makeCurrent(id),
    });
    return h('li', { 'data-id': id, class: `incident incident-${state}` }, select,
      h('a', { href: link('incidents', id), tabindex: isCurrent ? 0 : -1,
        onfocus: () => this.makeCurrent(id) },
        h('span', { class: 'incident-state' }, badge(state),
          isShelved(incident) && h('span', { class: 'tag' }, 'shelved')),
        h('span', { class: 'incident-robot' }, robotId),
        h('span', { class: 'incident-what' }, h('span', { class: 'incident-cause' }, words(cause)),
          ' ', h('span', { class: 'muted' }, explanation)),
        h('span', { class: 'incident-label' },
          incident.label && h('span', { class: `tag tag-${incident.label}` }, labelText(incident)),
          incident.comment && h('span', { class: 'incident-comment' }, incident.comment)),
        h('span', { class: 'incident-score', title: 'Score against the threshold in force then' },
          h('b', {}, number(score)), h('span', { class: 'muted' }, ` / ${number(threshold)}`)),
        h('time', { datetime: openedAt, title: localTime(new Date(openedAt)) }, ago(openedAt))));
  }
}

function ago(iso: string): string {
  return `${duration(age(iso))} ago`;
}

function setTabbable(row: HTMLElement, is: boolean): void {
  row.querySelectorAll('a, input').forEach((one) => one.setAttribute('tabindex', is ? '0' : '-1'));
}

/** What had the focus in the old row has it in the new one. */
function replace(old: HTMLElement, row: HTMLElement): void {
  const focused = old.contains(document.activeElement) ? document.activeElement : null;
  old.replaceWith(row);
  if (focused) row.querySelector<HTMLElement>(focused.matches('input') ? 'input' : 'a')?.focus();
}
