"""Materials of users as operations see them."""

import pytest

from app.service.results.own_materials import MAX_NAMED, GivenMaterials, marked, named_in
from knitcore.base.errors import InputError
from knitcore.materials import material
from knitcore.materials.material_document import MaterialDocument

DOCUMENT = MaterialDocument.from_material(material("acrylic")).model_dump_json()


def test_an_identifier_changes_with_the_content() -> None:
    first, second = marked("mine", b"1"), marked("mine", b"2")
    assert first.startswith("own:mine.")
    assert first != second
    assert marked("mine", b"1") == first


def test_a_request_carries_the_materials_that_it_names() -> None:
    names = [f"own:yarn-{number}.abcdef" for number in range(MAX_NAMED + 1)]
    request = f'{{"material": "{names[0]}", "materials": ["{names[1]}", "acrylic", "{names[0]}"]}}'
    assert named_in(request.encode()) == names[:2]
    assert named_in(b'{"material": "acrylic", "note": "my own: none"}') == []
    assert named_in(",".join(names[1:]).encode()) == names[1:]
    with pytest.raises(InputError, match=f"names {MAX_NAMED + 1} .* at most {MAX_NAMED}"):
        named_in(",".join(names).encode())


def test_what_came_with_a_request_is_found() -> None:
    given = GivenMaterials({"own:mine.1": DOCUMENT, "own:mine.0": ""})
    assert given.find("own:mine.1").identifier == "own:mine.1"
    assert [own.identifier for own, _ in given.listed("ann")] == ["own:mine.1"]
    with pytest.raises(InputError, match="was changed since"):
        given.find("own:mine.0")
    with pytest.raises(InputError, match="is gone"):
        given.find("own:other.1")
