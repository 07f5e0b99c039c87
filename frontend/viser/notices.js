/**
 * Runs before viser's client, in the frame of the 3D view and in pages that were exported, and leaves out notices that
 * users cannot act on: its sorter of point clouds, unused here, builds functions from text, which our policy forbids;
 * and three.js renames a class. A plain script without imports.
 */

(() => {
  for (const name of ["error", "unhandledrejection"]) {
    addEventListener(name, (event) => {
      const { message, reason } = /** @type {ErrorEvent & PromiseRejectionEvent} */ (event);
      if (/unsafe-eval/.test(message ?? reason?.message)) event.preventDefault();
    });
  }
  /* eslint-disable no-console -- it is viser's console that is kept clean */
  const warn = console.warn;
  console.warn = (...words) => String(words[0]).startsWith("THREE.Clock") || warn(...words);
  /* eslint-enable no-console */
})();
