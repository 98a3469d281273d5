// SPDX-License-Identifier: Apache-2.0
// Which incidents are open, for the header and the title: loaded once, then kept by the alerts.
import { onAlert } from './live';
import { getAll, type Incident } from './rest';

let open = new Set<string>();
let changed: () => void = () => undefined;
let unsubscribe: () => void = () => undefined;

async function load(): Promise<void> {
  try {
    const all = await getAll<Incident>('/api/v1/incidents?state=open&limit=1000', 'incidents');
    open = new Set(all.map(({ id }) => id));
    changed();
  } catch {
    // The page that is shown tells what is wrong; the next alert or reload corrects the count.
  }
}

export const openIncidents = {
  count: () => open.size,
  start(onChange: () => void): void {
    changed = onChange;
    unsubscribe = onAlert(({ incidentId, state }) => {
      if (state === 'open') open.add(incidentId);
      else open.delete(incidentId);
      changed();
    });
    void load();
  },
  reload: () => void load(),
  stop(): void {
    unsubscribe();
    unsubscribe = () => undefined;
    open = new Set();
    changed();
  },
};
