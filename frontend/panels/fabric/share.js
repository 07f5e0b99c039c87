/**
 * Files of the 3D view, made by the service.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {ViewRequest} from "../../types.js"
 *
 * @typedef {() => ViewRequest} RequestOfView what the view shows
 * @typedef {"page" | "recording" | "solid"} Kind
 */

import { ApiError, fetched } from "../../api.js";
import { isDark } from "../../state/palette.js";
import { download, fileName } from "../../services/exporter.js";

/** @type {Record<Kind, string>} */
const ENDINGS = { page: "html", recording: "viser", solid: "glb" };

/** @param {Studio} studio @param {number} width of the picture in pixels; its proportions are the view's */
export async function savePicture(studio, width) {
  if (isOutdated()) {
    return studio.tellProblem({
      type: "view",
      status: 0,
      title: "The cloth is being made anew",
      detail: "The view still shows it as it was before the change.",
      remedy: "Save the picture when the new cloth is there.",
    });
  }
  await save(studio, "png", () => viewPicture(studio, width));
}

const isOutdated = () => document.querySelector(".fabric-caption[data-stale]") !== null;

/** Whether the view shows the cloth as it is now, of which a picture can be made. */
export const isKnitted = () => document.querySelector(".fabric[data-live]") !== null && !isOutdated();

/** A picture (PNG) as this browser sees the fabric. @param {Studio} studio @param {number} width */
export async function viewPicture(studio, width) {
  const frame = document.querySelector(".fabric-frame");
  const height = Math.round((width * (frame?.clientHeight ?? 3)) / (frame?.clientWidth ?? 4));
  const query = `width=${width}&height=${Math.min(4096, height)}`;
  return (await fetched(`/views/${encodeURIComponent(studio.designId)}/picture?${query}`)).blob();
}

/**
 * @param {Studio} studio
 * @param {RequestOfView} request
 * @param {Kind} kind
 * @param {boolean} animated
 */
export async function saveFile(studio, request, kind, animated) {
  const body = { ...request(), animated, dark: isDark() };
  await save(studio, ENDINGS[kind], async () => (await fetched(`/views/${kind}`, { method: "POST", body })).blob());
}

/** @param {Studio} studio @param {string} ending @param {() => Promise<Blob>} made */
async function save(studio, ending, made) {
  const name = `${fileName(studio)}.${ending}`;
  studio.tell("The file is being made …");
  try {
    download(name, await made());
    studio.tell(`${name} is saved.`);
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    if (error.offline) studio.online.value = false;
    studio.tellProblem({ ...error.problem, title: "This file cannot be made" });
  }
}
