// SPDX-License-Identifier: Apache-2.0
// One HTTP request as it stands: any method, any bytes; no redirect, no retry, no opinion.
import http from 'node:http';

const agent = new http.Agent({ keepAlive: true, maxSockets: 8 });

/// {status, headers, type, body}; `type` is the media type without parameters. An event stream is
/// cut off after `stream_ms`.
export function ask({ port, method = 'GET', path, headers = {}, body, stream_ms = 100 }) {
  return new Promise((resolve, reject) => {
    const length = body === undefined ? {} : { 'Content-Length': Buffer.byteLength(body) };
    const request = http.request({ port, host: '127.0.0.1', method, path, agent,
      headers: { ...length, ...headers }, timeout: 30_000 }, (response) => {
      const parts = [];
      const type = (response.headers['content-type'] ?? '').split(';')[0];
      const done = () => resolve({ status: response.statusCode, headers: response.headers, type,
        body: Buffer.concat(parts).toString() });
      response.on('data', (part) => parts.push(part));
      response.on('end', done);
      response.on('error', reject);
      if (type === 'text/event-stream') {
        setTimeout(() => { done(); request.destroy(); }, stream_ms);
      }
    });
    request.on('timeout', () => request.destroy(new Error('no answer within 30 s')));
    request.on('error', reject);
    request.end(body);
  });
}
