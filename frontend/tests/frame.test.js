/** The script in the frame of the 3D view, beside a client and a worker that are made up. */

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import vm from "node:vm";

class Thread extends EventTarget {
  /** @type {string[]} */
  sent = [];
  /** @param {{type: string}} message */
  postMessage({ type }) {
    this.sent.push(type);
  }
  /** @param {string} type */
  answer(type) {
    this.dispatchEvent(Object.assign(new Event("message"), { data: { type } }));
  }
}

/** A worker as viser's client gets it in the frame. */
async function framedThread() {
  /** @type {any} */
  const page = {
    console: { warn: () => {} },
    document: {},
    location: { hash: "#pass" },
    HTMLCanvasElement: class {},
    Worker: Thread,
    XMLHttpRequest: class {
      responseText = "";
      open() {}
      send() {}
    },
    Blob,
    URL,
    performance,
    setTimeout,
    clearTimeout,
    addEventListener() {},
    requestAnimationFrame() {},
    cancelAnimationFrame() {},
  };
  page.window = page.parent = page;
  vm.runInNewContext(await readFile(new URL("../frame.js", import.meta.url), "utf8"), page);
  return /** @type {Thread} */ (new page.Worker("blob:viser"));
}

test("a connection that is being made is not given up for another one", async () => {
  const thread = await framedThread();
  thread.postMessage({ type: "set_server" });
  thread.postMessage({ type: "retry" });
  await Promise.resolve();
  assert.deepEqual(thread.sent, ["set_server"]);
  thread.answer("closed");
  for (let second = 0; second < 3; second++) thread.postMessage({ type: "retry" });
  assert.deepEqual(thread.sent, ["set_server", "retry"]);
  thread.answer("closed");
  thread.postMessage({ type: "retry" });
  thread.answer("connected");
  assert.deepEqual(thread.sent, ["set_server", "retry", "retry"]);
});
