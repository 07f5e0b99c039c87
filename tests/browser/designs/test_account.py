"""Signing in and out: the page names the user, lists the browsers and forgets the design."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from app.service.limits.user_limits import OverLimitError
from app.service.web.errors import problem_of
from tests.app.running import Service
from tests.browser.axe import THEMES, violations
from tests.browser.conftest import flat

TOO_MANY: dict[str, str] = problem_of(OverLimitError.of("connections", 128, 128)).model_dump()


@pytest.fixture
def lab(tmp_path: Path, bundle: None) -> Iterator[tuple[str, str]]:
    """Address of a service with logins, and a token of ada."""
    service = Service(tmp_path, require_login="true")
    data = os.environ | {"KNITCORE_DATA_DIR": str(tmp_path / "data")}
    words = [sys.executable, "-m", "app.cli.main", "token", "create", "ada", "--json"]
    made = subprocess.run(words, env=data, capture_output=True, text=True, check=True)
    service.start().close()
    yield service.url, made.stdout.split('"token":')[1].split('"')[1]
    service.kill()


@pytest.mark.slow
def test_the_user_is_named_and_signs_out(visitor: Page, lab: tuple[str, str]) -> None:
    url, token = lab
    page = visitor
    flat(page).goto(url)
    faults = [f"sign-in: {wrong}" for wrong in violations(page)]
    page.get_by_label("Token").fill(token)
    page.get_by_role("button", name="Sign in").click()
    account = page.get_by_role("button", name="Account: ada")
    for theme in THEMES:
        page.emulate_media(color_scheme=theme)
        account.click()
        expect(page.locator("#sessions")).to_contain_text("This browser")
        expect(page.get_by_role("row", name="Designs, with")).to_contain_text("5,000")
        faults += [f"{theme}: {wrong}" for wrong in violations(page, "#account-dialog")]
        page.keyboard.press("Escape")
    page.route("**/api/v1/session", lambda route: route.fulfill(status=429, json=TOO_MANY))
    account.click()
    status = page.locator("#account-dialog .dialog-status")
    expect(status).to_contain_text(TOO_MANY["detail"])
    expect(status).to_contain_text(TOO_MANY["remedy"])
    page.unroute("**/api/v1/session")
    status.get_by_role("button", name="Try again").click()
    expect(page.locator("#sessions")).to_contain_text("This browser")
    page.locator("#sign-out").click()
    expect(page.get_by_label("Token")).to_be_visible()
    assert page.evaluate("localStorage['knitcore.design']") is None
    assert page.context.cookies() == []
    assert not faults, "\n".join(faults)
