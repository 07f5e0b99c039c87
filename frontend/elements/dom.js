/** Building elements. */

/**
 * @typedef {Node | string | number | null | undefined | false} Child
 */

/**
 * An element with properties (`class`, `onclick`, `aria-…`, `data-…`, any other property) and children.
 *
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, unknown>} [properties]
 * @param {...Child} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function h(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  if (element instanceof HTMLButtonElement) element.type = "button"; // submits nothing unless asked to
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === "class") element.className = String(value);
    else if (name.includes("-") || name === "role" || name === "for" || name === "list") {
      element.setAttribute(name, String(value));
    } else Reflect.set(element, name, value);
  }
  element.append(...children.filter(isShown).map(asNode));
  return element;
}

/** A quiet paragraph. @param {...Child} content */
export const remark = (...content) => h("p", { class: "muted" }, ...content);

/**
 * An element of a drawing.
 *
 * @template {keyof SVGElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, string | number>} attributes
 * @param {...(Node | string)} children
 */
export function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/**
 * A drawing, and what adds an element to it.
 *
 * @param {Record<string, string | number>} attributes
 */
export function drawing(attributes) {
  const plot = svg("svg", attributes);
  /** @type {typeof svg} */
  const add = (...mark) => {
    const element = svg(...mark);
    plot.append(element);
    return element;
  };
  return { plot, add };
}

/** @param {Child} child @returns {child is Node | string | number} */
function isShown(child) {
  return child !== null && child !== undefined && child !== false;
}

/** @param {Node | string | number} child */
function asNode(child) {
  return typeof child === "number" ? String(child) : child;
}

/**
 * The element with this id, which the page has.
 *
 * @template {HTMLElement} [T=HTMLElement]
 * @param {string} id
 * @returns {T}
 */
export function byId(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error(`The page has no element #${id}.`);
  return /** @type {T} */ (element);
}

/** Whether keys are for a text field and not for the page. */
export function isTyping() {
  const active = document.activeElement;
  // The field of a dialog that was just closed keeps the focus until the next frame.
  if (active?.closest("dialog:not([open])")) return false;
  return (
    active instanceof HTMLTextAreaElement ||
    active instanceof HTMLSelectElement ||
    (active instanceof HTMLInputElement && !["range", "checkbox", "radio"].includes(active.type))
  );
}

/** Until the page has been seen once; a page in the background waits no longer than a moment. */
export function firstPaint() {
  return new Promise((resolve) => {
    const soon = () => setTimeout(resolve);
    requestAnimationFrame(() => requestAnimationFrame(soon));
    setTimeout(soon, 500);
  });
}

/** Until what waits has had its turn: input, and painting if it is due. */
export function nextTask() {
  return new Promise((resolve) => setTimeout(resolve));
}

/** Act on each, in a task of its own. @template T @param {Iterable<T>} all @param {(each: T) => void} act */
export async function inTurn(all, act) {
  for (const each of all) {
    await nextTask();
    act(each);
  }
}

/** Until the page has nothing to do, or for two seconds. */
export function idle() {
  return new Promise((resolve) => {
    if ("requestIdleCallback" in window) requestIdleCallback(resolve, { timeout: 2000 });
    else setTimeout(resolve, 500);
  });
}
