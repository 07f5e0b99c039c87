/**
 * The fabric in 3D: the service's viewer in a frame, kept in step with the chart. At most one request
 * is under way; of the changes meanwhile only the last is sent.
 *
 * @import {Studio} from "../studio.js"
 * @import {ViewRequest} from "../types.js"
 */

import { ApiError, api } from "../api.js";
import { OVERLAYS } from "../chart/overlays.js";
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { FrameGovernor } from "./framegovernor.js";

/** Quiet time before the 3D view follows: drawing it may keep a machine without a GPU from painting. */
const DELAY_MS = 650;
/** How long news takes to reach the viewer and be drawn. */
const DRAW_MS = 1500;
const START_MS = 6000;
/** After a stroke another one often follows. */
const BETWEEN_STROKES_MS = 600;

/**
 * @param {HTMLElement} host
 * @param {Studio} studio
 * @returns {() => void} sends the design again, for a service that has forgotten it
 */
export function fabricview(host, studio) {
  const frame = h("iframe", { title: "Fabric in 3D", class: "fabric-frame", tabIndex: 0 });
  const status = h("div", { class: "fabric-status", role: "status" });
  const caption = h("div", { class: "fabric-caption" });
  host.append(frame, caption, status);

  const governor = new FrameGovernor();
  frame.addEventListener("load", () => {
    if (!frame.contentWindow || !shown) return;
    governor.govern(frame.contentWindow);
    governor.wake(START_MS);
  });
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let holding;
  studio.document.onChange(() => {
    governor.hold(true);
    clearTimeout(holding);
    const release = () => {
      if (studio.document.painting) holding = setTimeout(release, BETWEEN_STROKES_MS);
      else governor.hold(false);
    };
    holding = setTimeout(release, BETWEEN_STROKES_MS);
  });

  let sending = false;
  let again = false;
  let shown = "";
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;

  /** @returns {ViewRequest} */
  const wish = () => {
    const stretch = studio.currentStretch();
    const overlay = studio.overlay.value.available(studio) ? studio.overlay.value : OVERLAYS[1];
    return {
      ...studio.request,
      colour: overlay.view,
      rectangles: studio.rectangles.value,
      stretch: stretch ? { id: stretch.id, step: studio.step.value } : null,
    };
  };

  const send = async () => {
    if (sending) {
      again = true;
      return;
    }
    sending = true;
    try {
      const { url } = await api.view(studio.designId, wish());
      status.replaceChildren();
      governor.wake(DRAW_MS);
      studio.online.value = true;
      if (shown !== url) {
        shown = url;
        frame.src = url;
      }
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.offline) studio.online.value = false;
      const { title, detail, remedy } = error.problem;
      status.replaceChildren(
        icon("warning"),
        h("div", {}, h("strong", {}, title), h("p", {}, detail === title ? "" : detail), h("p", {}, remedy ?? "")),
      );
    } finally {
      sending = false;
      if (again) {
        again = false;
        void send();
      }
    }
  };
  const soon = () => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      if (studio.document.painting) soon();
      else void send();
    }, DELAY_MS);
  };
  const now = () => {
    clearTimeout(timer);
    void send();
  };

  status.append(h("span", { class: "spinner" }), "Knitting …");
  studio.document.onChange(soon);
  studio.materialId.listen(soon);
  studio.overlay.listen(soon);
  studio.rectangles.listen(soon);
  studio.stretch.listen(soon);
  studio.step.listen(now);

  const describe = () => {
    const stretch = studio.currentStretch();
    const strain = stretch?.strain[studio.step.value];
    caption.replaceChildren(
      stretch && strain !== undefined
        ? `Stretched ${studio.stretchDirection()}-wise by ${(100 * strain).toFixed(0)} %`
        : "Relaxed, face side",
    );
  };
  studio.stretch.watch(describe);
  studio.step.listen(describe);
  now();
  return () => {
    shown = ""; // a restarted service has new scenes, so the frame must connect anew
    now();
  };
}
