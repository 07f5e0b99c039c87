/** From a target to a fabric: the atlas, the search, and filling. */

import { actionsOf } from "./action.js";

const action = actionsOf("From a target to a fabric");

export const INVERSE = [
  action("open-atlas", "Atlas of all repeats", ["A"], { icon: "scatter" }, ({ open }) => open("atlas")),
  action("open-find", "Find a fabric by its numbers", ["Shift+F"], { icon: "search" }, ({ open }) => open("find")),
  action("open-fill", "Fill the chart from a target", ["Shift+W"], { icon: "target" }, ({ open }) => open("fill")),
];
