/**
 * Charts from outside: pasted or dropped text, project files, pictures. The service reads the text, so
 * that the page and the command line accept the same; what cannot be read changes nothing.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Problem} from "../../types.js"
 */

import { action } from "../../actions/registry.js";
import { ApiError, refusal } from "../../api.js";
import { DesignError, readDesign } from "../../design/design.js";

const MAX_FILE_BYTES = 12_000_000;
/** Files of stretch tests, from which yarns are made. */
const TABLE = /\.(csv|tsv|xlsx?|h5|hdf5)$/i;

/**
 * @param {ActionContext} context
 * @param {string} text a drawn chart, a project file, written rows, KnitSpeak or knitout
 * @param {string} [name] of the file
 * @returns {Promise<Problem | null>} what is wrong, or null if the chart is now this one
 */
export async function importText(context, text, name = "Pasted.txt") {
  if (/^\s*[{[]/.test(text)) {
    const yarn = await importYarn(context, text);
    return yarn === undefined ? importProject(context, text) : yarn;
  }
  const { importRead } = await import("./knitreader.js");
  return importRead(context, name, text);
}

/**
 * A yarn file is kept, and the design knitted with it.
 *
 * @param {ActionContext} context
 * @param {string} text
 * @returns {Promise<Problem | null | undefined>} undefined if it is not a yarn file
 */
async function importYarn({ studio }, text) {
  if (!text.includes("knitcore-material")) return undefined;
  const { adopt, isYarnFile } = await import("../../services/yarns.js");
  try {
    const document = JSON.parse(text);
    if (!isYarnFile(document)) return undefined;
    await adopt(studio, document);
    return null;
  } catch (error) {
    if (error instanceof SyntaxError) return undefined; // reported as a damaged project file
    if (!(error instanceof ApiError)) throw error;
    return { ...error.problem, title: "This yarn cannot be added" };
  }
}

/**
 * A project file is a design of its own: the one on show stays among the designs.
 *
 * @param {ActionContext} context
 * @param {string} text
 * @returns {Problem | null}
 */
function importProject({ studio, keeper }, text) {
  try {
    const design = readDesign(JSON.parse(text));
    keeper.openNew(design);
    studio.tell(`Opened ${design.name}. The design before it is still among your designs.`);
    return null;
  } catch (error) {
    if (error instanceof SyntaxError) {
      return refusal("The project file is damaged or not complete.", "Export the design again, or use an older copy.");
    }
    if (error instanceof DesignError) return refusal(error.message, error.remedy);
    throw error;
  }
}

/** @param {ActionContext} context @param {File} file @returns {Promise<Problem | null>} */
export async function importFile(context, file) {
  if (file.size > MAX_FILE_BYTES) {
    return refusal(`${file.name} has ${(file.size / 1e6).toFixed(0)} MB.`, "Files have at most 12 MB.");
  }
  if (TABLE.test(file.name)) {
    context.studio.droppedTest = file;
    context.open("yarns");
    return null;
  }
  if (!file.size) return refusal(`${file.name} is empty.`, "Choose a text, a PNG or a project file.");
  if (file.type === "image/png") {
    const bytes = new Uint8Array(await file.arrayBuffer());
    if (new TextDecoder("latin1").decode(bytes.subarray(0, 4096)).includes("knitcore-yarns")) {
      return (await import("./knitreader.js")).importRead(context, file.name, bytes);
    }
  }
  if (file.type.startsWith("image/")) {
    const { importPicture } = await import("./picture.js");
    return importPicture(context, file);
  }
  const text = await file.text();
  if (text.includes("\0")) {
    return refusal(`${file.name} is not a text file.`, "Use lines of K and P, a PNG, or a project file (.json).");
  }
  return importText(context, text, file.name);
}

/**
 * Take what is dropped on the page or pasted into it.
 *
 * @param {ActionContext} context
 * @param {() => boolean} isTyping
 */
export function listenToImports(context, isTyping) {
  const { studio } = context;
  /** @param {Promise<Problem | null>} outcome */
  const report = async (outcome) => {
    const problem = await outcome;
    if (problem) studio.tellProblem(problem);
  };
  window.addEventListener("paste", (event) => {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    const picture = [...(event.clipboardData?.files ?? [])].find(({ type }) => type.startsWith("image/"));
    if (isTyping() || document.querySelector("dialog[open]")) return;
    const { clip } = studio.editing;
    // Where a page may not write the clipboard, the clipboard is older than what was copied here.
    const own = clip && (!navigator.clipboard || text === clip.text || (!text.trim() && !picture));
    if (!own && !picture && !text.trim()) return;
    event.preventDefault();
    if (own) action("paste").perform(context);
    else if (picture) void report(importFile(context, picture));
    else void report(importText(context, text));
  });
  const root = document.documentElement;
  window.addEventListener("dragover", (event) => {
    event.preventDefault();
    root.dataset.dropping = "";
  });
  window.addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) delete root.dataset.dropping;
  });
  window.addEventListener("drop", (event) => {
    delete root.dataset.dropping;
    if (event.target instanceof HTMLInputElement && event.target.type === "file") return; // takes it itself
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    const text = event.dataTransfer?.getData("text/plain");
    if (file) void report(importFile(context, file));
    else if (text) void report(importText(context, text));
  });
}
