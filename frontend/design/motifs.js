/**
 * Small pieces of lace, cables, slips and tucks in which every row takes as many stitches as it leaves: stamped on a
 * chart they leave it so.
 *
 * @typedef {{name: string, codes: string, group: string, note: string}} Motif `codes` with the top row first
 */

/** A rope between purls, crossed every so many rows as it is wide. @param {number} half @param {"R" | "L"} side @returns {Motif} */
function rope(half, side) {
  const plain = `P${"K".repeat(2 * half)}P;`;
  return {
    name: `Rope ${half}/${half} ${side === "R" ? "right" : "left"}`,
    codes: `${plain.repeat(Math.max(1, 2 * half - 1))}P[${half}/${half}${side}]P`,
    group: "cables",
    note: `Crosses every ${Math.max(2, 2 * half)} rows, a purl on either side`,
  };
}

/** @type {readonly Motif[]} */
export const MOTIFS = [
  { name: "Eyelet right", codes: "/O", group: "lace", note: "Yarn over and knit 2 together" },
  { name: "Eyelet left", codes: "O\\", group: "lace", note: "Slip, slip, knit and yarn over" },
  { name: "Double eyelet", codes: "/OO\\", group: "lace", note: "Two holes side by side between two decreases" },
  { name: "Eyelet pair", codes: "O^O", group: "lace", note: "A hole on each side of a centred decrease" },
  { name: "Eyelet mesh", codes: "KK;O\\;KK;/O", group: "lace", note: "Holes in every second row, to and fro" },
  { name: "Chevron", codes: "KKKKKKK;OKK^KKO", group: "lace", note: "Holes that run down to the middle" },
  {
    name: "Feather and fan",
    codes: "PPPPPPPPPPPPPPPPPP;///OKOKOKOKOKOK///;KKKKKKKKKKKKKKKKKK;KKKKKKKKKKKKKKKKKK",
    group: "lace",
    note: "Old shale: waves of 18 stitches and 4 rows",
  },
  ...[1, 2, 3].flatMap((half) => [rope(half, "R"), rope(half, "L")]),
  { name: "Honeycomb", codes: "KKKK;[1/1L][1/1R];KKKK;[1/1R][1/1L]", group: "cables", note: "Cells between crossings" },
  { name: "Mosaic", codes: "KVKV;KVKV;VKVK;VKVK", group: "slips", note: "Slipped over two rows, moved by a stitch" },
  { name: "Linen", codes: "Kv;vK", group: "slips", note: "Firm: every second stitch slipped, its yarn on the face" },
  { name: "Half fisherman", codes: "TP;KP", group: "tucks", note: "Rib whose knits are tucked in every second row" },
  { name: "Fisherman", codes: "Kt;TP", group: "tucks", note: "Rib whose knits and purls are tucked in turn" },
  { name: "Tuck waffle", codes: "KKKK;KTKT;KKKK;TKTK", group: "tucks", note: "Dimples, moved by a stitch" },
  { name: "Twisted rib", codes: "BP", group: "twisted", note: "Knits through the back loop between purls" },
];
