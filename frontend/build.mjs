/**
 * Bundles the page into dist/: minified modules with content-hashed names, split where the page
 * imports them later, styles inlined into index.html, and everything packed once for the wire.
 *
 *     node build.mjs            build and say how large the page's own scripts are
 *
 * The sources run as they are, too: the service falls back to them where dist/ is missing or old.
 */

import { build, transform } from "esbuild";
import { mkdir, readFile, readdir, rename, rm, stat, writeFile } from "node:fs/promises";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { rollup } from "rollup";

const ROOT = dirname(fileURLToPath(import.meta.url));
const DIST = join(ROOT, "dist");
/** Files of older builds stay a while, so that a page which is open can still load its panels. */
const KEPT_MS = 86_400_000;
const PACKED = /\.(js|css|html|svg|map)$/;

/** @param {{message: string, loc?: {file: string, line: number}}} error */
function failed({ message, loc }) {
  console.error(`The page cannot be built: ${message}${loc ? ` (${loc.file}:${loc.line})` : ""}`);
  return process.exit(1);
}

/** Names of the files of this build. @type {Set<string>} */
const current = new Set();

/** @param {string} name @param {string | Uint8Array} content */
async function put(name, content) {
  current.add(name);
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

// --- scripts: what is needed at once is one file, every panel that comes later another ----------
/** Modules that the page needs at once. @type {Set<string>} */
const atOnce = new Set();
const bundle = await rollup({
  input: join(ROOT, "app.js"),
  logLevel: "warn",
  plugins: [
    {
      name: "minify",
      buildEnd() {
        /** @param {string} id */
        const reach = (id) => {
          if (atOnce.has(id)) return;
          atOnce.add(id);
          this.getModuleInfo(id)?.importedIds.forEach(reach);
        };
        reach(join(ROOT, "app.js"));
      },
      renderChunk: (code) => transform(code, { format: "esm", minify: true, sourcemap: true, target: "es2022" }),
    },
  ],
}).catch(failed);
const { output } = await bundle
  .generate({
    format: "es",
    sourcemap: true,
    entryFileNames: "[name]-[hash].js",
    chunkFileNames: "[name]-[hash].js",
    manualChunks: (id) => (atOnce.has(id) ? "app" : undefined),
    experimentalMinChunkSize: 4000,
  })
  .catch(failed);
const [theme, styles] = await Promise.all(
  Object.entries({ "theme.js": "es2022", "styles/index.css": "chrome110" }).map(([entry, target]) =>
    build({
      absWorkingDir: ROOT,
      entryPoints: [entry],
      bundle: true,
      minify: true,
      write: false,
      target,
      outdir: DIST,
      entryNames: "[name]-[hash]",
      external: ["/static/*"],
    }),
  ),
).catch(failed);

await mkdir(DIST, { recursive: true });
const files = [
  ...output.map((file) => ({ name: file.fileName, contents: Buffer.from(file.code ?? file.source) })),
  ...theme.outputFiles.map(({ path, contents }) => ({ name: basename(path), contents })),
];
for (const { name, contents } of files) await put(name, contents);
await put("icon.svg", await readFile(join(ROOT, "icon.svg")));
// plotly for lines and points alone: what else it can draw would keep the page from painting for half a second
const PLOTLY = "plotly.js-basic-dist-min/plotly-basic.min.js";
// and compiled by another thread while it is read: on the page's own that is nine tenths of starting it
const COMPILED_AT_ONCE = "//# allFunctionsCalledOnLoad\n";
await put("plotly.min.js", COMPILED_AT_ONCE + (await readFile(join(ROOT, "node_modules", PLOTLY), "utf8")));
await mkdir(join(DIST, "viser"), { recursive: true });
for (const name of ["notices", "yarn", "smaller", "aside", "frame"]) {
  const source = await readFile(join(ROOT, "viser", `${name}.js`), "utf8");
  await put(`viser/${name}.js`, (await transform(source, { minify: true, target: "es2022" })).code);
}

// --- the page itself ----------------------------------------------------------------------------
const entry = output.find((file) => file.isEntry);
const first = [entry.fileName, ...entry.imports];
const themeName = files.find(({ name }) => /^theme-.*\.js$/.test(name)).name;

/** @param {string} html @param {string} tag @param {string} with_ */
const swap = (html, tag, with_) => {
  if (!html.includes(tag)) throw new Error(`index.html has no ${tag}`);
  return html.replace(tag, () => with_);
};
const css = styles.outputFiles.find(({ path }) => path.endsWith(".css")).text.trim();
let page = await readFile(join(ROOT, "index.html"), "utf8");
page = swap(page, '<link rel="stylesheet" href="/static/styles/index.css" />', `<style>${css}</style>`);
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
