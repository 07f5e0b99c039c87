/** What went wrong, why, and what to do. */

import { ApiError } from "../api.js";
import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";

/**
 * @param {{title: string, detail?: string, remedy?: string | null}} problem
 * @param {...import("../elements/dom.js").Child} more
 */
export function problemText({ title, detail, remedy }, ...more) {
  return h(
    "div",
    {},
    h("strong", {}, title),
    detail && detail !== title && h("p", {}, detail),
    remedy && h("p", {}, remedy),
    ...more,
  );
}

/**
 * What went wrong, and what to do, for the body of a dialog.
 *
 * @param {Pick<import("../types.js").Problem, "title" | "detail" | "remedy">} problem
 * @param {() => void} [again] tries once more
 */
export function problemBox(problem, again) {
  return h(
    "div",
    { class: "problem", role: "alert" },
    icon("warning"),
    problemText(problem, again && h("button", { class: "button", onclick: again }, "Try again")),
  );
}

/**
 * Ask the service for something on behalf of a dialog, and show there what goes wrong.
 *
 * @template T
 * @param {HTMLElement} status where a problem is shown; emptied first
 * @param {() => Promise<T>} work
 * @param {() => unknown} [again] what "Try again" does, where more than the work depends on it
 * @returns {Promise<T | null>} null if it failed
 */
export async function attempt(status, work, again = () => void attempt(status, work)) {
  status.replaceChildren();
  try {
    return await work();
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    status.replaceChildren(problemBox(error.problem, () => void again()));
    status.scrollIntoView({ block: "nearest" }); // it may lie below a long form
    return null;
  }
}
