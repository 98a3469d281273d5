// SPDX-License-Identifier: Apache-2.0
// The inbox: which kidnappings there were, and what is to be done about them.
import { ACTIONS, incidentOf, LABELS, mayCare, named, perform, type Action } from '../care';
import { button, count, fill, h, words } from '../dom';
import { filterFrom, FILTERS, isEmpty, matches, queryOf, type Filter } from '../filter';
import { Inbox } from '../inbox';
import * as keys from '../keys';
import { onAlert, onRobots } from '../live';
import { link, remember, type Page } from '../page';
import { at, get, type Incident } from '../rest';
import { Said } from '../said';
import { empty, failed, isAbort, loading, sentence } from '../states';

const PAGE = 50;
const MOST_NAMED = 500; // robots that the search proposes
let lastOpened: string | undefined; // so that who comes back finds the place again

export const incidents: Page = (root, { query }) => {
  const filter = filterFrom(query);
  const said = new Said();
  const state = h('div', {});
  const more = button('Show older ones', () => void load(next), { hidden: true, class: 'more' });
  const bulk = h('div', { class: 'bulk row', role: 'group', 'aria-label': 'Selected incidents' });
  const inbox = new Inbox(() => showBulk(), mayCare());
  const robots = new Set<string>();
  let next: string | undefined;
  let loadingNow = new AbortController();

  async function load(path?: string): Promise<void> {
    loadingNow.abort();
    loadingNow = new AbortController();
    const { signal } = loadingNow;
    if (!path) fill(state, loading('Loading incidents'));
    more.disabled = true;
    try {
      const first = at('/api/v1/incidents', { ...queryOf(filter, Date.now()), limit: PAGE });
      const page = await get<{ incidents: Incident[]; next?: string }>(path ?? first, signal);
      if (!path) inbox.clear();
      page.incidents.forEach((one) => inbox.put(one));
      next = page.next;
      fill(state, inbox.size === 0 && nothing(filter, clearFilter));
      if (!path) restoreFocus(inbox);
    } catch (error) {
      if (!isAbort(error)) fill(state, failed(error, () => void load(path)));
    }
    more.hidden = next === undefined;
    more.disabled = false;
  }

  async function care(action: Action): Promise<void> {
    const wanted = inbox.selected.length > 0 ? inbox.selected : inbox.current ? [inbox.current] : [];
    if (wanted.length === 0 || !mayCare()) return;
    if (!wanted.some(action.fits)) {
      const states = [...new Set(wanted.map((one) => one.state))].join(' or ');
      said.say(`Not ${action.says.toLowerCase()}d: ${named(wanted)} is ${states}.`);
      return;
    }
    try {
      const changed = await perform(action, wanted);
      changed.forEach((one) => inbox.put(one));
      if (changed.length > 0) {
        said.say(`${action.done}: ${named(changed)}.`);
        inbox.unselect();
      }
    } catch (error) {
      said.say(sentence(error));
    }
  }

  function showBulk(): void {
    const selected = inbox.selected;
    bulk.hidden = selected.length === 0;
    fill(bulk, h('span', {}, `${count(selected.length)} selected`),
      ACTIONS.filter((action) => selected.some(action.fits)).map((action) =>
        button(action.says, () => void care(action))),
      button('Select none', () => inbox.unselect(), { class: 'plain' }));
  }

  function changeFilter(): void {
    remember(filter);
    void load();
  }

  function clearFilter(): void {
    FILTERS.forEach((name) => { filter[name] = ''; });
    form.replaceWith(form = filterForm(filter, robots, changeFilter));
    changeFilter();
  }

  let form = filterForm(filter, robots, changeFilter);
  root.append(
    h('div', { class: 'head' }, h('h1', {}, 'Incidents'),
      button(['Keys ', h('kbd', {}, '?')], () => void keys.show(bindings), { class: 'plain end keys-button' })),
    form, bulk, inbox.element, state, more, said.element);
  bulk.hidden = true;

  const bindings = keysFor(inbox, care, () => {
    form.querySelector('details')!.open = true;
    form.querySelector('input')!.select();
  });
  const stopKeys = keys.listen(bindings);
  const stopAlerts = onAlert((alert) => {
    const incident = incidentOf(alert);
    const isNew = !inbox.has(incident.id);
    const isOlder = next !== undefined && incident.id < (inbox.oldestId ?? '');
    // A row whose incident no longer fits the filter stays: what was done can be taken back.
    if (isNew && (isOlder || !matches(incident, filter, Date.now()))) return;
    inbox.put(incident);
    fill(state);
    if (alert.type === 'opened') said.say(`New: ${incident.robotId}, ${words(incident.cause)}.`);
  });
  const stopRobots = onRobots((changed) => changed.forEach(({ id }) => robots.add(id)));
  const ticking = setInterval(() => inbox.tick(), 5000);
  const opened = (event: Event) => {
    lastOpened = (event.target as Element).closest('li')?.dataset['id'];
  };
  inbox.element.addEventListener('click', opened);
  void load();
  return () => {
    loadingNow.abort();
    said.stop();
    stopKeys();
    stopAlerts();
    stopRobots();
    clearInterval(ticking);
  };
};

