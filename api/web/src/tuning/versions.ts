// SPDX-License-Identifier: Apache-2.0
// Who configured what, and when; admins take any of it back.
import { ask } from '../ask';
import { button, fill, h, timeElement, type Child } from '../dom';
import { at, get, send, type ConfigChange } from '../rest';
import { can } from '../session';
import { empty, failed, isAbort, loading, sentence } from '../states';
import { lines } from './threshold';

const PAGE = 10;

/** `changed` is called when something was restored. */
export class Versions {
  readonly element = h('div', {});
  private changes: ConfigChange[] = [];
  private next?: string;

  constructor(private readonly changed: (said: string) => void) {}

  /** Of a robot, or of all levels. */
  async load(robot: string, signal?: AbortSignal): Promise<void> {
    this.changes = [];
    fill(this.element, loading());
    await this.page(at('/api/v1/config/history', { robot: robot || undefined, limit: PAGE }), signal);
  }

  private async page(path: string, signal?: AbortSignal): Promise<void> {
    try {
      const { changes, next } = await get<{ changes: ConfigChange[]; next?: string }>(path, signal);
      this.changes.push(...changes);
      this.next = next;
      this.show();
    } catch (error) {
      if (!isAbort(error)) fill(this.element, failed(error, () => void this.page(path)));
    }
  }

  private show(): void {
    if (this.changes.length === 0) {
      fill(this.element, empty('Never changed.', 'The settings file and the defaults are in force.'));
      return;
    }
    fill(this.element,
      h('div', { class: 'table-wrap', tabindex: 0, role: 'region', 'aria-label': 'Changes' },
        h('table', {},
          h('thead', {}, h('tr', {}, ['Version', 'When', 'Who', 'Of', 'Set to'].map((name) =>
            h('th', { scope: 'col' }, name)),
          can('admin') && h('td', {}))),
          h('tbody', {}, this.changes.map((change) => this.row(change))))),
      this.next !== undefined && button('Show older ones', () => void this.page(this.next!),
        { class: 'more' }));
  }

  private row(change: ConfigChange): HTMLElement {
    return h('tr', {},
      h('th', { scope: 'row' }, change.version),
      h('td', {}, timeElement(change.since)),
      h('td', {}, change.author),
      h('td', {}, change.robotId ?? 'Fleet'),
      h('td', {}, setTo(change)),
      can('admin') && h('td', {}, button('Restore', () => void this.restore(change),
        { 'aria-label': `Restore version ${change.version}` })));
  }

  private async restore(change: ConfigChange): Promise<void> {
    const of = change.robotId ?? 'the fleet';
    const form = await ask(`Restore version ${change.version}?`, 'Restore',
      h('p', {}, `Has ${of} set exactly this, and inherit the rest:`), setTo(change),
      h('p', { class: 'hint' }, 'It becomes a version of its own, and can be taken back, too.'));
    if (!form) return;
    try {
      await send('POST', at('/api/v1/config/history', String(change.version), 'restore'), {});
      this.changed(`Version ${change.version} is restored.`);
    } catch (error) {
      this.changed(sentence(error));
    }
  }
}

function setTo({ values }: ConfigChange): Child {
  const set = lines(values);
  return set.length === 0 ? h('span', { class: 'muted' }, 'nothing: all is inherited')
    : set.map((line) => h('div', {}, h('code', {}, line)));
}
