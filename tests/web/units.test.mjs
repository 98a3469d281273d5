// SPDX-License-Identifier: Apache-2.0
// The parts of the dashboard that need no browser: streams, histograms, resolutions.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { build } from 'esbuild';

async function load(name) {
  const { outputFiles } = await build({
    entryPoints: [new URL(`../../api/web/src/${name}.ts`, import.meta.url).pathname],
    bundle: true, format: 'esm', write: false,
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
}

const { EventParser } = await load('live');
const { histogram, quantile, seconds, since } = await load('metrics');
const { fromBuckets, resolutionFor } = await load('series');

function events(...pieces) {
  const found = [];
  const parser = new EventParser((event) => found.push(event));
  pieces.forEach((piece) => parser.push(piece));
  return found;
}

test('events come whole, however the stream is cut', () => {
  const text = ':hello\n\nretry: 1000\n\nid: 7\nevent: alert\ndata: {"a":\ndata: 1}\n\ndata:x\r\n\r\n';
  const whole = [{ type: 'alert', data: '{"a":\n1}', id: '7' }, { type: 'message', data: 'x' }];
  assert.deepEqual(events(text), whole);
  assert.deepEqual(events(...text), whole);
  for (let cut = 0; cut < text.length; cut++) {
    assert.deepEqual(events(text.slice(0, cut), text.slice(cut)), whole);
  }
  assert.deepEqual(events('data: not over yet\n'), []);
});

const METRICS = `# TYPE x_seconds histogram
x_seconds_count 10
x_seconds_sum 0.05
x_seconds_bucket{le="0.001"} 2
x_seconds_bucket{le="0.01"} 9
x_seconds_bucket{le="+Inf"} 10
y_seconds_bucket{le="1"} 99
`;

test('quantiles are those that Prometheus tells', () => {
  const one = histogram(METRICS, 'x_seconds');
  assert.deepEqual(one, { bounds: [0.001, 0.01, Infinity], counts: [2, 7, 1], sum: 0.05 });
  assert.equal(quantile(one, 0.1), 0.0005);
  assert.ok(Math.abs(quantile(one, 0.5) - (0.001 + 0.009 * 3 / 7)) < 1e-12);
  assert.equal(quantile(one, 0.99), 0.01); // beyond the last bound
  assert.equal(quantile({ bounds: [1], counts: [0], sum: 0 }, 0.5), undefined);
  assert.equal(histogram(METRICS, 'z_seconds'), undefined);
  assert.deepEqual(since(one, one).counts, [0, 0, 0]);
  assert.deepEqual(since(one, { ...one, counts: [3, 0, 0] }), one); // started anew
  assert.deepEqual([0.00049, 0.0254, 2.5, undefined].map(seconds), ['0.49 ms', '25.4 ms', '2.5 s', '–']);
});

test('any stretch of time is at most 800 buckets, and two minutes are every scan', () => {
  assert.equal(resolutionFor(120), 0);
  for (let span = 121; span < 366 * 86400; span *= 1.1) {
    assert.ok(span / resolutionFor(span) <= 800, span);
  }
});

test('a gap in the scores is a gap in the line', () => {
  const spread = { min: 1, max: 3, mean: 2 };
  const at = (minute) => ({ time: `2026-01-31T12:0${minute}:00Z`, seconds: 60, scores: 5, motion: spread, state: 'normal' });
  const { max, state } = fromBuckets([at(0), at(1), at(5)], 'motion', 60);
  assert.deepEqual(max, [3, 3, null, 3]);
  assert.deepEqual(state, ['normal', 'normal', null, 'normal']);
});

test('what is left of old scores is coarser, and said to be', () => {
  const bucket = (time, seconds) => ({ time, seconds, scores: 5, score: { min: 1, max: 3, mean: 2 }, state: 'normal' });
  const { max, resolution } = fromBuckets([bucket('2026-01-31T11:00:00Z', 3600), bucket('2026-01-31T12:00:00Z', 60),
    bucket('2026-01-31T12:01:00Z', 60), bucket('2026-01-31T12:30:00Z', 60)], 'qs2ddtw', 60);
  assert.equal(resolution, 3600);
  assert.deepEqual(max, [3, 3, 3, null, 3]);
});
