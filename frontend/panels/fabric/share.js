/**
 * Files of the 3D view, made by the service.
 *
 * @import {Studio} from "../../studio.js"
 * @import {ViewRequest} from "../../types.js"
 *
 * @typedef {() => ViewRequest} Wish what the view shows
 * @typedef {"page" | "recording" | "solid"} Kind
 */

import { ApiError, fetched } from "../../api.js";
import { download, fileName } from "../../services/exporter.js";
import { isDark } from "./theme.js";

/** @type {Record<Kind, string>} */
const ENDINGS = { page: "html", recording: "viser", solid: "glb" };

/**
 * A picture as this browser sees the fabric.
 *
 * @param {Studio} studio
 * @param {number} width of the picture in pixels; its proportions are the view's
 */
export async function savePicture(studio, width) {
  const frame = document.querySelector(".fabric-frame");
  const height = Math.round((width * (frame?.clientHeight ?? 3)) / (frame?.clientWidth ?? 4));
  const query = `width=${width}&height=${Math.min(4096, height)}`;
  await save(studio, "png", `/views/${encodeURIComponent(studio.designId)}/picture?${query}`);
}

/**
 * @param {Studio} studio
 * @param {Wish} wish
 * @param {Kind} kind
 * @param {boolean} animated
 */
export async function saveFile(studio, wish, kind, animated) {
  const body = { ...wish(), animated, dark: isDark() };
  await save(studio, ENDINGS[kind], `/views/${kind}`, { method: "POST", body });
}

/**
 * @param {Studio} studio
 * @param {string} ending
 * @param {string} path
 * @param {{method?: string, body?: unknown}} [options]
 */
async function save(studio, ending, path, options) {
  studio.tell("The file is being made …");
  try {
    const response = await fetched(path, options);
    download(`${fileName(studio)}.${ending}`, await response.blob());
    studio.tell(`${fileName(studio)}.${ending} is saved.`);
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    if (error.offline) studio.online.value = false;
    studio.tellProblem({ ...error.problem, title: "This file cannot be made" });
  }
}
