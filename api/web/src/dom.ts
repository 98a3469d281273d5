// SPDX-License-Identifier: Apache-2.0
// Elements, times and numbers. What comes from robots or people is only ever text.
import { serviceNow } from './rest';

export type Child = Node | string | number | false | null | undefined | Child[];
type Listener = (event: never) => void;
export type Properties = Record<string, string | number | boolean | Listener | null | undefined>;

/** An element: attributes by name, `onclick` and the like as listeners; text only as text nodes. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K, properties?: Properties | null, ...children: Child[]): HTMLElementTagNameMap[K] {
  return filled(document.createElement(tag), properties, children);
}

const SVG = 'http://www.w3.org/2000/svg';

/** The same for SVG. */
export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K, properties?: Properties | null, ...children: Child[]): SVGElementTagNameMap[K] {
  return filled(document.createElementNS(SVG, tag), properties, children);
}

function filled<E extends Element>(element: E, properties: Properties | null | undefined, children: Child[]): E {
  for (const [name, value] of Object.entries(properties ?? {})) {
    if (typeof value === 'function') {
      element.addEventListener(name.slice(2), value as EventListener);
    } else if (value === true) {
      element.setAttribute(name, '');
    } else if (value !== false && value !== null && value !== undefined) {
      element.setAttribute(name, String(value));
    }
  }
  append(element, children);
  return element;
}

/** Appends children, nested lists flattened; false, null and undefined are nothing. */
export function append(element: Element, children: Child): void {
  if (Array.isArray(children)) {
    children.forEach((child) => append(element, child));
  } else if (children !== false && children !== null && children !== undefined) {
    element.append(children instanceof Node ? children : String(children));
  }
}

/** Has exactly these children. */
export function fill(element: Element, ...children: Child[]): void {
  element.replaceChildren();
  append(element, children);
}

/** Sets the text if it is another one: cheap where nothing changes. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) {
    element.textContent = text;
  }
}

const clock = new Intl.DateTimeFormat(undefined, { hour: '2-digit', minute: '2-digit', second: '2-digit', hourCycle: 'h23' });
const date = new Intl.DateTimeFormat(undefined, { year: 'numeric', month: 'short', day: 'numeric' });

/** "14:03:09" of today, "Nov 23, 2026, 14:03:09" of other days; local time. */
export function localTime(time: Date, now = new Date()): string {
  return time.toDateString() === now.toDateString() ? clock.format(time)
    : `${date.format(time)}, ${clock.format(time)}`;
}

/** A `<time>` in local time, with the exact time as its title. */
export function timeElement(iso: string | undefined): HTMLElement {
  return iso ? h('time', { datetime: iso, title: iso }, localTime(new Date(iso))) : h('span', {}, '–');
}

/** "3 s", "4 min", "2 h", "5 d": how long ago, or how long. */
export function duration(seconds: number): string {
  const s = Math.max(0, seconds);
  if (s < 10) return `${Math.floor(s)} s`;
  if (s < 120) return `${Math.round(s)} s`;
  if (s < 7200) return `${Math.round(s / 60)} min`;
  if (s < 172800) return `${Math.round(s / 3600)} h`;
  return `${Math.round(s / 86400)} d`;
}

/** Three significant digits; "–" for what is not known. */
export function number(value: number | null | undefined, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (Math.abs(value) >= 10 ** (digits - 1)) return Math.round(value).toLocaleString('en');
  return String(Number(value.toPrecision(digits)));
}

/** Seconds since a time of the service, by its clock. */
export function age(iso: string): number {
  return (serviceNow() - Date.parse(iso)) / 1000;
}

/** A score or a threshold: one decimal, so that a column of them is easy to read. */
export function scoreText(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  return value.toLocaleString('en', { minimumFractionDigits: value < 100 ? 1 : 0, maximumFractionDigits: value < 100 ? 1 : 0 });
}

/** A count, with thin separators. */
export function count(value: number): string {
  return value.toLocaleString('en');
}

/** "false_alarm" as "false alarm". */
export function words(name: string): string {
  return name.replaceAll('_', ' ');
}

/** A button. */
export function button(label: Child, onclick: () => void, properties: Properties = {}): HTMLButtonElement {
  return h('button', { type: 'button', onclick, ...properties }, label);
}
