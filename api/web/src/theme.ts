// SPDX-License-Identifier: Apache-2.0
// Colours of style.css for what is drawn on canvas, in light and dark.

const dark = matchMedia('(prefers-color-scheme: dark)');

/** The value of a custom property: colour('--accent'). */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Called when light changes to dark or back: draw anew. Returns how to stop. */
export function onTheme(fn: () => void): () => void {
  dark.addEventListener('change', fn);
  return () => dark.removeEventListener('change', fn);
}
