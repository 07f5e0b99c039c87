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
    const event = Object.assign(new Event("message"), { data: { type, messages } });
    this.dispatchEvent(event);
    this.onmessage?.(event);
  }
  /** viser's. @type {((event: any) => void) | null} */
  onmessage = null;
}

/** The frame's window before anything runs in it. @returns {any} */
const emptyFrame = () => ({
  console: { warn: () => {} },
  document: {},
  parent: { postMessage() {} },
  location: { hash: "#pass" },
  HTMLCanvasElement: class {
    getContext() {
      return null;
    }
  },
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
});

/** Run our scripts in it. @param {any} page */
async function framed(page) {
  page.window = page;
  page.document.createElement ??= () => new page.HTMLCanvasElement();
  vm.createContext(page);
  for (const script of ["aside.js", "frame.js"])
    vm.runInContext(await readFile(new URL(`../../viser/${script}`, import.meta.url), "utf8"), page);
  return page;
}

/** A worker as viser's client gets it in the frame. @returns {Promise<Thread>} */
const framedThread = async () => new (await framed(emptyFrame())).Worker("blob:viser");

/**
 * A client on a machine whose frames take half a second, that shows a scene and has been left alone for a while.
 *
 * @param {string} renderer what draws
 */
async function slowClient(renderer = "") {
  const FRAME_MS = 500;
  const client = {
    now: 0,
    /** What the browser draws next. @type {((time: number) => void)[]} */
    next: [],
    /** When what is due. @type {[number, () => void][]} */
    timers: [],
    resized: () => {},
    /** @type {(message: any) => void} */
    listener: () => {},
    /** What viser draws with. @type {any} */
    gl: null,
    frames: 0,
    /** Frames that the canvas got, without a GPU. */
    copied: 0,
    /** Whether what is drawn without a GPU is finished. */
    finished: true,
    /** The bytes of every pixel, without a GPU; another one in each frame that says nothing of it. @type {number | null} */
    light: null,
    /** That of the picture on the canvas. */
    shown: 0,
    /** Of them those that reached the canvas. */
    drawn: 0,
    requested: false,
    /** As viser asks for a frame. */
    invalidate() {
      if (client.requested) return;
      client.requested = true;
      page.requestAnimationFrame(() => {
        client.requested = false;
        client.frames++;
        gl.clear();
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
    drawingBufferWidth: 1000,
    drawingBufferHeight: 500,
    createQuery: () => ({}),
    getExtension: () => ({ loseContext() {} }),
    getParameter: () => renderer,
    isContextLost: () => false,
    SIGNALED: 1,
    getSyncParameter: () => Number(client.finished),
    getQueryParameter: () => true,
    clear: () => client.drawn++,
  };
  const draws = ["drawArrays", "drawArraysInstanced", "drawElements", "drawElementsInstanced"];
  const others = ["deleteSync", "flush", "bindFramebuffer", "bindBuffer", "bufferData", "readPixels"];
  const more = ["beginQuery", "endQuery", "deleteQuery"];
  for (const name of [...draws, ...others, ...more]) Object.assign(gl, { [name]: () => {} });
  for (const name of ["fenceSync", "createBuffer"]) Object.assign(gl, { [name]: () => ({}) });
  Object.assign(gl, {
    /** @param {any[]} to */
    getBufferSubData: (...to) => to[2].fill(client.light ?? client.frames % 250),
  });
  client.gl = gl;
  const page = Object.assign(emptyFrame(), {
    HTMLCanvasElement: class {
      width = 300;
      height = 150;
      /** @param {string} kind */
      getContext(kind) {
        if (kind !== "2d") return gl;
        return {
          putImageData: (/** @type {ImageData} */ { data }) => {
            client.copied++;
            client.shown = data[3];
          },
        };
      }
    },
    OffscreenCanvas: class {
      getContext() {
        return gl;
      }
    },
    ImageData: class {
      data = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    },
    CanvasRenderingContext2D: class {
      drawImage() {}
    },
    MutationObserver: class {
      /** @param {() => void} listener */
      constructor(listener) {
        client.resized = listener;
      }
      observe() {}
    },
    performance: { now: () => client.now },
    /** @param {() => void} act */
    setTimeout: (act, ms = 0) => void client.timers.push([client.now + ms, act]),
    clearTimeout: () => {},
    /** @param {string} kind @param {(message: any) => void} listener */
    addEventListener: (kind, listener) => kind === "message" && (client.listener = listener),
    /** @param {(time: number) => void} callback */
    requestAnimationFrame: (callback) => client.next.push(callback),
  });
  await framed(page);
  new page.HTMLCanvasElement().getContext("webgl2", { antialias: true });
  const thread = new page.Worker("blob:viser");
  thread.answer("connected");
  thread.answer("message_batch", []);
  for (let frame = 0; frame < 8; frame++) {
    client.invalidate();
    client.frame();
    client.pass(100);
  }
  assert.ok(client.requested, "an idle frame did not wait");
  return { client, page, thread, tell: (/** @type {any} */ data) => client.listener({ source: page.parent, data }) };
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

test("a canvas that changes its size is drawn in the next frame, though idle frames wait", async () => {
  const { client } = await slowClient();
  const { frames } = client;
  client.resized();
  client.frame();
  assert.equal(client.frames, frames + 1);
});

test("a canvas that changes its size is drawn while somebody paints, too", async () => {
  const { client, tell } = await slowClient();
  const { frames } = client;
  tell({ hold: true });
  client.pass(10_000);
  client.frame();
  assert.equal(client.frames, frames, "frames did not wait for the stroke");
  client.resized();
  client.frame();
  assert.equal(client.frames, frames + 1);
});

test("a number that stands for no frame takes none back", async () => {
  const { client, page, tell } = await slowClient();
  const { frames } = client;
  tell({ hold: true });
  for (const none of [-1, 0, 1]) page.cancelAnimationFrame(none);
  tell({ hold: false });
  client.pass(40_000);
  client.frame();
  assert.equal(client.frames, frames + 1);
});

test("a slow machine draws what viser asks for, and not what it draws every second", async () => {
  const { client, page } = await slowClient();
  page.__viserMutable = { cameraControl: {}, requestRender: () => client.invalidate() };
  client.resized();
  client.frame(); // finds the camera
  client.pass(3000);
  const { frames } = client;
  for (let second = 0; second < 8; second++) {
    client.invalidate();
    client.frame();
    client.pass(1000);
  }
  assert.equal(client.frames, frames, "a frame without news did not wait");
  page.__viserMutable.requestRender();
  client.frame();
  assert.equal(client.frames, frames + 1, "something new waited");
});

/** A slow client that shows cloth of one shape, and what viser is told from now on. */
async function withCloth() {
  const { client, page, thread } = await slowClient();
  /** @type {Record<string, {traverse: (look: (part: object) => void) => void}>} */
  const nodeRefFromName = {};
  page.__viserMutable = { nodeRefFromName, requestRender: () => client.invalidate() };
  /** @type {string[]} */
  const messages = [];
  thread.onmessage = (/** @type {any} */ { data }) =>
    messages.push(...data.messages.map((/** @type {any} */ { type, name = "" }) => `${type} ${name}`.trim()));
  const built = (/** @type {string} */ name) => {
    nodeRefFromName[name] = { traverse: (look) => look({ instancesCount: 120 }) };
  };
  const decoded = (/** @type {string} */ name) => {
    nodeRefFromName[name] = { traverse: (look) => look({ material: { map: {} } }) };
  };
  const drawn = () => {
    client.invalidate();
    client.frame();
    client.pass(40_000); // longer than a frame waits
    client.frame();
  };
  thread.answer("message_batch", [{ ...NEW, name: "/fabric/1" }]);
  built("/fabric/1");
  messages.length = 0;
  return { client, thread, messages, built, decoded, drawn };
}

/** Where stitches are. @param {number} stitches */
const places = (stitches) => ({
  batched_positions: new Float32Array(3 * stitches),
  batched_scales: new Float32Array(3 * stitches),
  batched_wxyzs: new Float32Array(4 * stitches),
});
/** @param {number} stitches */
const colours = (stitches) => ({ batched_colors: new Uint8Array(3 * stitches) });

const NEW = { type: "BatchedMeshesMessage", name: "/fabric/2", props: { ...places(120), ...colours(120) } };
const MOVED = { type: "SceneNodeUpdateMessage", name: "/fabric/1" };
const GONE = { type: "RemoveSceneNodeMessage", name: "/fabric/1" };

test("stitches move and go once new shapes are built, however late messages come", async () => {
  const { thread, messages, built, drawn } = await withCloth();
  thread.answer("message_batch", [MOVED, NEW, GONE]);
  drawn();
  assert.deepEqual(messages, ["BatchedMeshesMessage /fabric/2"], "there is a hole in the cloth");
  thread.answer("message_batch", [{ type: "GetRenderRequestMessage" }]);
  drawn();
  assert.equal(messages.length, 1, "a picture was taken of half a cloth");
  built("/fabric/2");
  drawn();
  assert.deepEqual(messages.slice(1), [
    "SceneNodeUpdateMessage /fabric/1",
    "RemoveSceneNodeMessage /fabric/1",
    "GetRenderRequestMessage",
  ]);
});

test("the camera and all that is no cloth never wait", async () => {
  const { thread, messages } = await withCloth();
  const others = ["SetCameraPositionMessage", "SetCameraLookAtMessage", "SetCameraUpDirectionMessage"];
  thread.answer("message_batch", [NEW, GONE, ...others.map((type) => ({ type }))]);
  const rest = [{ type: "SetCameraFovMessage" }, { type: "RemoveSceneNodeMessage", name: "/mark" }];
  thread.answer("message_batch", rest);
  const expected = ["BatchedMeshesMessage /fabric/2", ...others, "SetCameraFovMessage", "RemoveSceneNodeMessage /mark"];
  assert.deepEqual(messages, expected);
});

test("what is new of a shape comes at once, for one number of stitches", async () => {
  const { thread } = await withCloth();
  /** How many values come of what. @type {object[]} */
  const come = [];
  thread.onmessage = (/** @type {any} */ { data }) => {
    for (const { updates } of data.messages)
      come.push(Object.fromEntries(Object.keys(updates).map((what) => [what, updates[what].length])));
  };
  const send = (/** @type {object} */ updates) => {
    thread.answer("message_batch", [{ ...MOVED, updates }]);
    return come.splice(0);
  };
  const { batched_positions, ...others } = places(130);
  assert.deepEqual(send(colours(120)), [{ batched_colors: 360 }]);
  assert.deepEqual(send(colours(130)), [], "colours of more stitches than there are");
  assert.deepEqual(send({ batched_positions }), []);
  const all = { batched_positions: 390, batched_scales: 390, batched_wxyzs: 520, batched_colors: 390 };
  assert.deepEqual(send(others), [all]);
  assert.deepEqual(send({ ...places(130), ...colours(130) }), [all]);
});

test("a cloth that only moves does not wait", async () => {
  const { thread, messages } = await withCloth();
  thread.answer("message_batch", [MOVED]);
  assert.deepEqual(messages, ["SceneNodeUpdateMessage /fabric/1"]);
});

test("shapes that are never built keep nothing waiting for ever", async () => {
  const { thread, messages, drawn } = await withCloth();
  thread.answer("message_batch", [NEW, GONE]);
  for (let frame = 0; frame < 320; frame++) drawn();
  assert.deepEqual(messages, ["BatchedMeshesMessage /fabric/2", "RemoveSceneNodeMessage /fabric/1"]);
});

test("nothing is drawn while shapes are built, and the whole cloth afterwards", async () => {
  const { client, thread, built, drawn } = await withCloth();
  drawn();
  const before = client.drawn;
  thread.answer("message_batch", [MOVED, NEW, GONE]);
  for (let frame = 0; frame < 3; frame++) drawn();
  assert.equal(client.drawn, before, "half a cloth was drawn");
  built("/fabric/2");
  for (let frame = 0; frame < 3; frame++) drawn();
  assert.ok(client.drawn > before, "the cloth was never drawn");
});

test("nothing is drawn while a picture of the cloth is decoded, however long that takes", async () => {
  const { client, thread, drawn, decoded } = await withCloth();
  drawn();
  const before = client.drawn;
  thread.answer("message_batch", [{ type: "ImageMessage", name: "/back" }]);
  for (let frame = 0; frame < 3; frame++) drawn();
  assert.equal(client.drawn, before, "a white board was drawn behind the cloth");
  decoded("/back");
  client.frame();
  client.frame();
  assert.ok(client.drawn > before, "the picture waited for an idle frame");
});

test("a canvas that loses its picture while shapes are built is drawn again at once", async () => {
  const { client, thread, drawn } = await withCloth();
  drawn();
  thread.answer("message_batch", [MOVED, NEW, GONE]);
  drawn();
  const before = client.drawn;
  client.gl.drawingBufferWidth /= 2; // a canvas of another size is empty
  for (let frame = 0; frame < 3; frame++) drawn();
  assert.equal(client.drawn, before + 1);
});

test("without a GPU the canvas gets a frame once it is finished, and the next one waits", async () => {
  const { client } = await slowClient("SwiftShader");
  const wait = () => {
    for (let turn = 0; turn < 20; turn++) {
      client.pass(5000);
      client.frame();
    }
  };
  wait();
  const { frames, copied } = client;
  client.finished = false;
  for (let more = 0; more < 2; more++) {
    client.invalidate();
    wait();
    assert.equal(client.frames, frames + 1, "a frame was begun before the one before was finished");
    assert.equal(client.copied, copied, "the canvas got what was not finished");
  }
  client.finished = true;
  wait();
  assert.equal(client.frames, frames + 2);
  assert.equal(client.copied, copied + 2);
});

test("without a GPU a view that rests is drawn smooth: shifted seven times, and the mean is shown", async () => {
  const { client, page } = await slowClient("SwiftShader");
  const camera = { projectionMatrix: { elements: Array(16).fill(0) }, matrixWorld: { elements: Array(16).fill(0) } };
  page.__viserMutable = { camera, cameraControl: {}, requestRender: () => client.invalidate() };
  /** @type {string[]} */
  const shifts = [];
  const { clear } = client.gl;
  const drawing = (/** @type {() => void} */ what) => {
    client.gl.clear = () => {
      clear();
      what();
    };
  };
  drawing(() => {
    shifts.push(String(camera.projectionMatrix.elements.slice(8, 10)));
    client.light = shifts.length < 4 ? 100 : 180;
  });
  const turns = (/** @type {number} */ count) => {
    for (let turn = 0; turn < count; turn++) {
      client.pass(50);
      client.frame();
    }
  };
  client.invalidate();
  client.pass(40_000);
  turns(200);
  assert.equal(shifts.length, 8);
  assert.equal(new Set(shifts).size, 8, "two frames were shifted alike");
  assert.equal(shifts[0], "0,0");
  assert.equal(client.shown, (3 * 100 + 5 * 180) / 8);
  assert.deepEqual(camera.projectionMatrix.elements, Array(16).fill(0));

  client.light = 100; // the next frame is the first of these again, so the smooth picture stays
  drawing(() => shifts.push("again"));
  const { copied } = client;
  page.__viserMutable.requestRender();
  turns(200);
  assert.equal(shifts.length, 9);
  assert.equal(client.copied, copied);

  drawing(() => {
    shifts.push("glides");
    client.light = shifts.length < 14 ? 0 : 200;
    if (shifts.length < 15) camera.matrixWorld.elements[0]++;
  });
  client.invalidate();
  client.pass(40_000);
  turns(400);
  assert.equal(client.shown, 200, "frames were mixed while the camera moved");
  assert.ok(shifts.length <= 15 + 8);
});
