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
  };
  studio.online.listen((online) => {
    clearInterval(timer);
    // Whoever heard from the service first: all of the page has to catch up.
    if (online) back();
    else timer = setInterval(look, RETRY_MS);
  });
  window.addEventListener("offline", () => (studio.online.value = false));
  window.addEventListener("online", () => void look());
}
