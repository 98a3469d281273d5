// SPDX-License-Identifier: Apache-2.0
// What a page is: it fills the root, and returns how to stop everything that it started.

export interface Parameters {
  id?: string;
  query: URLSearchParams;
}

export type Page = (root: HTMLElement, parameters: Parameters) => () => void;

/** The address of a page: link('robots', id), link('incidents', undefined, {robot: id}). */
export function link(page: string, id?: string, query: Record<string, string | undefined> = {}): string {
  const set = Object.entries(query).filter((one): one is [string, string] => one[1] !== undefined);
  const text = new URLSearchParams(set).toString();
  return `#/${page}${id === undefined ? '' : `/${encodeURIComponent(id)}`}${text && `?${text}`}`;
}

/** Changes the query of the page's own address, without a new page: what a reload or a link shows. */
export function remember(query: Record<string, string | undefined>): void {
  const [path = '', old = ''] = (location.hash || '#/fleet').split('?');
  const merged = new URLSearchParams(old);
  for (const [name, value] of Object.entries(query)) {
    if (value) merged.set(name, value);
    else merged.delete(name);
  }
  const text = merged.toString();
  history.replaceState(null, '', `${path}${text && `?${text}`}`);
}
