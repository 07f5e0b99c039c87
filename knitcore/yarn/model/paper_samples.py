"""The eight samples of the paper's simulations, with figures as printed and as used."""

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.chart.result import Result
from knitcore.yarn.model.yarn_model import YarnModel


@dataclass(frozen=True)
class Parameter:
    """One number of the paper's Supplementary Table 7.

    Parameters
    ----------
    name : a field of :class:`YarnModel`, or ``loop_length_mm``.
    printed : as in the table.
    used : the value to compute with, in the unit that ``name`` states.
    configured : the value in the authors' public configuration file where there is one (acrylic).
    reason : why ``used`` differs from ``printed``; empty if it does not.
    """

    name: str
    printed: float
    used: float
    configured: float | None
    reason: str


@dataclass(frozen=True)
class Sample(Result):
    """One knitted sample as the paper simulated it.

    Parameters
    ----------
    yarn_id : ``acrylic`` or ``cotton``.
    fabric : the fabric.
    yarn : its yarn; the core radius was tuned by the authors for each sample.
    loop_length_mm : length of yarn in a stitch, mm.
    energy_n_mm : published energy of a stitch at zero force, N·mm (Supplementary Table 8, whose
        printed unit J must be mJ).
    contact_share, bending_share : published shares of that energy.
    parameters : every number with its printed value and the reason of a correction.
    """

    yarn_id: str
    fabric: Fabric
    yarn: YarnModel
    loop_length_mm: float
    energy_n_mm: float
    contact_share: float
    bending_share: float
    parameters: tuple[Parameter, ...]


def _rows(name: str) -> list[dict[str, str]]:
    path = files("knitcore.yarn.model") / "data" / name
    with path.open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@cache
def load_samples() -> tuple[Sample, ...]:
    """The eight samples, acrylic first, in the order of the paper's table."""
    parameters: dict[tuple[str, str], list[Parameter]] = {}
    for row in _rows("samples.csv"):
        printed, used = float(row["printed"]), float(row["used"])
        configured = float(row["configured"]) if row["configured"] else None
        entry = Parameter(row["quantity"], printed, used, configured, row["reason"])
        parameters.setdefault((row["yarn"], row["fabric"]), []).append(entry)
    samples = []
    for row in _rows("energies.csv"):
        entries = parameters[row["yarn"], row["fabric"]]
        values = {p.name: p.used for p in entries}
        loop_length_mm = values.pop("loop_length_mm")
        energy, contact, bending = (
            float(row[name]) for name in ("energy_n_mm", "contact_share", "bending_share")
        )
        yarn, fabric = YarnModel(**values), Fabric(row["fabric"])
        samples.append(
            Sample(
                row["yarn"], fabric, yarn, loop_length_mm, energy, contact, bending, tuple(entries)
            )
        )
    return tuple(samples)


def sample(yarn_id: str, fabric: Fabric | str) -> Sample:
    """The sample of a yarn and a fabric.

    Raises
    ------
    InputError
        If the paper did not simulate it.

    Examples
    --------
    >>> sample("cotton", "rib").loop_length_mm
    17.94
    """
    kind = Fabric.parse(fabric)
    for entry in load_samples():
        if (entry.yarn_id, entry.fabric) == (yarn_id, kind):
            return entry
    raise InputError(
        "yarn",
        f"The paper has no contact data of {yarn_id!r}.",
        "Use acrylic or cotton, or give a yarn of your own.",
    )
