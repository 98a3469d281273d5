// SPDX-License-Identifier: Apache-2.0
// What people do with the dashboard, in a real browser: tests/web/run.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { DESKTOP, launched, PHONE, Visitor } from './browser.mjs';
import { eventually, Stack } from './stack.mjs';

const { QUICK, SCREENSHOTS } = process.env;
const SCRIPT = '<script>window.hacked = true</script><img src=x onerror="window.hacked = true">';
const MOST_BYTES = 150_000;

let stack;
let browser;

before(async () => {
  [stack, browser] = await Promise.all([Stack.started(), launched()]);
  // History: two robots that were carried off once and again.
  await stack.simulate('--robots', '2', '--speed', '10', '--duration', '90', '--kidnap-every', '40',
    '--name', 'agv').done;
  await eventually('both robots have an incident', async () => (await incidents()).length >= 2);
}, { timeout: 60_000 });

after(async () => {
  await browser?.close();
  await stack?.stop();
});

async function incidents(query = '') {
  return (await stack.api('GET', `/api/v1/incidents${query}`)).incidents;
}

async function incident(id) {
  return await stack.api('GET', `/api/v1/incidents/${id}`);
}

const visit = (role, options) => Visitor.of(browser, stack, role, options);
async function photograph(visitor, name) {
  if (!SCREENSHOTS) return;
  await visitor.page.screenshot({ fullPage: true, path: `${SCREENSHOTS}/${name}.png` });
}

const rows = (page) => page.locator('.inbox > li');
const current = (page) => page.locator('.inbox > li:has(a:focus)');
const said = (page) => page.locator('.said');

test('a page needs less than 150 kB, compressed, and nothing from elsewhere', async (t) => {
  const visitor = await visit('viewer');
  const session = await visitor.context.newCDPSession(visitor.page);
  const addresses = new Map();
  let bytes = 0;
  await session.send('Network.enable');
  session.on('Network.responseReceived', ({ requestId, response }) =>
    addresses.set(requestId, new URL(response.url)));
  session.on('Network.loadingFinished', ({ requestId, encodedDataLength }) => {
    if (!addresses.get(requestId).pathname.startsWith('/api/')) bytes += encodedDataLength;
  });
  await visitor.open('#/fleet');
  t.diagnostic(`first load: ${bytes} bytes`);
  assert.ok(bytes > 10_000 && bytes < MOST_BYTES, `${bytes} bytes`);
  assert.deepEqual(new Set([...addresses.values()].map(({ origin }) => origin)), new Set([stack.url]));
  await visitor.leave();
});

test('signing in takes a token that the service knows', async () => {
  const visitor = await visit(undefined);
  const { page } = visitor;
  await page.goto('/');
  await page.getByLabel('Token').fill('kw_wrong');
  await page.getByLabel('Token').press('Enter');
  await page.getByRole('alert').filter({ hasText: /\w/ }).waitFor();
  await visitor.isAccessible('signing in');
  await page.getByLabel('Token').fill(stack.tokens.viewer);
  await page.getByRole('button', { name: 'Sign in' }).click();
  await page.getByRole('heading', { name: 'Fleet' }).waitFor();
  await page.getByRole('button', { name: 'Sign out' }).click();
  await page.getByLabel('Token').waitFor();
  // The browser itself tells each 401 as an error.
  visitor.complaints = visitor.complaints.filter((one) => !one.includes('401'));
  await visitor.leave();
});

test('viewers see no actions', async () => {
  const visitor = await visit('viewer');
  const { page } = visitor;
  const [{ id }] = await incidents();
  await visitor.open('#/incidents');
  assert.equal(await page.getByRole('checkbox').count(), 0);
  await page.keyboard.press('j');
  await page.keyboard.press('a');
  await visitor.open(`#/incidents/${id}`);
  for (const name of ['Acknowledge', 'Resolve', 'Shelve', 'Label']) {
    assert.equal(await page.getByRole('button', { name }).count(), 0, name);
  }
  await page.getByRole('button', { name: 'Download evidence' }).waitFor();
  await visitor.open('#/tuning');
  assert.equal(await page.getByRole('slider').count(), 0);
  assert.equal(await page.getByRole('button', { name: /Save|Restore/ }).count(), 0);
  assert.equal((await incident(id)).state, (await incidents())[0].state);
  await visitor.leave();
});

