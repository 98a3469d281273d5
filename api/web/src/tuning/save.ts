// SPDX-License-Identifier: Apache-2.0
// What is in force, and putting another threshold in its place, unless somebody else was faster.
import { button, fill, h, number, timeElement, type Child } from '../dom';
import { at, Problem, send, type ConfigLevel, type Detector } from '../rest';
import { can } from '../session';
import { sentence } from '../states';
import { configured, DETECTORS, patch, raisesAlarms } from './threshold';

export function configPath(robot: string): string {
  return robot === '' ? '/api/v1/config' : at('/api/v1/robots', robot, 'config');
}

export interface Saving {
  level: ConfigLevel;
  detector: Detector;
  robot: string;
  threshold: number;
  /** The level as it is then, after saving or after somebody else did. */
  saved: (level: ConfigLevel) => void;
  reload: () => void;
}

export function save(root: HTMLElement, saving: Saving): void {
  const { level, detector, robot } = saving;
  const value = configured(level, detector);
  const origin = level.origins[DETECTORS[detector].path];
  const said = h('div', { role: 'status' });
  fill(root,
    h('dl', { class: 'facts' },
      h('dt', {}, 'Threshold'),
      h('dd', {}, h('b', {}, value === undefined ? 'each robot’s own' : number(value)), ' ',
        h('span', { class: 'muted' }, ORIGINS[origin ?? 'default'])),
      h('dt', {}, 'Version'),
      h('dd', {}, level.version, h('span', { class: 'muted' }, ` by ${level.author}, `,
        timeElement(level.since)))),
    !raisesAlarms(level, detector) && h('p', { class: 'hint' },
      `Alarms are raised by ${level.effective.alarm?.replace('_', ' ') ?? 'another detector'} now: `,
      'this threshold has no say in them.'),
    can('admin') ? buttons(saving, said, origin) : h('p', { class: 'hint' },
      'To change it takes the role admin.'),
    said);
  if (robot === '' && detector === 'qs2ddtw') {
    root.append(h('p', { class: 'hint' }, 'One threshold for all robots replaces their own.'));
  }
}

const ORIGINS = { default: '(the default)', fleet: '(set for the fleet)', robot: '(set for this robot)' };

function buttons(saving: Saving, said: HTMLElement, origin?: string): Child {
  const { threshold, detector, robot, level } = saving;
  const isOwn = origin === (robot === '' ? 'fleet' : 'robot');
  return h('p', { class: 'row' },
    button(`Save ${number(threshold)} for ${robot || 'the fleet'}`,
      () => void put(saving, said, threshold), { class: 'primary', id: 'save',
        disabled: threshold === configured(level, detector) }),
    isOwn && button(robot === '' ? 'Back to the default' : 'Take the fleet’s',
      () => void put(saving, said, null)));
}

async function put({ level, detector, robot, saved, reload }: Saving, said: HTMLElement,
  threshold: number | null): Promise<void> {
  try {
    saved(await send<ConfigLevel>('PATCH', configPath(robot), patch(detector, threshold),
      { 'If-Match': `"${level.version}"` }));
  } catch (error) {
    if (error instanceof Problem && error.status === 412) fill(said, overtaken(error, reload));
    else fill(said, h('p', { class: 'error' }, sentence(error)));
  }
}

function overtaken(problem: Problem, reload: () => void): Child {
  return h('div', { class: 'notice' },
    h('p', {}, `Nothing was saved: somebody else changed it meanwhile (${problem.detail}).`),
    button('Load what is there now', reload, { id: 'reload' }));
}
