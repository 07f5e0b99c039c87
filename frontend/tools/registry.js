/** All tools, in the order of the toolbar; shortcuts, palette and help read this list too. */

import { ellipse } from "./ellipse.js";
import { fill } from "./fill.js";
import { lasso } from "./lasso.js";
import { line } from "./line.js";
import { move } from "./move.js";
import { pan } from "./pan.js";
import { pencil } from "./pencil.js";
import { rectangle } from "./rectangle.js";
import { repeat } from "./repeat.js";
import { select } from "./select.js";
import { stamp } from "./stamp.js";
import { wand } from "./wand.js";

/** @type {import("./tool.js").Tool[]} */
export const TOOLS = [pencil, line, rectangle, ellipse, fill, stamp, repeat, select, lasso, wand, move, pan];