test('a kidnapping appears live, and is acknowledged and labelled by keyboard', async (t) => {
  const visitor = await visit('operator');
  const { page } = visitor;
  await visitor.open('#/incidents');
  await page.locator('.stream-live').waitFor();
  await page.evaluate(() => {
    window.shownAt = {};
    new MutationObserver(() => document.querySelectorAll('.inbox > li').forEach((row) => {
      window.shownAt[row.dataset.id] ??= performance.timeOrigin + performance.now();
    })).observe(document.querySelector('.inbox'), { childList: true });
  });
  const scans = stack.scanTimes('live-0001');
  const robots = stack.simulate('--robots', '1', '--speed', '5', '--duration', '60', '--kidnap-every',
    '30', '--name', 'live');
  const row = rows(page).filter({ hasText: 'live-0001' }).first();
  await row.waitFor({ timeout: 30_000 });
  const id = await row.getAttribute('data-id');
  const { scanTime } = await incident(id);
  const scanned = await eventually('the scan is known', () => scans.get(
    `${Date.parse(scanTime.slice(0, 19) + 'Z') / 1000}.${scanTime.slice(20, 29)}`));
  const shown = await page.evaluate((of) => window.shownAt[of], id);
  t.diagnostic(`visible ${(shown - scanned).toFixed(0)} ms after the scan that confirmed it`);
  assert.ok(shown - scanned < 5000, 'visible long after its scan');

  await page.keyboard.press('j');
  await current(page).filter({ hasText: 'live-0001' }).waitFor();
  await page.keyboard.press('a');
  await row.getByText('acknowledged').waitFor();
  assert.equal((await incident(id)).acknowledgedBy, 'operator-test');
  await page.keyboard.press('u');
  await row.getByText('open', { exact: true }).waitFor();

  await page.keyboard.press('l');
  await visitor.isAccessible('labelling');
  await photograph(visitor, 'label');
  await page.keyboard.press('ArrowDown'); // from kidnapping to false alarm
  await page.keyboard.press('Tab');
  await page.keyboard.type(SCRIPT);
  await page.keyboard.press('Control+Enter');
  await row.getByText('false alarm').waitFor();
  await row.getByText(SCRIPT).waitFor();
  assert.equal((await incident(id)).label, 'false_alarm');
  assert.equal((await incident(id)).comment, SCRIPT);
  await current(page).filter({ hasText: 'live-0001' }).waitFor(); // the dialog gave the focus back

  await page.keyboard.press('s');
  await visitor.isAccessible('shelving');
  await photograph(visitor, 'shelve');
  await page.getByLabel('1 hour').check();
  await page.keyboard.press('Enter');
  await row.getByText('shelved').waitFor();
  await page.keyboard.press('Enter');
  await page.getByRole('heading', { level: 1, name: /live-0001/ }).waitFor();
  await page.locator('.comment').getByText(SCRIPT).waitFor();
  await page.locator('.timeline').getByText(/labelled it false alarm/).waitFor();
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  await visitor.isAccessible('an incident with a hostile comment');
  robots.kill();
  await robots.done;
  await visitor.leave();
});

test('keys do nothing while somebody types, and can be turned off', async () => {
  const visitor = await visit('operator');
  const { page } = visitor;
  await visitor.open('#/incidents?robot=agv-0001');
  const count = await rows(page).count();
  assert.equal(count, (await incidents('?robot=agv-0001')).length);
  await page.keyboard.press('/');
  await page.keyboard.type('jarx');
  assert.equal(await page.getByLabel('Robot').inputValue(), 'jarx');
  await page.keyboard.press('Enter');
  await page.getByText('No incident fits this filter.').waitFor();
  assert.match(page.url(), /robot=jarx/);
  await page.getByRole('button', { name: 'Show all incidents' }).click();
  await rows(page).nth(count).waitFor();

  await page.keyboard.press('?');
  await visitor.isAccessible('the keys');
  await page.getByLabel('Keys of one letter are on').uncheck();
  await page.keyboard.press('Escape');
  await page.keyboard.press('ArrowDown');
  const first = await current(page).getAttribute('data-id');
  await page.keyboard.press('j');
  assert.equal(await current(page).getAttribute('data-id'), first);
  await page.keyboard.press('ArrowDown');
  assert.notEqual(await current(page).getAttribute('data-id'), first);
  await visitor.leave();
});

