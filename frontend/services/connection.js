/**
 * Notices when the service is back and has everything asked anew.
 *
 * @import {Studio} from "../studio.js"
 */

const RETRY_MS = 3000;

/**
 * @param {Studio} studio
 * @param {() => void} back called when the service answers again
 */
export function watchConnection(studio, back) {
  /** @type {ReturnType<typeof setInterval> | undefined} */
  let timer;
  const look = async () => {
    try {
      const response = await fetch("/healthz", { cache: "no-store" });
      if (!response.ok) return;
    } catch {
      return; // still away: the next look comes
    }
    studio.online.value = true;
    back();
  };
  studio.online.watch((online) => {
    clearInterval(timer);
    if (!online) timer = setInterval(look, RETRY_MS);
  });
  window.addEventListener("offline", () => (studio.online.value = false));
  window.addEventListener("online", () => void look());
}
