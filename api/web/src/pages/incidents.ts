// SPDX-License-Identifier: Apache-2.0
// Incidents.
import { h } from '../dom';
import type { Page } from '../page';
import { empty } from '../states';

export const incidents: Page = (root) => {
  root.append(h('h1', {}, 'Incidents'), empty('Nothing here yet.'));
  return () => undefined;
};
