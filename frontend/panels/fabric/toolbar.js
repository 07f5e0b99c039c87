/**
 * What can be done with the fabric in 3D: look from another side, colour its yarn, give it away.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {CameraSide} from "../../types.js"
 */

import { POSES, hindrance } from "../../state/seeing.js";
import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { segmented } from "../../widgets/fields.js";
import { fullButton } from "../../widgets/full.js";
import { menu } from "../../widgets/menu.js";

/** @type {{side: CameraSide, label: string, hint: string}[]} */
const SIDES = [
  { side: "face", label: "Face", hint: "Look at the face" },
  { side: "back", label: "Back", hint: "Look at the back" },
  { side: "edge", label: "Edge", hint: "Look along the columns, from the cast-on edge" },
  { side: "angle", label: "Angle", hint: "Look from below right" },
];

/** @type {[import("../../state/seeing.js").Pose, string][]} */
const HINTS = [
  ["flat", "Pinned out flat"],
  ["lying", "Unpinned: curls and folds as it wants"],
  ["worn", 'Closed to a tube on a limb, its girths under "Limb"; a glove that was planned here on its hand'],
];

/** @type {[import("../../state/seeing.js").YarnColours, string][]} */
const COLOURS = [
  ["chart", "The yarn's own; stiffness and stretch as on the chart"],
  ["yarn", "Always the yarn's own colour"],
  ["region", "Colours of the regions"],
  ["fabric", "The four fabrics, mixed within a stitch"],
  ["phase", "The main fabric of each stitch"],
];

/**
 * @param {Studio} studio
 * @param {(side: CameraSide) => void} look
 * @param {import("./share.js").RequestOfView} request
 */
export function toolbar(studio, look, request) {
  const sides = SIDES.map(({ side, label, hint }) =>
    h("button", { class: "segment", id: `look-${side}`, title: hint, onclick: () => look(side) }, label),
  );
  const { pose } = studio.seeing;
  const segments = HINTS.map(
    ([id, hint]) => /** @type {const} */ ([id, POSES[id], { id: `fabric-${id}`, title: hint }]),
  );
  const poses = segmented("Shape", segments, pose.value, (id) => (pose.value = id));
  pose.listen(poses.show);
  const showHindrances = () => {
    HINTS.forEach(([id, hint], at) => {
      const why = hindrance(studio, id);
      const segment = poses.element.children[at];
      segment.setAttribute("aria-disabled", String(why !== ""));
      segment.setAttribute("title", why || hint);
    });
  };
  studio.document.onChange(({ resized }) => resized && showHindrances());
  studio.largest.watch(showHindrances);
  const { root, setItems } = menu({
    id: "fabric-colours",
    label: "Colours of the yarn",
    content: [icon("yarn"), h("span", { class: "label" }, "Colours"), icon("down")],
    class: "button",
    title: "Colours of the yarn",
  });
  studio.seeing.yarnColours.watch((chosen) =>
    setItems(
      COLOURS.map(([id, content]) => ({
        id: `yarn-${id}`,
        content,
        checked: id === chosen,
        perform: () => (studio.seeing.yarnColours.value = id),
      })),
    ),
  );
  return h(
    "div",
    { class: "fabric-tools line wrap gap-6", role: "toolbar", "aria-label": "The fabric in 3D" },
    h("div", { class: "segmented", role: "group", "aria-label": "Side" }, ...sides),
    poses.element,
    root,
    shareMenu(studio, request),
    fullButton("cloth", "button icon-only"),
  );
}

/** @param {Studio} studio @param {import("./share.js").RequestOfView} request */
function shareMenu(studio, request) {
  const { root, setItems } = menu({
    id: "fabric-share",
    label: "Save the view",
    content: [icon("camera"), h("span", { class: "label" }, "Save"), icon("down")],
    class: "button",
    title: "A picture, page, recording or solid of this fabric",
  });
  const share = () => import("./share.js");
  /** @param {string} id @param {string} content @param {number} side */
  const picture = (id, content, side) => ({
    id: `share-${id}`,
    content,
    perform: () => void share().then(({ savePicture }) => savePicture(studio, side)),
  });
  /** @param {string} id @param {string} content @param {import("./share.js").Kind} kind @param {boolean} moving */
  const file = (id, content, kind, moving) => ({
    id: `share-${id}`,
    content,
    disabled: moving && studio.currentStretch() === null,
    perform: () => void share().then(({ saveFile }) => saveFile(studio, request, kind, moving)),
  });
  const show = () =>
    setItems([
      picture("picture", "Picture (.png)", 1600),
      picture("picture-large", "Large picture (.png)", 3200),
      null,
      file("page", "Rotatable 3D page (.html)", "page", false),
      file("animation", "Rotatable 3D page with the stretch (.html)", "page", true),
      file("recording", "Recording of the stretch (.viser)", "recording", true),
      null,
      file("solid", "Solid with colours (.glb)", "solid", false),
    ]);
  studio.stretch.watch(show);
  return root;
}
