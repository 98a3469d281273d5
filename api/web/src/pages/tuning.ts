// SPDX-License-Identifier: Apache-2.0
// Tuning.
import { h } from '../dom';
import type { Page } from '../page';
import { empty } from '../states';

export const tuning: Page = (root) => {
  root.append(h('h1', {}, 'Tuning'), empty('Nothing here yet.'));
  return () => undefined;
};
