// SPDX-License-Identifier: Apache-2.0
// What just happened, in a sentence that goes away by itself; screen readers say it, too.
import { h } from './dom';

const STAYS_MS = 8000;

export class Said {
  readonly element = h('p', { class: 'said', role: 'status' });
  private leaving?: ReturnType<typeof setTimeout>;

  say(text: string): void {
    clearTimeout(this.leaving);
    this.element.textContent = text;
    this.leaving = setTimeout(() => { this.element.textContent = ''; }, STAYS_MS);
  }

  stop(): void {
    clearTimeout(this.leaving);
  }
}
