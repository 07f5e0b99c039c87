import assert from "node:assert/strict";
import { test } from "node:test";

import { Grid } from "../core/grid.js";
import { repeatSize } from "../services/scope.js";

test("the size of a repeat is that of its smallest continuation, also where it is cut off", () => {
  assert.equal(repeatSize(Grid.fromText("KKK\nKKK")), 1);
  assert.equal(repeatSize(Grid.fromText("KPKPK\nPKPKP\nKPKPK\nPKPKP\nKPKPK")), 4);
  assert.equal(repeatSize(Grid.fromText("KKPPKKPP\nKKPPKKPP")), 4);
  assert.equal(repeatSize(Grid.fromText("KPPK\nKKPP\nPKKK")), 12);
});
