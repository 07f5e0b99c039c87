"""Faults that axe finds in a page."""

from pathlib import Path
from typing import Literal

import pytest
from playwright.sync_api import Page

SCRIPT = Path(__file__).resolve().parents[2] / "frontend/node_modules/axe-core/axe.min.js"
THEMES: list[Literal["light", "dark"]] = ["light", "dark"]
EVERY = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
COLOURS = ["color-contrast", "link-in-text-block"]
"""Rules on which themes differ."""
RUN = """async ([within, kinds]) => {
    const { violations } = await axe.run(within, {
        resultTypes: ["violations"],
        runOnly: kinds,
        iframes: false,
    });
    return violations.map(({ id, impact, nodes }) => ({
        id, impact, where: nodes.map(({ target, failureSummary }) =>
            `${target.join(" ")}: ${failureSummary.split("\\n").slice(1, 3).join(" ").trim()}`),
    }));
}"""


def violations(page: Page, within: str = "body", kinds: list[str] = EVERY) -> list[str]:
    """Serious and critical violations in a part of the page, in words."""
    if not SCRIPT.exists():
        pytest.skip("needs axe-core (make frontend/node_modules/.installed)")
    if not page.evaluate("() => 'axe' in window"):
        page.evaluate(SCRIPT.read_text())
    return [
        f"{violation['impact']} {violation['id']} at {where}"
        for violation in page.evaluate(RUN, [within, kinds])
        if violation["impact"] in ("serious", "critical")
        for where in violation["where"]
    ]


def violations_in_both_themes(page: Page, within: str) -> list[str]:
    """Serious and critical violations in each theme; the light one is left on."""
    faults = []
    for theme, kinds in (("dark", COLOURS), ("light", EVERY)):
        page.emulate_media(color_scheme=theme)
        faults += [f"{theme}: {wrong}" for wrong in violations(page, within, kinds)]
    return faults
