/**
 * What this browser keeps of designs that are not at the service yet: one entry for each, so that
 * neither another window nor opening another design can overwrite it.
 *
 * @import {Parcel} from "./delivery.js"
 */

const PREFIX = "knitcore.unsent.";

export const drafts = {
  /** @param {Parcel} parcel @returns {boolean} whether it is kept */
  put(parcel) {
    try {
      localStorage.setItem(PREFIX + parcel.id, JSON.stringify(parcel));
      return true;
    } catch {
      return false;
    }
  },

  /** @param {string} id */
  drop(id) {
    try {
      localStorage.removeItem(PREFIX + id);
    } catch {
      // Storage is closed to us, so nothing was put there.
    }
  },

  /** @param {string} id @returns {Parcel | null} */
  get(id) {
    try {
      const parcel = JSON.parse(localStorage.getItem(PREFIX + id) ?? "null");
      return typeof parcel?.document?.chart === "string" ? parcel : null;
    } catch {
      return null;
    }
  },

  /** @returns {Parcel[]} */
  all() {
    try {
      return Object.keys(localStorage)
        .filter((key) => key.startsWith(PREFIX))
        .map((key) => drafts.get(key.slice(PREFIX.length)))
        .filter((parcel) => parcel !== null);
    } catch {
      return [];
    }
  },
};
