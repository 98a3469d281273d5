// SPDX-License-Identifier: Apache-2.0
// What another threshold would have done: in figures, and incident by incident.
import { count, duration, fill, h, number, timeElement, words, type Child } from '../dom';
import { link } from '../page';
import type { ThresholdPreview } from '../rest';

const SHORT_HOURS = 24;

export function effect(root: HTMLElement, preview: ThresholdPreview): void {
  const { kept, lost, raised, falseAlarmsPerDay, lostIncidents, raisedIncidents } = preview;
  const wrong = lostIncidents.filter(({ label }) => label === 'kidnapping').length;
  fill(root,
    h('dl', { class: 'figures' },
      figure('Kept', count(kept)),
      figure('Lost', count(lost), wrong > 0 && h('span', { class: 'error' },
        `${count(wrong)} labelled kidnapping`)),
      figure('New', count(raised)),
      figure('False alarms', [number(falseAlarmsPerDay.now), ' → ', number(falseAlarmsPerDay.then)],
        'per robot and day')),
    h('p', { class: 'hint' }, basis(preview)),
    listed('Would be lost', lost, lostIncidents.map((incident) => h('li', {},
      h('a', { href: link('incidents', incident.id) }, incident.robotId), ' ',
      timeElement(incident.openedAt), ` ${number(incident.score)} `,
      incident.label && h('span', { class: 'tag' }, words(incident.label))))),
    listed('Would be new', raised, raisedIncidents.map(({ robotId, time, score }) => h('li', {},
      h('a', { href: link('robots', robotId) }, robotId), ' ', timeElement(time),
      ` ${number(score)}`))));
}

/** The same as a sentence, for who does not see it. */
export function spoken({ threshold, kept, lost, raised, falseAlarmsPerDay }: ThresholdPreview): string {
  return `At ${number(threshold)}: ${kept} kept, ${lost} lost, ${raised} new; false alarms per ` +
    `robot and day ${number(falseAlarmsPerDay.now)} now, ${number(falseAlarmsPerDay.then)} then.`;
}

function basis({ scores, observedHours }: ThresholdPreview): string {
  const short = observedHours < SHORT_HOURS ? ' That is little: the rate says little, too.' : '';
  return `From ${count(scores)} scores in ${duration(3600 * observedHours)} of robots’ time. An incident that ` +
    `nobody labelled kidnapping or test counts as a false alarm.${short}`;
}

function figure(name: string, value: Child, below?: Child): HTMLElement {
  return h('div', {}, h('dt', {}, name), h('dd', {}, value, below && h('small', {}, below)));
}

function listed(title: string, all: number, items: HTMLElement[]): Child {
  if (all === 0) return null;
  const rest = all - items.length;
  return h('details', { class: 'listed', open: all <= 8 }, h('summary', {}, `${title}: ${count(all)}`),
    h('ul', {}, items, rest > 0 && h('li', { class: 'muted' }, `and ${count(rest)} more`)));
}
