import json
from pathlib import Path

import pytest

from knitcore import InputError
from knitcore.machine.profile import DEFAULT, Dialect, MachineProfile, profile, profiles

NUMBERS = {"least": 0, "most": 9, "default": 6}
EACH = pytest.mark.parametrize("machine", profiles().values(), ids=list(profiles()))


@EACH
def test_a_profile_is_read_back_as_it_was_written(machine: MachineProfile) -> None:
    assert MachineProfile.read(machine.to_json()) == machine


@EACH
def test_every_figure_has_a_source(machine: MachineProfile) -> None:
    assert all(machine.source(name) for name in machine.to_dict())
    assert set(machine.sources) <= {"", *machine.to_dict()}


@EACH
def test_a_profile_stands_in_a_file_of_its_name(machine: MachineProfile) -> None:
    data = Path(__file__).parents[3] / "knitcore" / "machine" / "data"
    assert MachineProfile.read((data / f"{machine.identifier}.json").read_bytes()) == machine


def test_the_machines_differ_in_what_programs_depend_on() -> None:
    shima, kniterate = profile(DEFAULT), profile("kniterate")
    assert (shima.needles, shima.carriers.count, shima.carriers.hooks) == (540, 10, True)
    assert (kniterate.needles, kniterate.carriers.count, kniterate.carriers.hooks) == (
        252,
        6,
        False,
    )
    assert (kniterate.carriers.waste, kniterate.carriers.draw) == (1, 2)
    assert not kniterate.tuck_with_knit
    assert profile("v-bed-half-gauge").columns == 200
    assert profile("ayab").pitch_mm == pytest.approx(4.5, abs=0.01)
    assert profile("brother").racking.most_needles == 0
    assert {machine.dialect for machine in profiles().values()} == set(Dialect)


def test_an_unknown_machine_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(InputError, match=r"'stoll' is not a machine.*kniterate"):
        profile("stoll")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"needles": 0}, "needles: Input should be greater than or equal to 1"),
        ({"needels": 4}, "needels: Unexpected keyword argument"),
        ({"beds": 3}, "beds: Input should be 1 or 2"),
        ({"carriers": {"count": 4, "waste": 5}}, r"^carriers.waste: there is no carrier 5"),
        ({"carriers": {"count": 0}}, r"carriers.count: Input should be"),
        ({"racking": {"most_needles": float("nan")}}, r"racking.most_needles: Input should be"),
        ({"stitch_number": NUMBERS | {"default": 10}}, r"^stitch_number.default: 10 is outside 0"),
        ({"stitch_number": NUMBERS | {"waste": 40}}, r"^stitch_number.waste: 40 is outside 0"),
        (
            {"stitch_number": NUMBERS | {"transfer": 2.5}},
            r"stitch_number.transfer: 2.5 is no whole",
        ),
        (
            {"racking": {"most_needles": 2, "step_needles": 5}},
            r"^racking.step_needles: a step of 5",
        ),
        ({"carriers": {"count": 6, "hooks": True}}, r"^carriers.hooks: the dialect kniterate"),
        ({"beds": 1}, "^beds: without a hook, programs begin with waste yarn on two beds"),
        ({"sources": {}}, "sources: Dictionary should have at least 1 item"),
        ({"identifier": "My machine"}, "identifier: String should match"),
        ({"version": 2}, "version: Input should be 1"),
    ],
)
def test_a_profile_that_cannot_be_used_is_refused_by_field(
    change: dict[str, object], says: str
) -> None:
    data = json.loads(profile("kniterate").to_json()) | change
    with pytest.raises(InputError, match=says):
        MachineProfile.read(json.dumps(data))


@pytest.mark.parametrize("content", [b"", b"\xff", b"[]", b"{}", b" " * 200_000])
def test_what_is_no_profile_is_refused(content: bytes) -> None:
    with pytest.raises(InputError):
        MachineProfile.read(content)
