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
  let before = 1;
  /** The point of the chart between the fingers when they came down, in stitches; it stays there. */
  let [column, row] = [0, 0];
  const measure = () => {
    const [a, b] = [...fingers.values()];
    return { mx: (a.x + b.x) / 2, my: (a.y + b.y) / 2, apart: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)) };
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
      const { mx, my, apart } = measure();
      const { x, y, cellWidth, cellHeight } = view.viewport;
      before = apart;
      [column, row] = [(mx - x) / cellWidth, (my - y) / cellHeight];
    }
  });
  listen("pointermove", ({ pointerId, offsetX, offsetY }) => {
    if (!fingers.has(pointerId)) return;
    fingers.set(pointerId, { x: offsetX, y: offsetY });
    if (!pinching || fingers.size !== 2) return;
    const { mx, my, apart } = measure();
    view.zoom(apart / before, mx, my);
    before = apart;
    const { x, y, cellWidth, cellHeight, fitted } = view.viewport;
    if (!fitted) view.pan(mx - column * cellWidth - x, my - row * cellHeight - y);
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
