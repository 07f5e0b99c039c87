// A grid of stitches: one tab stop, arrows move, Space turns, K and P set; dragging paints.
// The chart is the model's "text": lines of K and P, the top row first.

const OTHER = { K: "P", P: "K" };
const NAMES = { K: "knit", P: "purl" };
const STEPS = {
  ArrowUp: [-1, 0],
  ArrowDown: [1, 0],
  ArrowLeft: [0, -1],
  ArrowRight: [0, 1],
};

function render({ model, el }) {
  let grid = read();
  let here = [grid.length - 1, 0];
  let brush = null;
  const past = [];

  const root = document.createElement("div");
  root.className = "knit-editor";
  const bar = document.createElement("div");
  bar.className = "knit-bar";
  const table = document.createElement("div");
  table.setAttribute("role", "grid");
  table.className = "knit-grid";
  const status = document.createElement("div");
  status.setAttribute("role", "status");
  status.className = "knit-status";

  const sizes = { columns: number("Columns"), rows: number("Rows") };
  bar.append(
    button("Undo", undo),
    button("Swap knits and purls", () =>
      change(() => grid.map((row) => row.map((one) => OTHER[one]))),
    ),
    button("Mirror", () => change(() => grid.map((row) => row.toReversed()))),
  );
  root.append(bar, table, status);
  el.append(root);

  function read() {
    return model.get("text").split("\n").map((line) => [...line]);
  }

  function button(name, act) {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = name;
    made.addEventListener("click", act);
    return made;
  }

  function number(name) {
    const label = document.createElement("label");
    const input = document.createElement("input");
    Object.assign(input, { type: "number", min: 1 });
    label.append(name, " ", input);
    input.addEventListener("change", resize);
    bar.append(label);
    return input;
  }

  // The chart goes on from its lower left, as `StitchChart.resized` does.
  function resize() {
    const rows = Math.trunc(Number(sizes.rows.value));
    const columns = Math.trunc(Number(sizes.columns.value));
    if (rows < 1 || columns < 1 || rows * columns > model.get("most_stitches")) {
      status.textContent = `Give 1 to ${model.get("most_stitches")} stitches.`;
      showSize();
      return;
    }
    change(() => {
      const up = grid.toReversed();
      const made = Array.from({ length: rows }, (_, r) =>
        Array.from({ length: columns }, (_, c) => up[r % up.length][c % up[0].length]),
      );
      return made.toReversed();
    });
  }

  function change(make) {
    past.push(grid);
    grid = make();
    send();
    draw();
  }

  function undo() {
    if (past.length === 0) return;
    grid = past.pop();
    send();
    draw();
  }

  function send() {
    model.set("text", grid.map((row) => row.join("")).join("\n"));
    model.save_changes();
  }

  function showSize() {
    sizes.columns.value = grid[0].length;
    sizes.rows.value = grid.length;
  }

  function draw() {
    here = [Math.min(here[0], grid.length - 1), Math.min(here[1], grid[0].length - 1)];
    const knits = grid.flat().filter((one) => one === "K").length;
    table.setAttribute("aria-label", `Chart, ${grid[0].length} columns and ${grid.length} rows`);
    table.replaceChildren(
      ...grid.map((row, r) => {
        const line = document.createElement("div");
        line.setAttribute("role", "row");
        line.append(...row.map((_, c) => cellAt(r, c)));
        return line;
      }),
    );
    showSize();
    status.textContent = `${knits} knits, ${grid.flat().length - knits} purls`;
  }

  function cellAt(r, c) {
    const cell = document.createElement("div");
    cell.setAttribute("role", "gridcell");
    cell.dataset.row = r;
    cell.dataset.column = c;
    cell.tabIndex = r === here[0] && c === here[1] ? 0 : -1;
    mark(cell, grid[r][c]);
    return cell;
  }

  function mark(cell, stitch) {
    const row = grid.length - Number(cell.dataset.row);
    cell.className = stitch === "P" ? "purl" : "knit";
    cell.setAttribute(
      "aria-label",
      `row ${row}, column ${Number(cell.dataset.column) + 1}, ${NAMES[stitch]}`,
    );
  }

  const cell = (r, c) => table.children[r].children[c];
  const place = (target) => {
    const found = target?.closest?.("[role=gridcell]");
    return found && table.contains(found)
      ? [Number(found.dataset.row), Number(found.dataset.column)]
      : null;
  };

  function go(r, c) {
    cell(...here).tabIndex = -1;
    here = [r, c];
    cell(r, c).tabIndex = 0;
    cell(r, c).focus();
  }

  function set(r, c, stitch) {
    if (grid[r][c] === stitch) return;
    grid[r][c] = stitch;
    mark(cell(r, c), stitch);
  }

  function remember() {
    past.push(grid);
    grid = grid.map((row) => [...row]);
  }

  table.addEventListener("keydown", (event) => {
    const [r, c] = here;
    const key = event.key;
    if ((event.ctrlKey || event.metaKey) && key.toLowerCase() === "z") undo();
    else if (event.ctrlKey || event.metaKey || event.altKey) return;
    else if (key in STEPS) {
      const [down, right] = STEPS[key];
      const row = Math.min(Math.max(r + down, 0), grid.length - 1);
      go(row, Math.min(Math.max(c + right, 0), grid[0].length - 1));
    } else if (key === "Home") go(r, 0);
    else if (key === "End") go(r, grid[0].length - 1);
    else if (key === " " || key.toUpperCase() in OTHER) {
      remember();
      set(r, c, key === " " ? OTHER[grid[r][c]] : key.toUpperCase());
      send();
      status.textContent = cell(r, c).getAttribute("aria-label");
    } else return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key.toLowerCase() === "z") cell(...here).focus();
  });

  table.addEventListener("pointerdown", (event) => {
    const at = place(event.target);
    if (!at || event.button !== 0) return;
    event.preventDefault();
    remember();
    brush = OTHER[grid[at[0]][at[1]]];
    go(...at);
    set(...at, brush);
  });
  table.addEventListener("pointermove", (event) => {
    const at = brush && place(document.elementFromPoint(event.clientX, event.clientY));
    if (at) set(...at, brush);
  });
  const lift = () => {
    if (!brush) return;
    brush = null;
    send();
  };
  document.addEventListener("pointerup", lift);

  const follow = () => {
    if (model.get("text") === grid.map((row) => row.join("")).join("\n")) return;
    grid = read();
    draw();
  };
  model.on("change:text", follow);
  draw();
  return () => {
    document.removeEventListener("pointerup", lift);
    model.off("change:text", follow);
  };
}

export default { render };
