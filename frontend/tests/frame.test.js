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
  /** @param {string} type @param {object[]} [messages] */
  answer(type, messages) {
    this.dispatchEvent(new MessageEvent("message", { data: { type, messages } }));
  }
}

/** The frame's window before anything runs in it. @returns {any} */
const emptyFrame = () => ({
  console: { warn: () => {} },
  document: {},
  parent: { postMessage() {} },
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
  MessageEvent,
  MutationObserver: class {
    observe() {}
    takeRecords() {}
  },
});

/** Run our script in it. @param {any} page */
async function framed(page) {
  page.window = page;
  vm.runInNewContext(await readFile(new URL("../frame.js", import.meta.url), "utf8"), page);
  return page;
}

/** A worker as viser's client gets it in the frame. @returns {Promise<Thread>} */
const framedThread = async () => new (await framed(emptyFrame())).Worker("blob:viser");

/** A client on a machine whose frames take half a second, that shows a scene and has been left alone for a while. */
async function slowClient() {
  const FRAME_MS = 500;
  const client = {
    now: 0,
    /** What the browser draws next. @type {((time: number) => void)[]} */
    next: [],
    /** When what is due. @type {[number, () => void][]} */
    timers: [],
    resized: () => {},
    /** @type {(message: any) => void} */
    told: () => {},
    frames: 0,
    wanted: false,
    /** As viser asks for a frame. */
    invalidate() {
      if (client.wanted) return;
      client.wanted = true;
      page.requestAnimationFrame(() => {
        client.wanted = false;
        client.frames++;
        client.now += FRAME_MS;
      });
    },
    /** The browser's turn to draw. */
    frame() {
      for (const callback of client.next.splice(0)) callback(client.now);
      client.pass(0);
    },
    /** Time goes by. @param {number} ms */
    pass(ms) {
      client.now += ms;
      for (const [at, act] of client.timers.splice(0)) {
        if (at <= client.now) act();
        else client.timers.push([at, act]);
      }
    },
  };
  const gl = {
    createQuery: () => ({}),
    beginQuery() {},
    endQuery() {},
    deleteQuery() {},
    getExtension: () => null,
    getParameter: () => "",
    getQueryParameter: () => true,
  };
  const page = Object.assign(emptyFrame(), {
    HTMLCanvasElement: class {
      getContext() {
        return gl;
      }
    },
    MutationObserver: class {
      /** @param {() => void} told */
      constructor(told) {
        client.resized = told;
      }
      observe() {}
      takeRecords() {}
    },
    performance: { now: () => client.now },
    /** @param {() => void} act */
    setTimeout: (act, ms = 0) => void client.timers.push([client.now + ms, act]),
    clearTimeout: () => {},
    /** @param {string} kind @param {(message: any) => void} listener */
    addEventListener: (kind, listener) => kind === "message" && (client.told = listener),
    /** @param {(time: number) => void} callback */
    requestAnimationFrame: (callback) => client.next.push(callback),
  });
  page.document.createElement = () => new page.HTMLCanvasElement();
  await framed(page);
  new page.HTMLCanvasElement().getContext("webgl2", { antialias: true });
  const thread = new page.Worker("blob:viser");
  thread.answer("connected");
  thread.answer("message_batch", [{ type: "HemisphereLightMessage", name: "/light" }]);
  for (let frame = 0; frame < 8; frame++) {
    client.invalidate();
    client.frame();
    client.pass(100);
  }
  assert.ok(client.wanted, "an idle frame did not wait");
  return { client, page, thread, tell: (/** @type {any} */ data) => client.told({ source: page.parent, data }) };
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

test("a canvas that changes its size is drawn at once, though idle frames wait", async () => {
  const { client } = await slowClient();
  const { frames } = client;
  client.resized();
  assert.equal(client.frames, frames + 1);
});

test("a canvas that changes its size is drawn at once while somebody paints, too", async () => {
  const { client, tell } = await slowClient();
  const { frames } = client;
  tell({ hold: true });
  client.pass(10_000);
  client.frame();
  assert.equal(client.frames, frames, "frames did not wait for the stroke");
  client.resized();
  assert.equal(client.frames, frames + 1);
});

test("a cloth is taken away once the one after it is built, however late its messages come", async () => {
  const { client, page, thread } = await slowClient();
  const draw = () => {
    client.invalidate();
    client.frame();
    client.pass(10_000);
    client.frame();
  };
  /** @type {Record<string, {traverse: (look: (part: object) => void) => void}>} */
  const nodeRefFromName = {};
  page.__viserMutable = { nodeRefFromName, requestRender: () => client.invalidate() };
  /** @param {string} name */
  const build = (name) => (nodeRefFromName[name] = { traverse: (look) => look({ instancesCount: 120 }) });
  /** What viser was told. @type {string[]} */
  const told = [];
  thread.onmessage = (/** @type {MessageEvent} */ { data }) =>
    told.push(...data.messages.map((/** @type {any} */ { type, name }) => `${type.slice(0, 6)} ${name}`));
  const added = (/** @type {string} */ name) => ({ type: "BatchedMeshesMessage", name });

  thread.answer("message_batch", [added("/1/0"), added("/1/1")]);
  build("/1/0");
  build("/1/1");
  told.length = 0;
  thread.answer("message_batch", [
    added("/2/0"),
    { type: "SetSceneNodeVisibilityMessage", name: "/2/0", visible: false },
    { type: "SetSceneNodeVisibilityMessage", name: "/2/0", visible: true },
    { type: "RemoveSceneNodeMessage", name: "/1/0" },
    { type: "RemoveSceneNodeMessage", name: "/1/1" },
  ]);
  draw();
  assert.deepEqual(told, ["Batche /2/0", "SetSce /2/0"], "a cloth is gone, and the next is not built");
  build("/2/0");
  draw();
  assert.deepEqual(told.slice(2), ["SetSce /2/0", "Remove /1/0", "Remove /1/1"]);
});
