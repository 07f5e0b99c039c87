/**
 * For work that need not keep up with the pointer: done at most once per interval, and once more after the
 * last call. So it stays out of the frame that shows a stroke.
 *
 * @param {() => void} act
 * @param {number} milliseconds
 * @returns {() => void} call it whenever the work is due
 */
export function paced(act, milliseconds) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  return () => {
    timer ??= setTimeout(() => {
      timer = undefined;
      act();
    }, milliseconds);
  };
}
