// SPDX-License-Identifier: Apache-2.0
// Debian's chromium, pages that somebody is signed in to, and everything that a page complains of.
import { AxeBuilder } from '@axe-core/playwright';
import assert from 'node:assert/strict';
import { accessSync, constants } from 'node:fs';
import { delimiter, join } from 'node:path';
import { chromium } from 'playwright-core';

export const DESKTOP = { viewport: { width: 1280, height: 900 } };
export const PHONE = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

function browserPath() {
  const names = ['chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable'];
  const all = process.env.PATH.split(delimiter).flatMap((folder) => names.map((name) => join(folder, name)));
  return all.find((path) => {
    try {
      accessSync(path, constants.X_OK);
      return true;
    } catch {
      return false;
    }
  });
}

export function launched() {
  const isRoot = process.getuid() === 0; // whose processes Chromium puts in no sandbox
  return chromium.launch({ executablePath: browserPath(), args: isRoot ? ['--no-sandbox'] : [] });
}

export class Visitor {
  /** Console errors, exceptions and violations of the page's policy. */
  complaints = [];

  /** `role`: whose token; nobody's where it is undefined. */
  static async of(browser, stack, role, options = DESKTOP) {
    const visitor = new Visitor();
    visitor.context = await browser.newContext({ baseURL: stack.url, colorScheme: 'light', ...options });
    visitor.context.setDefaultTimeout(15_000);
    await visitor.context.addInitScript((token) => {
      if (token) sessionStorage.setItem('kidnapwatch.token', token);
      document.addEventListener('securitypolicyviolation',
        (event) => console.error(`policy: ${event.violatedDirective} ${event.blockedURI}`));
    }, stack.tokens[role]);
    visitor.page = await visitor.context.newPage();
    visitor.page.on('pageerror', (error) => visitor.complaints.push(error.stack ?? String(error)));
    visitor.page.on('console', (message) => {
      if (message.type() === 'error') visitor.complaints.push(message.text());
    });
    return visitor;
  }

  /** Shows the address, and waits for its heading and for what says that it is still loading. */
  async open(address) {
    await this.page.goto(`/${address}`);
    await this.page.getByRole('heading', { level: 1 }).first().waitFor();
    await this.settled();
  }

  async settled() {
    await this.page.waitForFunction(() => {
      const isLoading = [...document.querySelectorAll('.state[role=status]')].length > 0;
      return !isLoading && document.querySelector('[aria-busy=true]') === null;
    });
  }

  /** Closes the page; it may not have complained. */
  async leave() {
    await this.context.close();
    assert.deepEqual(this.complaints, []);
  }

  /** No violation of WCAG 2.2 AA, as far as axe-core sees. */
  async isAccessible(what) {
    const { violations } = await new AxeBuilder({ page: this.page })
      .withTags(['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice']).analyze();
    const told = violations.flatMap(({ id, help, nodes }) =>
      nodes.map(({ html, failureSummary }) => `${id}: ${help}\n${html}\n${failureSummary}`));
    assert.deepEqual(told, [], what);
  }
}
