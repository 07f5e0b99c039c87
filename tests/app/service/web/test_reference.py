"""The reference page of the API."""

import re
from typing import Any

from fastapi.testclient import TestClient

from app.service.web.schema import documented_operations


def test_it_shows_every_operation_and_example(client: TestClient, schema: dict[str, Any]) -> None:
    page = client.get("/docs").text
    for operation, _ in documented_operations(schema):
        method, path = operation.split()
        assert f"<b>{method}</b><code>{path}</code>" in page
    shown = re.sub(r"&quot;", '"', page)
    for _, operation in documented_operations(schema):
        for part in (operation.get("requestBody", {}), *operation["responses"].values()):
            for content in part.get("content", {}).values():
                if isinstance(content.get("example"), dict):
                    assert f'"{next(iter(content["example"]))}"' in shown


def test_it_needs_no_other_host_and_no_script(client: TestClient) -> None:
    page = client.get("/docs").text
    assert "<script" not in page
    assert not re.findall(r'(?:src|href)="(?:https?:)?//', page)


def test_its_links_lead_somewhere(client: TestClient) -> None:
    page = client.get("/docs").text
    names = re.findall(r'id="([^"]+)"', page)
    assert len(names) == len(set(names))
    assert set(re.findall(r'href="#([^"]+)"', page)) <= set(names)
    assert 'href="#StretchRequest"' in page
