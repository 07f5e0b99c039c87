"""Refusals in words: what is to blame, and what would be accepted."""

from itertools import product
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.operations.registry import operations
from app.requests.uploads import has_files
from app.service.problems import KINDS, ServiceError, type_uri
from knitcore.base import reading_time
from tests.app.rest import refusal

API = "/api/v1"
STRETCH = {"chart": "KP\nPK", "material": "acrylic", "direction": "wale", "strain": 0.2}
FIND = {"targets": [{"quantity": "modulus_course_n_per_mm", "value": 0.2}]}
NO_TEST = {"name": "a.csv", "content": "bm90aGluZw=="}
TESTS = {"a.csv", "b.csv"}
WITH_FILES = [
    name
    for name, operation in operations().items()
    if operation.example and has_files(operation.request.model_validate(operation.example))
]
RIB = {"fabric": "rib", "columns": 120, "rows": 100}
VIEW = {"material": "acrylic"}


@pytest.mark.parametrize(
    ("path", "body", "field", "remedy"),
    [
        ("/stretch", STRETCH | {"steps": 0}, "steps", "Use 1 or more."),
        ("/stretch", STRETCH | {"strain": 6}, "strain", "Use 5.0 or less."),
        ("/stretch", STRETCH | {"strain": 0}, "strain", "Use more than 0.0."),
        ("/stretch", STRETCH | {"steps": "many"}, "steps", "Use a whole number."),
        ("/stretch", STRETCH | {"direction": "up"}, "direction", "Use 'course' or 'wale'."),
        ("/stretch", STRETCH | {"colour": 1}, "colour", "Leave colour out"),
        ("/stretch", STRETCH | {"chart": 5}, "chart", 'Give rows such as "KP/PK"'),
        ("/stretch", STRETCH | {"chart": None}, "chart", '"rib", "columns": 4, "rows": 2}.'),
        ("/stretch", STRETCH | {"gauge": 5}, "gauge", "Give gauge as a JSON object"),
        ("/stretch", [], "body", "Send a JSON object, with Content-Type"),
        ("/stretch", {**STRETCH, "material": None}, "material", "valid string"),
        (
            "/limb",
            {"chart": "K", "material": "acrylic", "girths": [{"at_mm": 0, "girth_mm": 150}]},
            "girths",
            "Give 2 or more girths.",
        ),
        ("/designs", {"name": ""}, "name", "Use 1 or more characters."),
        ("/designs", {"chart": "K"}, "name", "Give name"),
        ("/jobs", {"kind": "dance", "request": {}}, "kind", "Use one of 'atlas', 'bend'"),
        ("/jobs", {"kind": [], "request": {}}, "kind", "Use one of 'atlas', 'bend'"),
        ("/jobs", {"request": {}}, "kind", "kind"),
        (
            "/jobs",
            {"kind": "whole", "request": {"chart": {"fabric": "rib"}, "material": "acrylic"}},
            "request.chart.columns",
            "Give request.chart.columns",
        ),
        (
            "/estimate",
            {"bending_modulus_n_mm2": 0.04, "loop_length_mm": 1},
            "loop_length_mm",
            "units",
        ),
        ("/jobs", {"kind": "curve", "request": {"chart": "K"}}, "request.material", "Give"),
        ("/views/solid", VIEW | {"chart": RIB}, "chart", "at most 10000"),
        (
            "/views/still",
            VIEW | {"chart": RIB | {"columns": 1000, "rows": 1000}, "rectangles": True},
            "rectangle_block",
            "Use blocks of 5 or more",
        ),
    ],
)
def test_a_refusal_names_field_and_remedy(
    client: TestClient, path: str, body: dict[str, Any], field: str, remedy: str
) -> None:
    problem = refusal(client, path.removeprefix("/"), body)
    assert problem["field"] == field
    assert remedy in problem["remedy"]


def test_all_errors_are_reported_at_once(client: TestClient) -> None:
    body = {"material": 1, "strain": 6, "colour": "red", "direction": "wale"}
    problem = client.post(f"{API}/stretch", json=body).json()
    wrong = [fault["field"] for fault in problem["errors"]]
    assert wrong == ["chart", "material", "strain", "colour"]
    first = problem["errors"][0]
    assert {name: problem[name] for name in first} == first
    measured = client.post(f"{API}/measure/bending", json={"images": [], "length_mm": "long"})
    wrong = [fault["field"] for fault in measured.json()["errors"]]
    assert len(wrong) == len(set(wrong))
    by_the_library = client.post(f"{API}/predict", json={"chart": "KQ", "material": "acrylic"})
    assert [fault["field"] for fault in by_the_library.json()["errors"]] == ["chart"]


