// SPDX-License-Identifier: Apache-2.0
// The ROC curve that labels give, with its confidence, and the threshold that it suggests.
import { button, count, fill, h, number, svg, type Child } from '../dom';
import { link } from '../page';
import { at, get, Problem, type Detector, type LabelledRoc, type Rate } from '../rest';
import { empty, failed, isAbort, loading } from '../states';

const SIZE = 240;
const PAD = 34;

export interface RocOf {
  detector: Detector;
  robot?: string;
  from?: string;
  signal: AbortSignal;
  /** Is told the suggested threshold. */
  use?: (threshold: number) => void;
}

export async function showRoc(root: HTMLElement, { signal, use, ...query }: RocOf): Promise<void> {
  fill(root, loading());
  try {
    const roc = await get<LabelledRoc>(at('/api/v1/evaluation/roc', query), signal);
    fill(root, h('div', { class: 'roc' }, curve(roc), figures(roc, use)));
  } catch (error) {
    if (isAbort(error)) return;
    if (error instanceof Problem && error.status === 409) fill(root, tooLittle());
    else fill(root, failed(error));
  }
}

/** Known before it is asked for. */
export function tooLittle(): HTMLElement {
  return empty('Not enough labels yet.', 'Label some ',
    h('a', { href: link('incidents') }, 'incidents'),
    ' kidnapping and some false alarm: then this shows how well their scores tell them apart.');
}

function figures({ area, kidnappings, falseAlarms, suggestion }: LabelledRoc,
  use?: (threshold: number) => void): Child {
  return h('div', {},
    h('dl', { class: 'facts' },
      h('dt', {}, 'Labels'), h('dd', {}, `${counted(kidnappings, 'kidnapping')}, ` +
        counted(falseAlarms, 'false alarm')),
      h('dt', {}, 'Area'), h('dd', {}, number(area.value),
        h('span', { class: 'muted' }, ` (95 %: ${number(area.low)} to ${number(area.high)})`)),
      suggestion && [
        h('dt', {}, 'Suggested'), h('dd', {}, number(suggestion.threshold)),
        h('dt', {}, 'finds'), h('dd', {}, percent(suggestion.found)),
        h('dt', {}, 'alarms falsely'), h('dd', {}, percent(suggestion.falseAlarms)),
      ]),
    suggestion ? use && button(`Try ${number(suggestion.threshold)}`,
      () => use(suggestion.threshold)) : h('p', {}, 'No threshold is better than chance.'),
    h('p', { class: 'hint' }, 'Only of what alarmed: a kidnapping that nobody noticed has no label.'));
}

function counted(many: number, one: string): string {
  return `${count(many)} ${one}${many === 1 ? '' : 's'}`;
}

function percent({ rate, low, high }: Rate): Child {
  const text = (value: number) => (100 * value).toFixed(0);
  return [`${text(rate)} %`, h('span', { class: 'muted' }, ` (95 %: ${text(low)} to ${text(high)} %)`)];
}

function curve({ points, area, suggestion }: LabelledRoc): SVGElement {
  const x = (rate: number) => PAD + rate * (SIZE - PAD - 8);
  const y = (rate: number) => 8 + (1 - rate) * (SIZE - PAD - 8);
  const path = points.map(({ falseAlarms, found }, i) =>
    (i === 0 ? `M${x(falseAlarms)} ${y(found)}` : `L${x(falseAlarms)} ${y(found)}`)).join('');
  const ticks = [0, 0.5, 1].flatMap((rate) => [
    svg('line', { x1: x(rate), x2: x(rate), y1: y(0), y2: y(1), class: 'strip-grid' }),
    svg('line', { x1: x(0), x2: x(1), y1: y(rate), y2: y(rate), class: 'strip-grid' }),
    svg('text', { x: x(rate), y: SIZE - 18, 'text-anchor': 'middle', class: 'strip-text' }, rate),
    svg('text', { x: PAD - 5, y: y(rate) + 4, 'text-anchor': 'end', class: 'strip-text' }, rate),
  ]);
  return svg('svg', { viewBox: `0 0 ${SIZE} ${SIZE}`, class: 'roc-curve', role: 'img',
    'aria-label': `ROC curve, area ${number(area.value)}` },
    ticks,
    svg('line', { x1: x(0), y1: y(0), x2: x(1), y2: y(1), class: 'roc-chance' }),
    svg('path', { d: path, class: 'roc-line' }),
    suggestion && svg('circle', { cx: x(suggestion.falseAlarms.rate), cy: y(suggestion.found.rate),
      r: 5, class: 'roc-suggestion' }),
    svg('text', { x: x(0.5), y: SIZE - 3, 'text-anchor': 'middle', class: 'strip-text' },
      'share of false alarms that alarm'),
    svg('text', { x: 9, y: y(0.5), 'text-anchor': 'middle', class: 'strip-text',
      transform: `rotate(-90 9 ${y(0.5)})` }, 'kidnappings found'));
}
