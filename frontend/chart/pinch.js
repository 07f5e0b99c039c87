/**
 * Two fingers on the chart zoom and move it; what one finger had begun to paint is taken back.
 *
 * @param {import("./view.js").ChartView} view
 * @param {() => void} giveUp what a single finger began
 */
export function listenToPinches(view, giveUp) {
  /** @type {Map<number, {x: number, y: number}>} */
  const fingers = new Map();
  let pinching = false;
  const measure = () => {
    const [a, b] = [...fingers.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) };
  };
  /** @param {"pointerdown" | "pointermove" | "pointerup" | "pointercancel"} name @param {(event: PointerEvent) => void} follow */
  const listen = (name, follow) =>
    view.canvas.addEventListener(
      name,
      (event) => {
        if (event.pointerType !== "touch") return;
        follow(event);
        if (pinching) event.stopImmediatePropagation();
      },
      { capture: true },
    );
  listen("pointerdown", ({ pointerId, offsetX, offsetY }) => {
    fingers.set(pointerId, { x: offsetX, y: offsetY });
    if (fingers.size === 2) {
      pinching = true;
      giveUp();
    }
  });
  listen("pointermove", ({ pointerId, offsetX, offsetY }) => {
    if (!fingers.has(pointerId)) return;
    const before = fingers.size === 2 ? measure() : null;
    fingers.set(pointerId, { x: offsetX, y: offsetY });
    if (!before || !pinching) return;
    const after = measure();
    view.pan(after.x - before.x, after.y - before.y);
    view.zoom(after.apart / Math.max(1, before.apart), after.x, after.y);
  });
  /** @param {PointerEvent} event */
  const lift = ({ pointerId }) => {
    fingers.delete(pointerId);
    // The last finger of a pinch paints nothing, but its lifting ends the gesture.
    if (!fingers.size) queueMicrotask(() => (pinching = false));
  };
  listen("pointerup", lift);
  listen("pointercancel", lift);
}
