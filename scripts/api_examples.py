"""Call every operation of the service once and keep the answers as API examples (`make examples`).

The requests are those of the schema, which shows the answers where they have been made.
"""

import json
import tempfile
import time
from pathlib import Path
from typing import Any

from fastapi.testclient import TestClient

from app.requests.uploads import EXAMPLES
from app.service.identity import LOCAL_USER
from app.service.jobs.store import OPEN
from app.service.main import create_app
from app.service.settings import Settings
from app.service.web.schema import documented_operations
from app.service.web.sessions import Sessions

FIRST = [
    "POST /api/v1/designs",
    "POST /api/v1/designs/{design}/strokes",
    "POST /api/v1/designs/{design}/versions",
    "POST /api/v1/designs/{design}/shares",
    "POST /api/v1/jobs",
    "PUT /api/v1/views/{design}",
]
LAST = [
    "POST /api/v1/materials",
    "DELETE /api/v1/materials/{identifier}",
    "DELETE /api/v1/jobs/{job}",
    "DELETE /api/v1/designs/{design}/shares/{share}",
    "DELETE /api/v1/designs/{design}",
    "POST /api/v1/designs/{design}/recover",
    "DELETE /api/v1/sessions/{session}",
    "DELETE /api/v1/session",
]
ENDLESS = ("/events", "/picture")
"""Streams, and operations that need a browser watching."""
MAX_ITEMS, MAX_CHARACTERS = 2, 160
TUPLE = 4
"""Lists up to this length are kept whole: their length may matter."""


def short(value: Any) -> Any:
    """An answer with the beginnings of long lists and texts."""
    if isinstance(value, dict):
        return {name: short(item) for name, item in value.items()}
    if isinstance(value, list):
        return [short(item) for item in (value[:MAX_ITEMS] if len(value) > TUPLE else value)]
    return value[:MAX_CHARACTERS] if isinstance(value, str) else value


def _request(operation: dict[str, Any]) -> Any:
    """The example of a request, if it has a body."""
    content = operation.get("requestBody", {}).get("content", {})
    return content.get("application/json", {}).get("example")


def ask_everything(client: TestClient) -> dict[str, Any]:
    """The answer of every operation that answers with JSON."""
    place: dict[str, Any] = {"material": "acrylic", "identifier": "acrylic", "number": 1}
    sessions = Sessions(client.app.state.database)  # type: ignore[attr-defined]
    place["session"] = sessions.begin("a token's id", LOCAL_USER)
    own: dict[str, Any] = {}
    answers = {}
    documented = dict(documented_operations(client.get("/openapi.json").json()))
    between = [name for name in documented if name not in (*FIRST, *LAST)]
    for name in (*FIRST, *between, *LAST):  # each finds the resources it needs
        method, path = name.split()
        if path.endswith(ENDLESS):
            continue
        body = _request(documented[name])
        if path.startswith("/api/v1/jobs/") and method == "GET":
            while client.get(f"/api/v1/jobs/{place['job']}").json()["state"] in OPEN:
                time.sleep(0.1)
        headers = {}
        if "design" in place and method in ("PUT", "PATCH", "POST"):
            tag = client.get(f"/api/v1/designs/{place['design']}").headers.get("etag")
            headers = {"If-Match": tag} if tag else {}
        answer = client.request(method, path.format(**(place | own)), json=body, headers=headers)
        answer.raise_for_status()
        print(name, answer.status_code)
        kind = answer.headers.get("content-type", "")
        content: Any = None
        if answer.content and kind.startswith("application/json"):
            content = answer.json()
        if name == "POST /api/v1/designs":
            place["design"] = content["id"]
        elif name == "POST /api/v1/jobs":
            place["job"] = content["id"]
        elif name == "POST /api/v1/materials":
            own = {"identifier": content["id"]}
        elif name == "POST /api/v1/designs/{design}/shares":
            place |= {"share": content["id"], "token": content["token"]}
        if content is not None:
            answers[name] = content
    return answers


def patient_client(folder: Path) -> TestClient:
    """A client of a service that has time, with its data in ``folder``."""
    settings = Settings(workers=1, worker_priority="low", job_timeout_s=600, data_dir=folder)
    return TestClient(create_app(settings), base_url="http://127.0.0.1")


def main() -> None:
    """Write the file."""
    with tempfile.TemporaryDirectory() as folder, patient_client(Path(folder)) as client:
        answers = short(ask_everything(client))
    text = json.dumps(answers, indent=1, ensure_ascii=False, sort_keys=True)
    (EXAMPLES / "answers.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
