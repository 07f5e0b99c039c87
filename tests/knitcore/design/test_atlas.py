import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import CancelledError, Direction, Fabric, InputError, StitchChart, material, predict
from knitcore.base.batch import run_batch
from knitcore.chart.repeats import repeats_up_to
from knitcore.design.atlas import FORMAT, load_atlas, save_atlas
from knitcore.design.atlas_build import AT_ONCE, build_atlas, parts_folder
from knitcore.law.uniaxial import free_strains_at_stress
from tests.knitcore.design.atlases import REPEATS, acrylic_atlas

ACRYLIC = material("acrylic")


@pytest.mark.parametrize("fabric", list(Fabric))
def test_pure_fabrics_have_their_measured_laws(fabric: Fabric) -> None:
    atlas, law = acrylic_atlas(), ACRYLIC.law(fabric)
    index = atlas.index_of(StitchChart.of_fabric(fabric))
    assert atlas.provenance[index] == "measured"
    for direction in Direction:
        assert atlas.modulus(direction)[index] == pytest.approx(law.modulus(direction))
        for load in (0.013, 0.1, 0.31):
            exact = free_strains_at_stress(law, direction, load)
            assert atlas.strain_at(direction, load)[index] == pytest.approx(exact, rel=0.005)
            assert atlas.stress_at(direction, exact)[index] == pytest.approx(load, rel=0.01)


def test_a_mixed_repeat_has_its_prediction() -> None:
    basket = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
    atlas = build_atlas(ACRYLIC, [basket])
    assert atlas.provenance == ("learned",)
    prediction = predict(basket, ACRYLIC)
    assert atlas.column("modulus_course_n_per_mm")[0] == prediction.modulus_course_n_per_mm


def test_intervals_hold_their_values() -> None:
    atlas = acrylic_atlas()
    for direction in Direction:
        assert (atlas.column(f"modulus_{direction}_low") < atlas.modulus(direction)).all()
        assert (atlas.column(f"modulus_{direction}_high") > atlas.modulus(direction)).all()


def test_a_stopped_build_resumes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopped after the first part; the finished part is not computed again."""
    file, repeats = tmp_path / "atlas.npz", repeats_up_to(3, 3)
    progress: list[tuple[int, int]] = []

    def tell(*done_of_all: int) -> None:
        progress.append(done_of_all)

    with pytest.raises(CancelledError):
        build_atlas(ACRYLIC, repeats, file=file, progress=tell, cancelled=lambda: len(progress) > 1)
    assert progress == [(0, len(repeats)), (AT_ONCE, len(repeats))]
    assert len(list(parts_folder(file).glob("*.json"))) == 1
    assert not file.exists()

    computed: list[int] = []

    def counting(function: Callable[..., dict[str, object]], tasks: Any, **options: Any) -> object:
        def count(task: Any) -> dict[str, object]:
            computed.append(len(task.keys))
            return function(task)

        return run_batch(count, tasks, **options)

    monkeypatch.setattr("knitcore.design.atlas_build.run_batch", counting)
    resumed = build_atlas(ACRYLIC, repeats, file=file)
    assert sum(computed) == len(repeats) - AT_ONCE
    assert resumed.only(acrylic_atlas().keys).values == pytest.approx(
        acrylic_atlas().values, nan_ok=True
    )
    assert not parts_folder(file).exists()

    again = build_atlas(ACRYLIC, repeats, file=file)
    assert sum(computed) == len(repeats) - AT_ONCE
    assert again.keys == resumed.keys
    assert again.values == pytest.approx(resumed.values, rel=1e-6, nan_ok=True)
    assert again.provenance == resumed.provenance


def test_two_processes_make_the_same_atlas(tmp_path: Path) -> None:
    atlas = build_atlas(ACRYLIC, REPEATS, file=tmp_path / "a.npz", workers=2)
    assert atlas.keys == acrylic_atlas().keys
    assert np.array_equal(atlas.curves, acrylic_atlas().curves)


@given(place=st.floats(0, 0.999), byte=st.integers(0, 255), data=st.data())
def test_a_damaged_file_is_read_or_refused(
    tmp_path: Path, place: float, byte: int, data: st.DataObject
) -> None:
    file = tmp_path / "atlas.npz"
    save_atlas(acrylic_atlas(), file)
    content = bytearray(file.read_bytes())
    content[int(place * len(content))] = byte
    file.write_bytes(content[: data.draw(st.integers(0, len(content)))] if byte % 2 else content)
    with contextlib.suppress(InputError):
        assert len(load_atlas(file).values) == len(acrylic_atlas())


def test_an_atlas_of_other_laws_is_not_continued(tmp_path: Path) -> None:
    file = tmp_path / "atlas.npz"
    save_atlas(acrylic_atlas(), file)
    with pytest.raises(InputError, match="atlas of acrylic with other laws"):
        build_atlas(material("cotton"), REPEATS, file=file)


def test_an_atlas_of_an_older_version_is_built_again(tmp_path: Path) -> None:
    file = tmp_path / "atlas.npz"
    np.savez(file, format=np.array(FORMAT - 1), values=np.zeros((2, 3)))
    with pytest.raises(InputError, match="another version"):
        load_atlas(file)


@pytest.mark.parametrize("content", [b"", b"no archive", None])
def test_files_that_hold_no_atlas(tmp_path: Path, content: bytes | None) -> None:
    file = tmp_path / "atlas.npz"
    if content is None:
        np.savez(file, format=np.array(FORMAT), values=np.zeros((2, 3)))
    else:
        file.write_bytes(content)
    with pytest.raises(InputError, match="is not an atlas"):
        load_atlas(file)
