// SPDX-License-Identifier: Apache-2.0
// The picture of both scans with what one can ask of it, and the same in words.
import { button, fill, h, number, setText, type Child } from '../dom';
import type { Evidence, LaserScan } from '../rest';
import { inWords, ORIGIN, poseOf, type Laid } from './geometry';
import { COSTS, Picture } from './picture';

const LAID: [Laid, string, string][] = [
  ['seen', 'As seen', 'The scan after is laid where it fits the scan before best.'],
  ['told', 'As told', 'The scan after is laid where the wheels say the robot went.'],
  ['raw', 'Raw', 'Both scans are laid on one place: this is what the warping compares.'],
];

/** Fills `root`; returns how to stop. */
export function scanFigure(root: HTMLElement, evidence: Evidence): () => void {
  const picture = new Picture();
  let laid = LAID.find(([one]) => poseOf(evidence, one))![0];
  const said = h('p', { class: 'hint' });
  const stepText = h('output', { for: 'step', class: 'hint' });
  const warping = toggle('Warping path', evidence.warping !== undefined, draw);
  const violations = toggle('Seen through', evidence.motion !== undefined, draw);
  const steps = evidence.warping?.steps ?? [];
  const slider = h('input', { type: 'range', id: 'step', min: -1, max: steps.length - 1, value: -1,
    step: 1, oninput: draw });
  const laidButtons = LAID.filter(([one]) => poseOf(evidence, one)).map(([one, title]) =>
    button(title, () => { laid = one; draw(); }, { 'data-laid': one }));

  function draw(): void {
    const step = Number(slider.value);
    laidButtons.forEach((one) =>
      one.setAttribute('aria-pressed', String(one.dataset['laid'] === laid)));
    setText(said, LAID.find(([one]) => one === laid)![2]);
    setText(stepText, inStep(evidence, step));
    slider.setAttribute('aria-valuetext', inStep(evidence, step));
    picture.show({ evidence, pose: poseOf(evidence, laid) ?? ORIGIN, warping: isOn(warping),
      violations: isOn(violations), step: step < 0 ? undefined : step }, summary(evidence));
  }

  fill(root,
    h('div', { class: 'row picture-tools' },
      h('div', { class: 'group', role: 'group', 'aria-label': 'The scan after is laid' }, laidButtons),
      warping, violations),
    h('figure', {}, picture.element, legend(evidence)),
    said,
    steps.length > 0 && h('div', { class: 'walk' },
      h('label', { for: 'step' }, 'Walk along the warping'), slider, stepText),
    h('details', {}, h('summary', {}, 'The picture in words'),
      h('ul', { class: 'words' }, sentences(evidence).map((one) => h('li', {}, one)))));
  draw();
  return () => picture.stop();
}

function toggle(text: string, isThere: boolean, changed: () => void): HTMLButtonElement {
  const one = button(text, () => {
    one.setAttribute('aria-pressed', String(!isOn(one)));
    changed();
  }, { 'aria-pressed': String(isThere), disabled: !isThere });
  return one;
}

function isOn(one: HTMLButtonElement): boolean {
  return one.getAttribute('aria-pressed') === 'true';
}

function legend({ warping, motion }: Evidence): HTMLElement {
  return h('figcaption', { class: 'evidence-legend row' },
    h('span', { class: 'key key-before' }, 'before'),
    h('span', { class: 'key key-after' }, 'after'),
    motion && h('span', { class: 'key key-through' }, 'where the other scan saw through'),
    warping && h('span', { class: 'key-costs' }, 'matched at a cost from 0 ',
      COSTS.map((_, i) => h('i', { class: `cost cost-${i}` })), ' to ',
      number(Math.max(...warping.steps.map(([, , cost]) => cost))), ` ${unit(warping)}`));
}

function unit({ standardized }: NonNullable<Evidence['warping']>): string {
  return standardized ? 'σ' : 'm';
}

function beam(scan: LaserScan, index: number): string {
  const degrees = ((scan.angle_min + index * scan.angle_increment) * 180) / Math.PI;
  return `${index} (${number(scan.ranges[index])} m at ${degrees.toFixed(0)}°)`;
}

function inStep({ before, after, warping }: Evidence, step: number): string {
  const found = warping?.steps[step];
  if (!warping || !found) return `${warping?.steps.length ?? 0} steps`;
  const [i, j, cost] = found;
  return `Beam ${beam(before, i)} before matches ${beam(after, j)} after: ${number(cost)} ${unit(warping)}`;
}

function ofScan(name: string, { ranges }: LaserScan): string {
  const hits = ranges.filter((range): range is number => range !== null);
  return `${name}: ${hits.length} of ${ranges.length} beams hit something, between ` +
    `${number(Math.min(...hits))} and ${number(Math.max(...hits))} m away.`;
}

function sentences(evidence: Evidence): string[] {
  const { before, after, warping, motion } = evidence;
  const all = [ofScan('Before', before), ofScan('After', after)];
  if (motion) {
    all.push(`By the lidar: ${inWords(motion.seen)}.`);
    all.push(motion.told ? `By the wheels: ${inWords(motion.told)}.` : 'The wheels told nothing.');
    all.push(`${motion.violating.before.length} points of the scan before lie where the one after ` +
      `saw through, ${motion.violating.after.length} the other way round.`);
  }
  if (warping) all.push(costs(warping));
  return all;
}

/** How unevenly the cost is spread: a shift is dear everywhere, a door only where it is. */
function costs({ cost, steps }: NonNullable<Evidence['warping']>): string {
  const sorted = steps.map(([, , one]) => one).sort((a, b) => b - a);
  const sum = (all: number[]) => all.reduce((total, one) => total + one, 0);
  const tenth = sum(sorted.slice(0, Math.ceil(sorted.length / 10)));
  const share = sum(sorted) > 0 ? Math.round((100 * tenth) / sum(sorted)) : 0;
  return `The warping takes ${steps.length} steps and costs ${number(cost)}; the dearest tenth of ` +
    `the steps makes up ${share} % of it.`;
}

function summary(evidence: Evidence): string {
  return `Both scans over each other. ${sentences(evidence).join(' ')}`;
}

/** How far lidar and wheels disagree, for the facts. */
export function movement({ motion }: Evidence): Child {
  return motion && [
    h('dt', {}, 'By the lidar'), h('dd', {}, inWords(motion.seen)),
    h('dt', {}, 'By the wheels'), h('dd', {}, motion.told ? inWords(motion.told) : 'not told'),
  ];
}
