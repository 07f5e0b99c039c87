/**
 * Who is signed in with this browser.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {SignedIn} from "../types.js"
 */

import { ApiError, api } from "../api.js";

/** The service's name for whoever uses the one token of its settings, or needs none. */
const NAMELESS = "local";

/** @param {SignedIn} signedIn */
export const nameOf = ({ user }) => (user === NAMELESS ? "Signed in" : user);

/** Show the user's name, if this browser has a session. @param {Studio} studio */
export async function showUser(studio) {
  try {
    const signedIn = await api.session();
    if (signedIn.sessions.some(({ is_this }) => is_this)) studio.user.value = nameOf(signedIn);
  } catch (error) {
    if (!(error instanceof ApiError)) throw error; // the name is shown at the next visit
  }
}
