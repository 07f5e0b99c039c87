"""The whole schema against the real service: no surprise, and no answer that is not documented.

Valid and invalid requests are made from the schema; `make test-hard` sends thousands.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import product
from typing import Any

import httpx2 as httpx
import jsonschema_rs
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.errors import Unsatisfiable

from tests.app.running import Service

EXAMPLES = int(os.environ.get("KNITCORE_SCHEMA_EXAMPLES", "2"))


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("schema")
    with Service(folder, job_timeout_s="1", workers="2") as service:
        yield service.url


def _faults(documented: dict[str, Any], case: Any, response: Any) -> list[str]:
    """Where an answer is not as documented; Schemathesis cannot read `prefixItems`."""
    answers = documented["paths"][case.operation.path][case.operation.method]["responses"]
    media = response.headers.get("content-type", [""])[0]
    content = answers[str(response.status_code)].get("content", {}).get(media, {})
    if "schema" not in content or not media.endswith("json"):
        return []
    whole = content["schema"] | {"components": documented["components"]}
    return [error.message for error in jsonschema_rs.iter_errors(whole, response.json())]


@pytest.mark.slow
def test_every_answer_is_documented(url: str) -> None:
    import schemathesis  # a second that the default suite has no use for
    from schemathesis import GenerationMode
    from schemathesis.specs.openapi import checks

    documented = httpx.get(f"{url}/openapi.json", timeout=60).json()
    schema = schemathesis.openapi.from_dict(documented)
    schema.config.update(base_url=url)
    strange: list[str] = []
    count = 0
    answered: set[tuple[str, int]] = set()
    modes = (GenerationMode.POSITIVE, GenerationMode.NEGATIVE)
    for described, mode in product(schema.get_all_operations(), modes):
        operation = described.ok()

        @given(case=operation.as_strategy(mode))
        @settings(
            max_examples=EXAMPLES,
            deadline=None,
            database=None,
            phases=[Phase.explicit, Phase.generate],
            suppress_health_check=list(HealthCheck),
            derandomize=True,
        )
        def run(case: schemathesis.Case) -> None:
            nonlocal count
            count += 1
            response = case.call(timeout=60)
            assert response.status_code < 500 or response.status_code == 503, response.text
            case.validate_response(
                response, checks=[checks.status_code_conformance, checks.content_type_conformance]
            )
            faults = _faults(documented, case, response)
            assert not faults, faults
            answered.add((case.operation.label, response.status_code))

        try:
            run()
        except Unsatisfiable:
            assert mode is GenerationMode.NEGATIVE  # it takes nothing, so nothing can be wrong
        except BaseExceptionGroup as group:
            strange += [f"{operation.label}: {e}" for e in group.exceptions]
        except Exception as error:
            strange.append(f"{operation.label}: {error}")
    assert not strange, "\n\n".join(strange)
    assert count > 100
    assert len({label for label, status in answered if status < 400}) > 20  # a busy service: 503
