/** All tools, in the order of the toolbar; shortcuts, palette and help read this list too. */

import { ellipse } from "./ellipse.js";
import { fill } from "./fill.js";
import { line } from "./line.js";
import { pan } from "./pan.js";
import { pencil } from "./pencil.js";
import { rectangle } from "./rectangle.js";
import { select } from "./select.js";
import { stamp } from "./stamp.js";

/** @type {import("./tool.js").Tool[]} */
export const TOOLS = [pencil, line, rectangle, ellipse, fill, stamp, select, pan];
