import assert from "node:assert/strict";
import { mock, test } from "node:test";

import { paced } from "../../core/paced.js";

test("many wishes are one act, after the last of them comes another", () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  let acts = 0;
  const wish = paced(() => acts++, 80);
  wish();
  wish();
  assert.equal(acts, 0);
  mock.timers.tick(80);
  assert.equal(acts, 1);
  mock.timers.tick(1000);
  assert.equal(acts, 1);
  wish();
  mock.timers.tick(79);
  assert.equal(acts, 1);
  mock.timers.tick(1);
  assert.equal(acts, 2);
  mock.timers.reset();
});
