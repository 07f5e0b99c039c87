/** How long ago something happened, in words. */

const STEPS = /** @type {const} */ ([
  [60, "second"],
  [3600, "minute"],
  [86_400, "hour"],
  [7 * 86_400, "day"],
]);
const relative = new Intl.RelativeTimeFormat("en", { numeric: "auto", style: "short" });
const date = new Intl.DateTimeFormat("en", { day: "numeric", month: "short", year: "numeric" });

/** @param {string} moment ISO 8601 */
export function ago(moment) {
  const seconds = Math.max(0, (Date.now() - Date.parse(moment)) / 1000);
  if (seconds < 45) return "just now";
  let unit = 1;
  for (const [limit, name] of STEPS) {
    if (seconds < limit) return relative.format(-Math.round(seconds / unit), name);
    unit = limit === 7 * 86_400 ? 86_400 : limit;
  }
  return date.format(Date.parse(moment));
}
