/** Formatting is left to prettier, types to tsc and circular imports to madge; eslint finds slips and broken layers. */

import js from "@eslint/js";
import globals from "globals";

export default [
  { ignores: ["dist/"] },
  js.configs.recommended,
  {
    languageOptions: { globals: globals.browser },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      eqeqeq: "error",
      "no-var": "error",
      "prefer-const": "error",
      "object-shorthand": "error",
      "no-console": "error",
      "no-duplicate-imports": ["error", { allowSeparateTypeImports: true }],
    },
  },
  {
    files: ["core/**"],
    rules: {
      "no-restricted-imports": [
        "error",
        { patterns: [{ group: ["../*"], message: "core/ is logic without a browser." }] },
      ],
    },
  },
  {
    files: ["widgets/**"],
    rules: {
      "no-restricted-imports": [
        "error",
        { patterns: [{ group: ["**/panels/**"], message: "Widgets know no panels." }] },
      ],
    },
  },
  {
    files: ["build.mjs", "eslint.config.mjs", "tests/**"],
    languageOptions: { globals: globals.node },
    rules: { "no-console": "off" },
  },
];