test('several incidents are labelled at once', async () => {
  const visitor = await visit('operator');
  const { page } = visitor;
  await visitor.open('#/incidents?robot=agv-0002');
  const count = await rows(page).count();
  for (let i = 0; i < count; ++i) {
    await page.keyboard.press('j');
    await page.keyboard.press('x');
  }
  await page.getByText(`${count} selected`).waitFor();
  await page.keyboard.press('l');
  await page.getByRole('button', { name: 'Label', exact: true }).last().click();
  await eventually('all are labelled', async () =>
    (await incidents('?robot=agv-0002')).every(({ label }) => label === 'kidnapping'));
  await page.locator('.bulk').waitFor({ state: 'hidden' });
  await visitor.leave();
});

test('an incident shows its evidence, and gives it away', async () => {
  const visitor = await visit('viewer');
  const { page } = visitor;
  const [{ id, robotId }] = await incidents('?robot=agv-0001');
  const evidence = await stack.api('GET', `/api/v1/incidents/${id}/evidence`);
  await visitor.open(`#/incidents/${id}`);
  const picture = page.getByRole('img', { name: /Both scans over each other/ });
  await picture.waitFor();
  const drawn = async () => await picture.evaluate((canvas) => canvas.toDataURL());
  const seen = await drawn();
  await page.getByRole('button', { name: 'Raw' }).click();
  const raw = await drawn();
  assert.notEqual(seen, raw);
  await page.getByRole('button', { name: 'Warping path' }).click();
  assert.notEqual(await drawn(), raw);
  const [i, j] = evidence.warping.steps[0];
  const walk = page.getByLabel('Walk along the warping');
  await walk.focus();
  await page.keyboard.press('ArrowRight');
  assert.match(await walk.getAttribute('aria-valuetext'),
    new RegExp(`^Beam ${i} .* before matches ${j} .* after`));
  await page.getByRole('img', { name: /^QS-2DDTW: .* at the jump/ }).waitFor();
  await page.getByRole('img', { name: /^NDT Qs: / }).waitFor();

  const waiting = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Download evidence' }).click();
  const file = await waiting;
  assert.equal(file.suggestedFilename(), `incident-${robotId}-${id}.json`);
  const content = JSON.parse(readFileSync(await file.path(), 'utf8'));
  assert.deepEqual(content.evidence, evidence);
  assert.equal(content.incident.id, id);
  await visitor.leave();
});

test('names and texts from elsewhere are only ever text, on every page', async () => {
  const visitor = await visit('admin');
  const { page } = visitor;
  const texts = ['robotId', 'explanation', 'comment', 'author', 'detail', 'acknowledgedBy', 'what'];
  const [{ id }] = await incidents();
  await page.route('**/api/v1/**', async (route) => {
    if (route.request().url().endsWith('/events')) return await route.continue();
    const answer = await route.fetch();
    const text = JSON.stringify(await answer.json(), (name, value) =>
      (texts.includes(name) ? SCRIPT : value));
    return await route.fulfill({ response: answer, body: text });
  });
  for (const address of ['#/fleet', '#/incidents', `#/incidents/${id}`, '#/robots/agv-0001',
    '#/tuning', '#/service']) {
    await visitor.open(address);
    assert.equal(await page.evaluate(() => window.hacked), undefined, address);
    assert.equal(await page.locator('main script, main img').count(), 0, address);
  }
  await visitor.open('#/incidents');
  await rows(page).first().getByText(SCRIPT).first().waitFor();
  await visitor.leave();
});

