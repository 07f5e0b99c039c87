/** How long ago something happened, in words. */

const STEPS = /** @type {const} */ ([
  [60, "second"],
  [3600, "minute"],
  [86_400, "hour"],
  [7 * 86_400, "day"],
]);

/** @type {{relative: Intl.RelativeTimeFormat, date: Intl.DateTimeFormat} | undefined} */
let formats;

/** Made when something is to be said: that takes 20 ms at the first time. */
const made = () => ({
  relative: new Intl.RelativeTimeFormat("en", { numeric: "auto", style: "short" }),
  date: new Intl.DateTimeFormat("en", { day: "numeric", month: "short", year: "numeric" }),
});

/** @param {string} moment ISO 8601 */
export function ago(moment) {
  const seconds = Math.max(0, (Date.now() - Date.parse(moment)) / 1000);
  if (seconds < 45) return "just now";
  const { relative, date } = (formats ??= made());
  let unit = 1;
  for (const [limit, name] of STEPS) {
    if (seconds < limit) return relative.format(-Math.round(seconds / unit), name);
    unit = limit === 7 * 86_400 ? 86_400 : limit;
  }
  return date.format(Date.parse(moment));
}
