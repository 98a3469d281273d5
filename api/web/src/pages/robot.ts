// SPDX-License-Identifier: Apache-2.0
// Robot.
import { h } from '../dom';
import type { Page } from '../page';
import { empty } from '../states';

export const robot: Page = (root) => {
  root.append(h('h1', {}, 'Robot'), empty('Nothing here yet.'));
  return () => undefined;
};
