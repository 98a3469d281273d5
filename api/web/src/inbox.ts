// SPDX-License-Identifier: Apache-2.0
// The list of incidents: one of them is current, and keys move it (roving tabindex); some may be
// selected.
import { age, duration, fill, h, localTime, number, setText, words } from './dom';
import { isShelved } from './care';
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
  private wasTouched = false; // else the newest one is current

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
    this.currentId = undefined;
    this.wasTouched = false;
    this.element.replaceChildren();
    this.onSelection();
  }

  /** Shows it as it is now, in its place: newest first. Older news of it are ignored. */
  put(incident: Incident): void {
    const known = this.incidents.get(incident.id);
    if (known && known.seq > incident.seq) return;
    this.incidents.set(incident.id, incident);
    const row = this.rows.get(incident.id) ?? this.added(incident);
    paint(row, incident);
    if (this.rows.size > MOST) this.drop(this.element.lastElementChild as HTMLLIElement);
    const isFirst = this.element.firstElementChild === row;
    if (this.currentId === undefined || (isFirst && !this.wasTouched)) this.makeCurrent(incident.id);
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
    this.touch(id);
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

  private touch(id: string): void {
    this.wasTouched = true;
    this.makeCurrent(id);
  }

  private drop(row: HTMLLIElement): void {
    const id = row.dataset['id']!;
    if (this.chosen.has(id)) this.toggle(id);
    if (this.currentId === id) this.currentId = undefined;
    this.incidents.delete(id);
    this.rows.delete(id);
    row.remove();
  }

  /** The row stays while the incident changes: so does the focus, also the one that a dialog gives back. */
  private added({ id, robotId, openedAt }: Incident): HTMLLIElement {
    const onfocus = () => this.touch(id);
    const row = h('li', { 'data-id': id },
      this.canSelect && h('input', { type: 'checkbox', tabindex: -1, onfocus,
        'aria-label': `Select ${robotId}, ${localTime(new Date(openedAt))}`,
        onchange: () => this.toggle(id) }),
      h('a', { href: link('incidents', id), tabindex: -1, onfocus }));
    this.rows.set(id, row);
    this.insert(row);
    return row;
  }
}

function paint(row: HTMLLIElement, incident: Incident): void {
  const { robotId, state, cause, explanation, score, threshold, openedAt, label, comment } = incident;
  row.className = `incident incident-${state}`;
  fill(row.querySelector('a')!,
    h('span', { class: 'incident-state' }, badge(state),
      isShelved(incident) && h('span', { class: 'tag' }, 'shelved')),
    h('span', { class: 'incident-robot' }, robotId),
    h('span', { class: 'incident-what' }, h('span', { class: 'incident-cause' }, words(cause)),
      ' ', h('span', { class: 'muted' }, explanation)),
    h('span', { class: 'incident-label' },
      label && h('span', { class: `tag tag-${label}` }, words(label)),
      comment && h('span', { class: 'incident-comment' }, comment)),
    h('span', { class: 'incident-score', title: 'Score against the threshold in force then' },
      h('b', {}, number(score)), h('span', { class: 'muted' }, ` / ${number(threshold)}`)),
    h('time', { datetime: openedAt, title: localTime(new Date(openedAt)) }, ago(openedAt)));
}

function ago(iso: string): string {
  return `${duration(age(iso))} ago`;
}

function setTabbable(row: HTMLElement, is: boolean): void {
  row.querySelectorAll('a, input').forEach((one) => one.setAttribute('tabindex', is ? '0' : '-1'));
}