function restoreFocus(inbox: Inbox): void {
  if (lastOpened !== undefined && inbox.has(lastOpened)) inbox.focus(lastOpened);
  lastOpened = undefined;
}

function nothing(filter: Filter, clear: () => void): HTMLElement {
  return isEmpty(filter)
    ? empty('No incidents.', 'Nobody was kidnapped since this service keeps history.')
    : empty('No incident fits this filter.', button('Show all incidents', clear));
}

function keysFor(inbox: Inbox, care: (action: Action) => Promise<void>, search: () => void):
keys.Key[] {
  const open = () => {
    if (inbox.current) location.hash = link('incidents', inbox.current.id);
    lastOpened = inbox.current?.id;
  };
  const select = () => {
    if (inbox.current) inbox.toggle(inbox.current.id);
  };
  return [
    { keys: ['j', 'ArrowDown'], says: 'Next incident', act: () => inbox.move(1) },
    { keys: ['k', 'ArrowUp'], says: 'Incident before', act: () => inbox.move(-1) },
    { keys: ['o'], says: 'Open it (as Enter does)', act: open },
    ...(mayCare() ? [
      ...ACTIONS.map((action) => (
        { keys: [action.key], says: action.says, act: () => void care(action) })),
      { keys: ['x'], says: 'Select it, for several at once', act: select },
    ] : []),
    { keys: ['/'], says: 'Search by robot', act: search },
  ];
}

const CHOICES: [keyof Filter, string, [string, string][]][] = [
  ['state', 'State', [['', 'Any'], ['open', 'Open'], ['acknowledged', 'Acknowledged'],
    ['resolved', 'Resolved']]],
  ['kind', 'Kind', [['', 'Any'], ['teleport', 'Teleport'], ['carry', 'Carry']]],
  ['label', 'Label', [['', 'Any'], ...LABELS.map((one) => [one, words(one)] as [string, string])]],
  ['time', 'Opened', [['', 'Any time'], ['1h', 'Last hour'], ['24h', 'Last 24 hours'],
    ['7d', 'Last 7 days'], ['custom', 'Between …']]],
];

function filterForm(filter: Filter, robots: Set<string>, changed: () => void): HTMLFormElement {
  const set = (name: keyof Filter, value: string) => {
    filter[name] = value;
    between.hidden = filter.time !== 'custom';
    changed();
  };
  const input = (name: keyof Filter, properties: object) => h('input', {
    name, value: filter[name], ...properties,
    onchange: (event: Event) => set(name, (event.target as HTMLInputElement).value.trim()),
  });
  const known = h('datalist', { id: 'robots' });
  const between = h('span', { class: 'row', hidden: filter.time !== 'custom' },
    h('label', {}, h('span', {}, 'From'), input('from', { type: 'datetime-local' })),
    h('label', {}, h('span', {}, 'to'), input('to', { type: 'datetime-local' })));
  const robot = input('robot', { type: 'search', list: 'robots', placeholder: 'Any',
    spellcheck: 'false', autocomplete: 'off', autocapitalize: 'none', onkeydown: leaveByEscape,
    onfocus: () => fill(known, [...robots].slice(0, MOST_NAMED).map((id) =>
      h('option', { value: id }))) });
  const selects = CHOICES.map(([name, label, options]) => h('label', {}, h('span', {}, label),
    h('select', { name, onchange: (event: Event) =>
      set(name, (event.target as HTMLSelectElement).value) },
    options.map(([value, text]) => h('option', { value, selected: value === filter[name] }, text)))));
  const isWide = matchMedia('(min-width: 40rem)').matches; // on a phone it would be in the way
  return h('form', { role: 'search', 'aria-label': 'Filter incidents',
    onsubmit: (event: Event) => event.preventDefault() },
  h('details', { class: 'filter-box', open: isWide || !isEmpty(filter) },
    h('summary', {}, 'Filter'),
    h('div', { class: 'choosers' }, h('label', {}, h('span', {}, 'Robot'), robot), known, selects,
      between)));
}

function leaveByEscape(event: KeyboardEvent): void {
  if (event.key === 'Escape') (event.target as HTMLElement).blur();
}