test('a threshold is tried out, saved, and taken back', async () => {
  const visitor = await visit('admin');
  const { page } = visitor;
  const figure = (name) => page.locator('.figures div').filter({ hasText: name }).locator('dd');
  const [kidnapped] = await incidents('?robot=agv-0002');
  await stack.api('POST', `/api/v1/incidents/${kidnapped.id}/label`, { label: 'kidnapping' });
  await visitor.open('#/tuning');
  const all = Number(await figure('Kept').innerText());
  assert.ok(all >= 2, `${all} kept`);
  await page.getByLabel('Exactly').fill('100000');
  await page.getByLabel('Exactly').press('Enter');
  await figure('Lost').getByText(String(all)).waitFor();
  await page.getByText(/labelled kidnapping$/).waitFor();
  const slider = page.getByRole('slider', { name: 'Try' });
  await slider.focus();
  await page.keyboard.press('Home');
  await figure('Kept').getByText(String(all), { exact: true }).waitFor();
  const exact = async () => Number(await page.getByLabel('Exactly').inputValue());
  const lowest = await exact();
  const { x, y, width, height } = await page.locator('.strip').boundingBox();
  await page.mouse.move(x + width / 2, y + height - 40);
  await page.mouse.down();
  const middle = await exact();
  await page.mouse.move(x + 0.8 * width, y + height - 40);
  await page.mouse.up();
  assert.ok(lowest < middle && middle < await exact(), `${lowest}, ${middle}, ${await exact()}`);

  await page.getByLabel('Exactly').fill('7.5');
  await page.getByLabel('Exactly').press('Enter');
  await page.getByRole('button', { name: 'Save 7.5 for the fleet' }).click();
  await said(page).getByText(/Saved as version/).waitFor();
  const saved = await stack.api('GET', '/api/v1/config');
  assert.equal(saved.effective.motion.threshold_min, 7.5);
  assert.equal(saved.author, 'admin-test');

  await page.getByLabel('Exactly').fill('8');
  await page.getByLabel('Exactly').press('Enter');
  await stack.api('PATCH', '/api/v1/config', { motion: { threshold_min: 9 } });
  await page.getByRole('button', { name: 'Save 8 for the fleet' }).click();
  await page.getByText(/somebody else changed it meanwhile/).waitFor();
  assert.equal((await stack.api('GET', '/api/v1/config')).effective.motion.threshold_min, 9);
  await page.getByRole('button', { name: 'Load what is there now' }).click();
  await page.locator('dd').getByText('9', { exact: true }).waitFor();

  await page.getByRole('button', { name: `Restore version ${saved.version}` }).click();
  await page.getByRole('button', { name: 'Restore', exact: true }).last().click();
  await said(page).getByText(/is restored/).waitFor();
  assert.equal((await stack.api('GET', '/api/v1/config')).effective.motion.threshold_min, 7.5);
  visitor.complaints = visitor.complaints.filter((one) => !one.includes('412')); // the browser tells it
  await visitor.leave();
});

test('operators try out, and may not save', async () => {
  const visitor = await visit('operator');
  const { page } = visitor;
  await visitor.open('#/tuning?robot=agv-0001&detector=qs2ddtw');
  await page.locator('.figures').waitFor();
  assert.equal(await page.getByRole('button', { name: /Save|Restore/ }).count(), 0);
  await page.getByLabel('One natural score above it in').fill('1000');
  await page.getByRole('button', { name: 'Find the threshold' }).click();
  await page.getByRole('button', { name: /^Try \d/ }).first().click();
  await visitor.settled();
  await visitor.leave();
});

const SCREENS = {
  fleet: '#/fleet', robot: '#/robots/agv-0001', incidents: '#/incidents', incident: '#/incidents/ID',
  tuning: '#/tuning', service: '#/service',
};

test('every screen is accessible', { timeout: 240_000 }, async () => {
  const [{ id }] = await incidents('?robot=agv-0001');
  const all = [['desktop', DESKTOP, 'light'], ['phone', PHONE, 'dark'], ['desktop', DESKTOP, 'dark'],
    ['phone', PHONE, 'light']];
  for (const [device, options, colorScheme] of QUICK && !SCREENSHOTS ? all.slice(0, 2) : all) {
    const visitor = await visit('admin', { ...options, colorScheme });
    for (const [name, address] of Object.entries(SCREENS)) {
      await visitor.open(address.replace('ID', id));
      await visitor.isAccessible(`${name}, ${device}, ${colorScheme}`);
      const overflow = await visitor.page.evaluate(() =>
        document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(overflow <= 0, `${name}, ${device}: scrolls sideways by ${overflow} px`);
      await photograph(visitor, `${name}-${device}-${colorScheme}`);
    }
    await visitor.leave();
  }
});
