// SPDX-License-Identifier: Apache-2.0
// Asks again and again, but never while nobody looks, and never before the last answer.

/** Calls `ask` now and `pause()` milliseconds after it is done. Returns how to stop. */
export function poll(ask: (signal: AbortSignal) => Promise<void>, pause: () => number): () => void {
  const stop = new AbortController();
  let timer: ReturnType<typeof setTimeout> | undefined;
  const next = async () => {
    if (document.visibilityState === 'visible') await ask(stop.signal).catch(() => undefined);
    if (!stop.signal.aborted) timer = setTimeout(() => void next(), pause());
  };
  const seen = () => {
    if (document.visibilityState !== 'visible' || timer === undefined) return;
    clearTimeout(timer);
    timer = undefined;
    void next();
  };
  document.addEventListener('visibilitychange', seen);
  void next();
  return () => {
    stop.abort();
    clearTimeout(timer);
    document.removeEventListener('visibilitychange', seen);
  };
}
