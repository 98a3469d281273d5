// SPDX-License-Identifier: Apache-2.0
// Service.
import { h } from '../dom';
import type { Page } from '../page';
import { empty } from '../states';

export const service: Page = (root) => {
  root.append(h('h1', {}, 'Service'), empty('Nothing here yet.'));
  return () => undefined;
};
