// SPDX-License-Identifier: Apache-2.0
// Keys of one letter: never while somebody types, never with a modifier, and they can be turned
// off (WCAG 2.1.4).
import { tell } from './ask';
import { h } from './dom';

export interface Key {
  keys: string[];
  says: string;
  act: (event: KeyboardEvent) => void;
}

const OFF = 'kidnapwatch.keys-off';

export function areOn(): boolean {
  return localStorage.getItem(OFF) === null;
}

function turn(on: boolean): void {
  if (on) localStorage.removeItem(OFF);
  else localStorage.setItem(OFF, '1');
}

/** Whether the key is text for what has the focus. */
export function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLElement &&
    (target.isContentEditable || target.matches('input:not([type=checkbox]), select, textarea'));
}

function isUsed(event: KeyboardEvent): boolean {
  const isModal = document.querySelector('dialog[open]') !== null;
  return event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || isModal ||
    isTyping(event.target);
}

/** Listens to the page until it is called off. '?' shows the keys, whether they are on or off. */
export function listen(keys: Key[]): () => void {
  const help: Key = { keys: ['?'], says: 'Show these keys', act: () => void show([...keys, help]) };
  const pressed = (event: KeyboardEvent) => {
    if (isUsed(event)) return;
    const key = [...keys, help].find((one) => one.keys.includes(event.key));
    if (!key || !(areOn() || key === help || event.key.length > 1)) return;
    event.preventDefault();
    key.act(event);
  };
  document.addEventListener('keydown', pressed);
  return () => document.removeEventListener('keydown', pressed);
}

const NAMES: Record<string, string> = { ArrowDown: '↓', ArrowUp: '↑' };

/** The keys in a dialog, with the switch that turns those of one letter off. */
export function show(keys: Key[]): Promise<null> {
  const rows = keys.map(({ keys: names, says }) => h('div', {},
    h('dt', {}, names.map((name) => h('kbd', {}, NAMES[name] ?? name))), h('dd', {}, says)));
  const box = h('input', { type: 'checkbox', id: 'keys-on', checked: areOn(),
    onchange: () => turn(box.checked) });
  return tell('Keys', h('dl', { class: 'keys' }, rows),
    h('p', { class: 'row' }, box, h('label', { for: 'keys-on' }, 'Keys of one letter are on')));
}
