// SPDX-License-Identifier: Apache-2.0
// Fleet.
import { h } from '../dom';
import type { Page } from '../page';
import { empty } from '../states';

export const fleet: Page = (root) => {
  root.append(h('h1', {}, 'Fleet'), empty('Nothing here yet.'));
  return () => undefined;
};
