/** Formatting is prettier's and types are tsc's; eslint looks for slips and for circles of modules. */

import js from "@eslint/js";
import { importX } from "eslint-plugin-import-x";
import globals from "globals";

export default [
  { ignores: ["dist/"] },
  js.configs.recommended,
  {
    languageOptions: { globals: globals.browser },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    plugins: { "import-x": importX },
    rules: {
      eqeqeq: "error",
      "no-var": "error",
      "prefer-const": "error",
      "object-shorthand": "error",
      "no-console": "error",
      "import-x/first": "error",
      "import-x/no-cycle": "error",
      "import-x/no-duplicates": "error",
      "import-x/no-unresolved": "error",
      "import-x/no-restricted-paths": [
        "error",
        {
          zones: [
            { target: "./core", from: ["./!(core)/**", "./*.js"], message: "core/ is logic without a browser." },
            { target: "./widgets", from: "./panels", message: "Widgets know no panels." },
          ],
        },
      ],
    },
  },
  {
    files: ["build.mjs", "eslint.config.mjs", "tests/**"],
    languageOptions: { globals: globals.node },
    rules: { "no-console": "off" },
  },
];
