// SPDX-License-Identifier: Apache-2.0
// Incident.
import { h } from '../dom';
import type { Page } from '../page';
import { empty } from '../states';

export const incident: Page = (root) => {
  root.append(h('h1', {}, 'Incident'), empty('Nothing here yet.'));
  return () => undefined;
};
