/**
 * Bundles the page into dist/: minified modules with content-hashed names, split where the page
 * imports them later, styles inlined into index.html, and everything packed once for the wire.
 *
 *     node build.mjs            build and say how large the page's own scripts are
 *
 * The sources run as they are, too: the service falls back to them where dist/ is missing or old.
 */

import { build } from "esbuild";
import { mkdir, readFile, readdir, rename, rm, stat, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const ROOT = dirname(fileURLToPath(import.meta.url));
const DIST = join(ROOT, "dist");
/** Files of older builds stay a while, so that a page which is open can still load its panels. */
const KEPT_MS = 86_400_000;
const PACKED = /\.(js|css|html|svg|map)$/;

/** @param {string} name @param {string | Uint8Array} content */
async function put(name, content) {
  const file = join(DIST, name);
  const draft = `${file}.${process.pid}`;
  for (const [target, bytes] of [
    [`${file}.gz`, PACKED.test(name) && gzipSync(content, { level: 9 })],
    [file, content],
  ]) {
    if (!bytes) continue;
    await writeFile(draft, bytes);
    await rename(draft, target); // whoever reads meanwhile gets the old file or the new one
  }
}

const options = {
  absWorkingDir: ROOT,
  bundle: true,
  minify: true,
  write: false,
  metafile: true,
  outdir: DIST,
  entryNames: "[name]-[hash]",
  chunkNames: "[name]-[hash]",
  legalComments: "none",
  logLevel: "error",
  external: ["/static/*"],
};
const [scripts, theme, styles] = await Promise.all([
  build({ ...options, entryPoints: ["app.js"], format: "esm", splitting: true, sourcemap: true, target: "es2022" }),
  build({ ...options, entryPoints: ["theme.js"], target: "es2022" }),
  build({ ...options, entryPoints: ["styles/index.css"], target: "chrome110" }),
]).catch(() => process.exit(1)); // esbuild has said where and why

await mkdir(DIST, { recursive: true });
const files = [...scripts.outputFiles, ...theme.outputFiles].map(({ path, contents }) => ({
  name: path.slice(DIST.length + 1),
  contents,
}));
for (const { name, contents } of files) await put(name, contents);
await put("icon.svg", await readFile(join(ROOT, "icon.svg")));

// --- what the first visit needs ---------------------------------------------------------------
const outputs = scripts.metafile.outputs;
/** @param {string} path in the metafile @param {Set<string>} seen */
const needed = (path, seen = new Set()) => {
  if (seen.has(path)) return seen;
  seen.add(path);
  for (const { path: next, kind, external } of outputs[path].imports) {
    if (!external && kind === "import-statement") needed(next, seen);
  }
  return seen;
};
const entry = Object.keys(outputs).find((path) => outputs[path].entryPoint === "app.js");
const first = [...needed(entry)].map((path) => path.replace(/^dist\//, ""));
const themeName = files.find(({ name }) => /^theme-.*\.js$/.test(name)).name;

/** @param {string} html @param {string} tag @param {string} with_ */
const swap = (html, tag, with_) => {
  if (!html.includes(tag)) throw new Error(`index.html has no ${tag}`);
  return html.replace(tag, () => with_);
};
const css = styles.outputFiles.find(({ path }) => path.endsWith(".css")).text.trim();
let page = await readFile(join(ROOT, "index.html"), "utf8");
page = swap(page, '<link rel="stylesheet" href="/static/styles/index.css">', `<style>${css}</style>`);
page = swap(page, '<script src="/static/theme.js"></script>', `<script src="/static/${themeName}"></script>`);
page = swap(
  page,
  '<script type="module" src="/static/app.js"></script>',
  [
    ...first.slice(1).map((name) => `<link rel="modulepreload" href="/static/${name}">`),
    `<script type="module" src="/static/${first[0]}"></script>`,
  ].join("\n    "),
);

// --- sizes, then the page itself, which makes the build valid ---------------------------------
const own = files.filter(({ name }) => name.endsWith(".js"));
/** @param {typeof own} some */
const weight = (some) => ({
  bytes: some.reduce((sum, { contents }) => sum + contents.length, 0),
  gzip_bytes: some.reduce((sum, { contents }) => sum + gzipSync(contents, { level: 9 }).length, 0),
});
const sizes = {
  total: weight(own),
  initial: weight(own.filter(({ name }) => first.includes(name) || name === themeName)),
  styles: { bytes: css.length, gzip_bytes: gzipSync(css, { level: 9 }).length },
  scripts: Object.fromEntries(own.map(({ name, contents }) => [name, contents.length])),
};
await put("sizes.json", `${JSON.stringify(sizes, null, 2)}\n`);
await put("index.html", page);

const current = new Set(["index.html", "icon.svg", "sizes.json", ...files.map(({ name }) => name)]);
for (const name of await readdir(DIST)) {
  if (current.has(name.replace(/\.gz$/, ""))) continue;
  const { mtimeMs } = await stat(join(DIST, name)).catch(() => ({ mtimeMs: Date.now() }));
  if (Date.now() - mtimeMs > KEPT_MS) await rm(join(DIST, name), { force: true });
}

const kB = (bytes) => `${(bytes / 1000).toFixed(1)} kB`;
console.log(
  `The page is built: ${kB(sizes.total.bytes)} of scripts (${kB(sizes.total.gzip_bytes)} packed), ` +
    `${kB(sizes.initial.bytes)} of them at once; styles ${kB(sizes.styles.bytes)}.`,
);
