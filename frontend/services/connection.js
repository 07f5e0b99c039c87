/**
 * Notices when the service is back, and has everything requested again.
 *
 * @import {Studio} from "../state/studio.js"
 */

const RETRY_MS = 3000;

/** @param {Studio} studio @param {() => void} back called when the service answers again */
export function watchConnection(studio, back) {
  /** @type {ReturnType<typeof setInterval> | undefined} */
  let timer;
  const look = async () => {
    try {
      const response = await fetch("/healthz", { cache: "no-store" });
      if (!response.ok) return;
    } catch {
      return; // still unreachable: it is asked again later
    }
    studio.online.value = true;
  };
  studio.online.listen((online) => {
    clearInterval(timer);
    // Any part of the page may hear from the service first; then all of it catches up.
    if (online) back();
    else timer = setInterval(look, RETRY_MS);
  });
  window.addEventListener("offline", () => (studio.online.value = false));
  window.addEventListener("online", () => void look());
}
