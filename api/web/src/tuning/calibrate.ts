// SPDX-License-Identifier: Apache-2.0
// A threshold for a rate of false alarms, from what the robots' natural scores were.
import { button, count, fill, h, number } from '../dom';
import { send, type Calibration, type Detector } from '../rest';
import { sentence } from '../states';

/** `scope` tells whose, when asked; `use` is told the threshold. */
export function calibrate(scope: () => { detector: Detector; robot?: string; from?: string },
  use: (threshold: number) => void): HTMLElement {
  const input = h('input', { type: 'number', id: 'one-in', min: 21, max: 100_000_000, step: 'any',
    value: 10_000, required: true });
  const result = h('div', { role: 'status' });
  const submit = async (event: Event) => {
    event.preventDefault();
    try {
      const found = await send<Calibration>('POST', '/api/v1/thresholds:calibrate',
        { ...scope(), falseAlarmRate: 1 / Number(input.value) });
      fill(result, h('p', {}, h('b', {}, number(found.threshold)), ': ',
        `${count(found.above)} of ${count(found.scores)} natural scores are above it; `,
        `at this rate ${number(found.abovePerDay)} a day would be. The next scan has to confirm ` +
        'each, which makes alarms rarer still. '),
      button(`Try ${number(found.threshold)}`, () => use(found.threshold)));
    } catch (error) {
      fill(result, h('p', { class: 'error' }, sentence(error)));
    }
  };
  return h('form', { onsubmit: (event: Event) => void submit(event) },
    h('p', { class: 'row' }, h('label', { for: 'one-in' }, 'One natural score above it in'), input,
      h('button', { type: 'submit' }, 'Find the threshold')), result);
}