@pytest.mark.parametrize(
    ("path", "body", "wrong"),
    [
        (
            "/curve",
            {"chart": "KQ", "material": "steel", "direction": "wale", "stress_n_per_mm": [1, 0]},
            {"chart", "material", "stress"},
        ),
        ("/stretch", STRETCH | {"outline": "xq\nxx", "material": "steel"}, {"outline", "material"}),
        ("/predict", {"chart": "K\nKP", "material": "steel"}, {"chart", "material"}),
        ("/find", FIND | {"materials": ["steel", "acrylic", "wood"]}, {"material"}),
        ("/fit", {"test_course": NO_TEST, "test_wale": NO_TEST | {"name": "b.csv"}}, TESTS),
        (
            "/stretch",
            STRETCH | {"chart": "KQ", "material": "steel", "strain": 9},
            {"chart", "material", "strain"},
        ),
        (
            "/jobs",
            {"kind": "stretch", "request": STRETCH | {"chart": "KQ", "strain": 9}},
            {"chart", "request.strain"},
        ),
    ],
)
def test_faults_that_the_library_finds_are_told_together(
    client: TestClient, path: str, body: dict[str, Any], wrong: set[str]
) -> None:
    """Also beside those that the request's shape has."""
    problem = client.post(f"{API}{path}", json=body).json()
    assert {fault["field"] for fault in problem["errors"]} == wrong, problem["errors"]
    assert problem["errors"][0]["detail"] == problem["detail"]
    details = [fault["detail"] for fault in problem["errors"]]
    assert len(details) == len(set(details)) > 1


def test_every_type_has_a_page(client: TestClient) -> None:
    def types(of: type[ServiceError]) -> set[str]:
        return {of.type}.union(*map(types, of.__subclasses__()))

    assert types(ServiceError) <= set(KINDS)
    everything = client.get("/problems").text
    for name in KINDS:
        page = client.get(type_uri(name))
        assert page.status_code == 200
        assert f">{name}</a></h2>" in page.text
        assert f'href="{type_uri(name)}"' in everything
    assert client.get("/problems/no-such").status_code == 404


def test_a_form_is_refused_with_a_request_for_json(client: TestClient) -> None:
    answer = client.post(f"{API}/predict", data={"chart": "K"})
    assert answer.status_code == 422
    assert "application/json" in answer.json()["remedy"]


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        *product(
            (
                "/designs/no.such",
                "/designs/a",  # unknown, however short
                "/designs/a/versions",
                "/designs/a/versions/1",
                "/designs/abc/versions/0",
                "/designs/abc/versions/two",
                "/designs/a/events",
                "/jobs/b",
                f"/jobs/{'j' * 65}",
                "/shared/c",
                "/shared/a.b",
                "/views/a.b/picture",
                "/views/a/events",
                "/materials/steel",
            ),
            ("not-found",),
        ),
        ("/nothing", "http"),
    ],
)
def test_impossible_and_unknown_addresses_are_not_found(
    client: TestClient, path: str, kind: str
) -> None:
    answer = client.get(f"{API}{path}")
    assert (answer.status_code, answer.json()["type"]) == (404, f"/problems/{kind}")
    assert answer.json()["remedy"]


def test_head_requests_have_the_headers_of_get(client: TestClient) -> None:
    for path in ("/", "/healthz", f"{API}/designs", "/static/app.css"):
        head, whole = client.head(path), client.get(path)
        assert head.status_code == whole.status_code
        assert head.headers["content-type"] == whole.headers["content-type"]
    assert client.head(f"{API}/stretch").status_code == 405


@pytest.mark.parametrize("name", WITH_FILES)
def test_only_workers_read_files(
    client: TestClient, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Even a small file can keep its reader busy, and with it the service for everybody: it is
    read neither to find all faults of a request nor to queue a job."""
    monkeypatch.setattr(reading_time, "_Watch", None)  # of this process; workers have their own
    operation = operations()[name]
    body = _with_nothing_in_files(operation.example)
    problem = refusal(client, operation.address.removeprefix("/"), body | {"nonsense": 1})
    assert problem["field"] == "nonsense"
    if operation.job:
        for request in (body, body | {"nonsense": 1}):
            answer = client.post(f"{API}/jobs", json={"kind": name, "request": request})
            assert answer.status_code in (202, 422)


def _with_nothing_in_files(example: Any) -> Any:
    if isinstance(example, list):
        return [_with_nothing_in_files(part) for part in example]
    if not isinstance(example, dict):
        return example
    return {n: "AAAA" if n == "content" else _with_nothing_in_files(v) for n, v in example.items()}
