"""Extensions of other packages: the example works, and a bad one harms nothing else."""

import sys
from pathlib import Path

import pytest

from knitcore import InputError, StitchChart, material, predict
from knitcore.base.extensions import (
    ExtensionError,
    ExtensionWarning,
    Group,
    extensions,
    offered,
    running,
)
from knitcore.formats.write.export import Exporter, ExportKind, export_chart
from knitcore.materials import Material
from tests.extension_package import install, install_example

BAD = """
from knitcore.formats.write.export import Exporter

def fails():
    raise OSError("no licence")

def numbers():
    return [1]

def nameless():
    return [Exporter("No Name", ".txt", "text/plain", write=str)]

def png():
    return [Exporter("png", ".png", "image/png", write=str)]
"""


@pytest.fixture
def house(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install_example(monkeypatch, tmp_path)


@pytest.mark.usefixtures("house")
class TestExample:
    def test_an_extension_is_imported_only_when_needed(self) -> None:
        material("acrylic")
        export_chart(StitchChart.parse("KP"), ExportKind.TEXT, material("acrylic"))
        assert [e.package for e in extensions(Group.EXPORTERS)] == ["knit-house 1.0"]
        assert "knit_house" not in sys.modules

    def test_its_yarn_answers_as_any_other(self) -> None:
        yarn = material("house-dk")
        answer = predict(StitchChart.of_fabric("rib", rows=8, columns=8), yarn)
        assert answer.provenance == "estimated"
        assert 0 < answer.modulus_course_n_per_mm < answer.modulus_wale_n_per_mm

    def test_an_unknown_material_is_refused_with_the_known_ones(self) -> None:
        with pytest.raises(InputError, match=r"acrylic.*house-dk, house-sport"):
            material("no-such-yarn")

    def test_its_format_writes_a_file_and_refuses_what_it_cannot_hold(self) -> None:
        acrylic = material("acrylic")
        file = export_chart(StitchChart.parse("KP/KK"), "punchcard", acrylic)
        assert file.suffix == ".txt"
        assert file.content.decode().splitlines()[1:] == ["." * 24, ".o" * 12]
        with pytest.raises(InputError, match="repeats every 24 stitches"):
            export_chart(StitchChart.parse("KPKKP"), "punchcard", acrylic)

    def test_an_unknown_format_is_refused_with_the_known_ones(self) -> None:
        with pytest.raises(InputError, match=r"knitout, .*punchcard"):
            export_chart(StitchChart.parse("KP"), "no-such-format", material("acrylic"))


@pytest.mark.parametrize(
    ("target", "problem"),
    [
        ("bad_knitting:fails", "OSError: no licence"),
        ("bad_knitting:numbers", "offers a int, not a Exporter"),
        ("bad_knitting:nameless", "'No Name' is not an identifier"),
        ("bad_knitting:png", "png exists already"),
        ("bad_knitting:absent", "AttributeError"),
        ("no_such_module:exporters", "ModuleNotFoundError"),
    ],
)
def test_a_bad_extension_is_named_and_left_out(
    target: str, problem: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    install_example(monkeypatch, tmp_path / "good")
    install(monkeypatch, tmp_path / "bad", "bad", "2.0", {Group.EXPORTERS: {"bad-one": target}})
    (tmp_path / "bad" / "bad_knitting.py").write_text(BAD)
    with pytest.warns(ExtensionWarning, match=f"'bad-one' .*{target}.* of bad 2.0 .*{problem}"):
        offers = offered(Group.EXPORTERS, Exporter, set(ExportKind))
    assert list(offers) == ["punchcard"]
    sys.modules.pop("bad_knitting", None)


def test_an_extension_that_fails_while_it_runs_is_named() -> None:
    with (
        pytest.raises(ExtensionError, match=r"'card' .*exporters.*ZeroDivisionError: oh"),
        running(Group.EXPORTERS, "card"),
    ):
        raise ZeroDivisionError("oh")


def test_without_extensions_only_built_in_things_are_offered() -> None:
    assert offered(Group.EXPORTERS, Exporter) == {}
    assert offered(Group.MATERIALS, Material) == {}
