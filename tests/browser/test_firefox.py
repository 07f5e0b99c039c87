"""The main job in Firefox: paint, see, stretch; driven by WebDriver BiDi, which it has built in."""

import itertools
import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

from tests.browser.conftest import TIMEOUT_MS

FIREFOX = shutil.which("firefox-esr") or shutil.which("firefox")
PREFERENCES = 'user_pref("webgl.force-enabled", true);\nuser_pref("ui.prefersReducedMotion", 1);\n'

pytestmark = pytest.mark.slow


class Firefox:
    """One tab."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket, self._ids = socket, itertools.count(1)
        self.command("session.new", capabilities={})
        self.tab = self.command("browsingContext.create", type="tab")["context"]

    def command(self, method: str, **params: Any) -> dict[str, Any]:
        """The result of a command; events are passed over."""
        number = next(self._ids)
        self._socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while (answer := json.loads(self._socket.recv(TIMEOUT_MS / 1000))).get("id") != number:
            pass
        assert answer["type"] == "success", answer
        result: dict[str, Any] = answer["result"]
        return result

    def open(self, url: str) -> None:
        """Load a page."""
        self.command("browsingContext.navigate", context=self.tab, url=url, wait="complete")

    def value(self, expression: str) -> Any:
        """Return what a script of the page gives, once it is there."""
        answer = self.command(
            "script.evaluate",
            expression=expression,
            target={"context": self.tab},
            awaitPromise=True,
        )
        assert answer["type"] == "success", answer
        return answer["result"].get("value")

    def until(self, condition: str) -> None:
        """Wait until the page shows it."""
        self.value(
            f"""new Promise((done, fail) => {{
                const seen = () => {{ if ({condition}) done(true); }};
                new MutationObserver(seen).observe(document,
                    {{ subtree: true, childList: true, attributes: true, characterData: true }});
                setTimeout(() => fail(new Error("never seen")), {TIMEOUT_MS});
                seen();
            }})"""
        )

    def drag(self, path: list[tuple[int, int]]) -> None:
        """A stroke through places of the window."""
        moves = [{"type": "pointerMove", "x": x, "y": y} for x, y in path]
        press, lift = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
        actions = [moves[0], press, *moves[1:], lift]
        pointer = {"type": "pointer", "id": "mouse", "actions": actions}
        self.command("input.performActions", context=self.tab, actions=[pointer])


@pytest.fixture
def firefox(tmp_path: Path) -> Iterator[Firefox]:
    """A Firefox that was never here before."""
    if FIREFOX is None:
        pytest.skip("needs Firefox (apt-get install --no-install-recommends firefox-esr)")
    (tmp_path / "user.js").write_text(PREFERENCES)
    process = subprocess.Popen(
        [FIREFOX, "--headless", "--profile", str(tmp_path), "--remote-debugging-port", "0"],
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
    )
    assert process.stderr is not None
    with process.stderr:
        address = None
        while address is None and (line := process.stderr.readline()):
            address = re.search(r"BiDi listening on (ws://\S+)", line)
        assert address, "Firefox printed no address"
        with connect(f"{address.group(1)}/session", max_size=None, open_timeout=60) as socket:
            yield Firefox(socket)
        process.terminate()
        process.wait(TIMEOUT_MS / 1000)


def test_the_main_job_in_firefox(firefox: Firefox, service: str) -> None:
    firefox.open(service)
    number = "document.querySelector('#modulus-course .value')?.textContent"
    firefox.until(f"/\\d/.test({number})")
    draws = firefox.value("!!document.createElement('canvas').getContext('webgl2')")
    status = "document.querySelector('.fabric-frame ~ .fabric-status')?.textContent"
    firefox.until(f"{status} === ''" if draws else f"{status}?.includes('no WebGL 2')")
    firefox.until("!document.querySelector('#stretch-slider').disabled")
    before = firefox.value(number)
    box = json.loads(
        firefox.value("JSON.stringify(document.querySelector('#chart').getBoundingClientRect())")
    )
    x, y = round(box["x"] + box["width"] / 2), round(box["y"] + box["height"] / 2)
    firefox.drag([(x, y), (x + 40, y + 20), (x + 90, y + 40)])
    firefox.until(f"{number} !== {json.dumps(before)}")
    firefox.until("document.querySelector('#action-undo')?.disabled === false")
    firefox.until("document.querySelector('#stretch-figures').textContent.includes('30 %')")
