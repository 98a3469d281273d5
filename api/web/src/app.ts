// SPDX-License-Identifier: Apache-2.0
// The frame around the pages: addresses, navigation, connection, who is signed in.
import { append, button, fill, h, setText } from './dom';
import { openIncidents } from './open_incidents';
import * as live from './live';
import { link, type Page } from './page';
import { fleet } from './pages/fleet';
import { incident } from './pages/incident';
import { incidents } from './pages/incidents';
import { robot } from './pages/robot';
import { service } from './pages/service';
import { tuning } from './pages/tuning';
import { onUnauthorized, Problem } from './rest';
import { hasToken, identify, me, signOut } from './session';
import { signInForm } from './sign_in';
import { failed, loading } from './states';

interface Route {
  name: string;
  title: string;
  page: Page;
  ofOne?: { title: string; page: Page };
}

const ROUTES: Route[] = [
  { name: 'fleet', title: 'Fleet', page: fleet },
  { name: 'incidents', title: 'Incidents', page: incidents, ofOne: { title: 'Incident', page: incident } },
  { name: 'tuning', title: 'Tuning', page: tuning },
  { name: 'service', title: 'Service', page: service },
];
const ROBOT: Route = { name: 'robots', title: 'Robot', page: fleet, ofOne: { title: 'Robot', page: robot } };

const STREAM: Record<live.StreamState, string> = {
  off: 'Offline', connecting: 'Connecting', live: 'Live', reconnecting: 'Reconnecting',
};

const links = new Map(ROUTES.map(({ name, title }) => [name, h('a', { href: link(name) }, title)]));
const openCount = h('span', { class: 'count', hidden: true });
const stream = h('span', { class: 'stream', role: 'status' });
const who = h('span', { class: 'who' });
const main = h('main', { id: 'main', tabindex: '-1' });
let title = 'kidnapwatch';
let dispose: () => void = () => undefined;

function frame(): void {
  links.get('incidents')!.append(' ', openCount);
  append(document.body, [
    h('a', { class: 'skip', href: '#main', onclick: (event: Event) => { event.preventDefault(); main.focus(); } },
      'Skip to content'),
    h('header', { class: 'bar' },
      h('a', { class: 'brand', href: link('fleet') }, 'kidnapwatch'),
      h('nav', { 'aria-label': 'Pages' }, [...links.values()]),
      stream, who),
    main,
  ]);
}

/** "#/robots/a%2Fb?x=1" taken apart. */
function address(): { name: string; id?: string; query: URLSearchParams } {
  const [path = '', query = ''] = location.hash.replace(/^#\/?/, '').split('?');
  const [name = '', id] = path.split('/');
  return { name: name || 'fleet', id: id ? decodeURIComponent(id) : undefined, query: new URLSearchParams(query) };
}

function show(): void {
  const { name, id, query } = address();
  const route = [...ROUTES, ROBOT].find((one) => one.name === name) ?? ROUTES[0]!;
  const shown = id !== undefined && route.ofOne ? route.ofOne : route;
  dispose();
  main.replaceChildren();
  links.forEach((element, of) => {
    const isHere = of === name || (of === 'fleet' && name === 'robots');
    if (isHere) element.setAttribute('aria-current', 'page');
    else element.removeAttribute('aria-current');
  });
  title = id !== undefined ? `${id} · ${shown.title}` : shown.title;
  showTitle();
  dispose = shown.page(main, { id, query });
}

function navigate(): void {
  show();
  scrollTo(0, 0);
  main.focus({ preventScroll: true });
}

function showTitle(): void {
  const open = openIncidents.count();
  setText(openCount, String(open));
  openCount.hidden = open === 0;
  openCount.setAttribute('aria-label', `${open} open`);
  document.title = `${open > 0 ? `(${open}) ` : ''}${title} · kidnapwatch`;
}

function showWho(): void {
  const caller = me();
  fill(who, caller && hasToken() && [h('span', { class: 'who-name' }, `${caller.name} (${caller.role}) `), button('Sign out', leave, { class: 'plain' })]);
}

function leave(): void {
  signOut();
  void enter();
}

/** Out of every page: a token is needed, or another one. */
function askForToken(): void {
  stop();
  dispose = signInForm(main, () => void enter());
}

function stop(): void {
  removeEventListener('hashchange', navigate);
  live.stop();
  openIncidents.stop();
  dispose();
  dispose = () => undefined;
  main.replaceChildren();
  showWho();
}

async function enter(): Promise<void> {
  stop();
  main.replaceChildren(loading());
  try {
    await identify();
  } catch (error) {
    if (error instanceof Problem && error.status === 401) askForToken();
    else main.replaceChildren(failed(error, () => void enter()));
    return;
  }
  showWho();
  live.start();
  openIncidents.start(showTitle);
  addEventListener('hashchange', navigate);
  show();
}

frame();
onUnauthorized(askForToken);
live.onState((state) => {
  stream.hidden = state === 'off'; // where nobody is signed in
  setText(stream, STREAM[state]);
  stream.className = `stream stream-${state}`;
});
live.onGap(() => { openIncidents.reload(); show(); });
void enter();
