// SPDX-License-Identifier: Apache-2.0
// What a page shows when there is nothing to show (yet), and badges that all pages share.
import { button, h, svg, words, type Child } from './dom';
import { Problem, type IncidentState, type RobotState } from './rest';

/** Gravest first: the order in which people want to see robots. */
export const ROBOT_STATES: RobotState[] = ['kidnapped', 'suspect', 'degraded', 'stale', 'unknown', 'normal'];

/** Told to screen readers as busy; nothing moves, because it is rarely seen for long. */
export function loading(what = 'Loading'): HTMLElement {
  return h('p', { class: 'state', role: 'status' }, `${what} …`);
}

/** Nothing is there, and what to do about it. */
export function empty(title: string, ...hint: Child[]): HTMLElement {
  return h('div', { class: 'state' }, h('p', { class: 'state-title' }, title), hint.length > 0 && h('p', {}, hint));
}

/** It went wrong, and how to try again. */
export function failed(error: unknown, retry?: () => void): HTMLElement {
  return h('div', { class: 'state', role: 'alert' },
    h('p', { class: 'state-title' }, sentence(error)),
    retry && h('p', {}, button('Try again', retry)));
}

/** An error as a sentence for people. */
export function sentence(error: unknown): string {
  if (!(error instanceof Problem)) return `This page failed: ${String(error)}`;
  if (error.status === 0) return 'The service does not answer. Is it running, and is this device on its network?';
  if (error.status === 401) return 'The service does not know this token.';
  if (error.status === 403) return `You may not do this: ${error.detail}.`;
  if (error.status === 429) return 'Too many requests at once. Wait a moment.';
  return error.detail.charAt(0).toUpperCase() + error.detail.slice(1);
}

/** Whether it is only that the page went away meanwhile. */
export function isAbort(error: unknown): boolean {
  return error instanceof DOMException && error.name === 'AbortError';
}

// A shape for each state, so that colour is never the only difference (WCAG 1.4.1).
const SHAPES: Record<RobotState | IncidentState, string> = {
  kidnapped: 'M8 1 15 14H1Z', suspect: 'M8 1 15 8 8 15 1 8Z', degraded: 'M2 2H14V14H2Z',
  stale: 'M2 7H14V9H2Z', unknown: 'M8 2A6 6 0 1 0 8 14 6 6 0 1 0 8 2ZM8 5A3 3 0 1 1 8 11 3 3 0 1 1 8 5Z',
  normal: 'M8 3A5 5 0 1 0 8 13 5 5 0 1 0 8 3Z',
  open: 'M8 1 15 14H1Z', acknowledged: 'M8 1 15 8 8 15 1 8Z', resolved: 'M8 3A5 5 0 1 0 8 13 5 5 0 1 0 8 3Z',
};

/** The state of a robot or an incident: shape, colour and word. */
export function badge(state: RobotState | IncidentState, text: string = words(state)): HTMLElement {
  return h('span', { class: `badge badge-${state}` },
    svg('svg', { viewBox: '0 0 16 16', 'aria-hidden': 'true' }, svg('path', { d: SHAPES[state], 'fill-rule': 'evenodd' })),
    text);
}
