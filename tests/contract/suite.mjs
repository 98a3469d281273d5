// SPDX-License-Identifier: Apache-2.0
// Runs the checks one after the other: suite.mjs [--requests N] [--seed S] [--only NAME]
import { parseArgs } from 'node:util';

import { events } from './events.mjs';
import { lint } from './lint.mjs';
import { everyTopic } from './mqtt.mjs';
import { operationsThroughPrism } from './operations.mjs';
import { portmanAndNewman } from './portman.mjs';
import { randomRequests } from './random.mjs';
import { Stack } from './stack.mjs';

const { values } = parseArgs({ options: {
  requests: { type: 'string', default: '10000' },
  seed: { type: 'string', default: String(Date.now() % 1_000_000) },
  only: { type: 'string' },
} });

const checks = { lint, operations: operationsThroughPrism, events, mqtt: everyTopic,
  portman: portmanAndNewman, random: randomRequests };

const stack = new Stack();
process.on('exit', () => stack.stop());
let failed = 0;
try {
  if (values.only !== 'lint') await stack.begin();
  for (const [name, check] of Object.entries(checks)) {
    if (values.only && values.only !== name) continue;
    const start = Date.now();
    const { ok, told } = await check(stack, values).then((said) => ({ ok: true, told: said }),
      (error) => ({ ok: false, told: error.stack }));
    failed += ok ? 0 : 1;
    console.log(`${ok ? 'ok    ' : 'FAILED'} ${name} (${((Date.now() - start) / 1000).toFixed(1)} s): ${told}`);
  }
} catch (error) {
  failed += 1;
  console.log(`FAILED before any check: ${error.stack}`);
}
console.log(failed ? `${failed} failed; logs are in ${stack.folder}` : 'all passed');
process.exit(failed ? 1 : 0);
