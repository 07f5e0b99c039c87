/** Ask the service for something on behalf of a dialog, and show there what goes wrong. */

import { ApiError } from "../api.js";
import { problemBox } from "./dialog.js";

/**
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
    return null;
  }
}
