/** Formatting is left to prettier, types to tsc, circular imports to madge and layers to tests/rooms.test.js; eslint finds slips. */

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
    files: ["build.mjs", "eslint.config.mjs", "tests/**"],
    languageOptions: { globals: globals.node },
    rules: { "no-console": "off" },
  },
];
