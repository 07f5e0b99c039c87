/** Line icons on a 20 × 20 grid, drawn for this page. */

const PATHS = {
  pencil: "M4 16l1-4 8.5-8.5a1.4 1.4 0 0 1 2 0l1 1a1.4 1.4 0 0 1 0 2L8 15l-4 1zM12 5l3 3",
  line: "M4 16L16 4M4 16h.01M16 4h.01",
  rectangle: "M3.5 5.5h13v9h-13z",
  ellipse: "M10 5c4 0 6.5 2.2 6.5 5S14 15 10 15s-6.5-2.2-6.5-5S6 5 10 5z",
  fill: "M9 3l6.5 6.5-5.2 5.2a1.6 1.6 0 0 1-2.3 0L4 10.7a1.6 1.6 0 0 1 0-2.3L9 3.5M4 9.5h11M17 13c.9 1.4 1.3 2.1 1.3 2.7a1.3 1.3 0 0 1-2.6 0c0-.6.4-1.3 1.3-2.7z",
  stamp: "M8 11.5c0-2-1.5-2.8-1.5-4.7a3.5 3.5 0 0 1 7 0c0 1.9-1.5 2.7-1.5 4.7M4 11.5h12v3H4zM4 17h12",
  select: "M4 7V4h3M13 4h3v3M16 13v3h-3M7 16H4v-3M9 4h2M9 16h2M4 9v2M16 9v2",
  lasso: "M10 4c4 0 6.8 1.9 6.8 4.4S14 12.8 10 12.8 3.2 10.9 3.2 8.4 6 4 10 4zM6.2 12.2a1.7 1.7 0 1 0 1.3 2.8c.6 1 .4 2-.7 2.6",
  wand: "M4 16l8-8M10.6 6.6l2.8 2.8M14.5 2.8v3M13 4.3h3M16.8 9v2M15.8 10h2M8.6 2.8v2M7.6 3.8h2",
  move: "M10 3v14M3 10h14M7.8 5.2L10 3l2.2 2.2M7.8 14.8L10 17l2.2-2.2M5.2 7.8L3 10l2.2 2.2M14.8 7.8L17 10l-2.2 2.2",
  repeat: "M3.5 3.5h5.5v5.5H3.5zM11 3.5h5.5v5.5H11zM3.5 11h5.5v5.5H3.5zM11 11h5.5v5.5H11zM6.2 6.2h.01M13.7 6.2h.01M6.2 13.7h.01M13.7 13.7h.01",
  regions: "M3.5 6.5V4h7v5h6v7.5h-9V13h-4z M10.5 9H7.5v4",
  lock: "M5.5 9.5h9v7h-9zM7.3 9.5V7a2.7 2.7 0 0 1 5.4 0v2.5",
  unlock: "M5.5 9.5h9v7h-9zM7.3 9.5V6.6a2.7 2.7 0 0 1 5.2-1",
  eye: "M2.5 10s2.8-5 7.5-5 7.5 5 7.5 5-2.8 5-7.5 5-7.5-5-7.5-5zM10 7.8a2.2 2.2 0 1 0 0 4.4 2.2 2.2 0 0 0 0-4.4z",
  hidden: "M3.2 3.2l13.6 13.6M8 5.2A8 8 0 0 1 10 5c4.7 0 7.5 5 7.5 5s-.9 1.7-2.6 3.100M12.6 14.500A8.3 8.3 0 0 1 10 15c-4.7 0-7.5-5-7.5-5S3.5 8.1 5.4 6.7",
  up: "M5.5 12l4.5-4.500L14.5 12",
  more: "M4.5 10h.01M10 10h.01M15.5 10h.01",
  link: "M8.5 11.500l3-3M7 9L5 11a2.8 2.8 0 0 0 4 4l2-2M13 11l2-2a2.8 2.8 0 0 0-4-4L9 7",
  unlink: "M7 9L5 11a2.8 2.8 0 0 0 4 4l2-2M13 11l2-2a2.8 2.8 0 0 0-4-4L9 7M4 6l2 .5M6 4l.5 2M16 14l-2-.5M14 16l-.5-2",
  cut: "M5.8 12a2.2 2.2 0 1 0 0 4.4 2.2 2.2 0 0 0 0-4.400zM14.2 12a2.2 2.2 0 1 0 0 4.4 2.2 2.2 0 0 0 0-4.400zM7 12.500L13.5 3M13 12.500L6.5 3",
  paste: "M7 5H5v12h10V5h-2M7 3.500h6v3H7z",
  rotate: "M15.5 7A6.5 6.5 0 1 0 16.5 11M16 3.500V7h-3.5",
  "insert-row": "M3.5 12h13v4h-13zM10 3v6M7 6h6",
  "delete-row": "M3.5 12h13v4h-13zM7 6h6",
  "insert-column": "M12 3.500h4v13h-4zM3 10h6M6 7v6",
  "delete-column": "M12 3.500h4v13h-4zM3 10h6",
  hand: "M7 10V4.8a1.2 1.2 0 0 1 2.4 0V9M9.4 9V3.7a1.2 1.2 0 0 1 2.4 0V9M11.8 9V4.9a1.2 1.2 0 0 1 2.4 0V12c0 3-1.7 5-4.5 5-2.2 0-3.3-.9-4.3-2.8L3.7 11a1.2 1.2 0 0 1 2-1.2L7 11.5",
  undo: "M7 5L3.5 8.5 7 12M4 8.5h7.5a4 4 0 0 1 0 8H9",
  redo: "M13 5l3.5 3.5L13 12M16 8.5H8.5a4 4 0 0 0 0 8H11",
  mirror: "M10 3v14M7 6l-4 8h4zM13 6l4 8h-4z",
  flip: "M3 10h14M6 7l8-4v4zM6 13l8 4v-4z",
  swap: "M4 7h11l-3-3M16 13H5l3 3",
  turn: "M10 4v12M6 6.5C4 7.3 3 8.6 3 10c0 2.4 3 4.2 7 4.2M14 6.5c2 .8 3 2.1 3 3.5 0 1.8-1.7 3.3-4.3 3.9M12.5 11.5l-2.3 2.7 2.6 2.3",
  theme: "M10 3.5a6.5 6.5 0 1 0 0 13zM10 3.5a6.5 6.5 0 0 1 0 13",
  help: "M7.5 7.5a2.5 2.5 0 1 1 3.5 2.3c-.7.3-1 .8-1 1.7M10 14.5h.01M10 2.8a7.2 7.2 0 1 0 0 14.4 7.2 7.2 0 0 0 0-14.4z",
  play: "M6.5 4.5l9 5.5-9 5.5z",
  pause: "M7 5v10M13 5v10",
  course: "M3 10h14M6 7l-3 3 3 3M14 7l3 3-3 3",
  wale: "M10 3v14M7 6l3-3 3 3M7 14l3 3 3-3",
  export: "M10 12.5V3.5M6.5 7L10 3.5 13.5 7M4 12v4h12v-4",
  import: "M10 3.5v9M6.5 9L10 12.5 13.5 9M4 12v4h12v-4",
  resize: "M4 4h6M4 4v6M4 4l12 12M16 16h-6M16 16v-6",
  fit: "M4 8V4h4M12 4h4v4M16 12v4h-4M8 16H4v-4",
  plus: "M10 4v12M4 10h12",
  minus: "M4 10h12",
  close: "M5 5l10 10M15 5L5 15",
  down: "M5.5 8l4.5 4.5L14.5 8",
  warning: "M10 3.5l7.5 13h-15zM10 8.5v3.5M10 14.3h.01",
  info: "M10 9v5M10 6.3h.01M10 2.8a7.2 7.2 0 1 0 0 14.4 7.2 7.2 0 0 0 0-14.4z",
  check: "M4 10.5l4 4L16 6",
  rows: "M3.5 6.5h13M3.5 10h13M3.5 13.5h13",
  copy: "M7 7h9v9H7zM13 7V4H4v9h3",
  symbols: "M4 6l3 6 3-6M13 11h3.5M13 8h3.5",
  stop: "M6 6h8v8H6z",
  trash: "M4 6h12M8 6V4h4v2M5.5 6l.7 10h7.6l.7-10",
  gallery: "M3.5 3.5h5v5h-5zM11.5 3.5h5v5h-5zM3.5 11.5h5v5h-5zM11.5 11.5h5v5h-5z",
  folder: "M3 6V5a1 1 0 0 1 1-1h4l1.5 2H16a1 1 0 0 1 1 1v8a1 1 0 0 1-1 1H4a1 1 0 0 1-1-1z",
  share: "M7.3 8.9l5.4-3M7.3 11.1l5.4 3M5.5 12a2 2 0 1 0 0-4 2 2 0 0 0 0 4zM14.5 7a2 2 0 1 0 0-4 2 2 0 0 0 0 4zM14.5 17a2 2 0 1 0 0-4 2 2 0 0 0 0 4z",
  pin: "M5.5 3.5h9v13L10 13l-4.5 3.5z",
  saving: "M10 3.5a6.5 6.5 0 1 1-6.2 4.5M3.5 4v4h4",
  offline: "M3 3l14 14M5.8 8.3A3.5 3.5 0 0 0 6 15.3h8M8 5.9a4.5 4.5 0 0 1 6.4 3.3 3 3 0 0 1 2 4.8",
  tour: "M10 2.8a7.2 7.2 0 1 0 0 14.4 7.2 7.2 0 0 0 0-14.4zM12.8 7.2l-1.7 3.9-3.9 1.7 1.7-3.9z",
};

/** @typedef {keyof typeof PATHS} IconName */

/**
 * @param {IconName} name
 * @returns {SVGSVGElement}
 */
export function icon(name) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("class", "icon");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", PATHS[name]);
  svg.append(path);
  return svg;
}
