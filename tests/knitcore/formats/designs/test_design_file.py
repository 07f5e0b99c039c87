import json
from pathlib import Path

import pytest

from knitcore import InputError
from knitcore.formats.designs.design_file import DesignFile, design_schema, read_design


def test_the_schema_names_what_a_file_holds() -> None:
    schema = design_schema()
    assert schema["additionalProperties"] is False
    assert set(schema["properties"]) == set(DesignFile.model_fields)
    assert schema["properties"]["format"]["const"] == "knitcore-design"
    assert schema["required"] == ["chart"]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"colour": "red"}, "colour"),
        ({"name": ""}, "name"),
        ({"chart": "KX"}, "which is no stitch"),
        ({"version": 3}, "version 3"),
        ({"version": 1}, "version 1"),
        ({"version": True}, "version"),
        ({"version": [1]}, "version"),
        ({"format": "other"}, "not a design"),
    ],
)
def test_errors_name_their_place(tmp_path: Path, change: dict[str, object], says: str) -> None:
    file = tmp_path / "design.json"
    file.write_text(json.dumps({"format": "knitcore-design", "version": 2, "chart": "KP"} | change))
    with pytest.raises(InputError, match=says):
        read_design(file)
