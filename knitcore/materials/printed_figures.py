"""The paper's tables as packaged data: each figure as printed, as used, and why they differ."""

import csv
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType

from knitcore.base.errors import InputError


@dataclass(frozen=True)
class Figure:
    """One figure of a table in the paper's supplement.

    Attributes
    ----------
    table : number of the supplementary table.
    material, variant, fabric, direction : that it is for; empty where it does not apply. The
        empty variant is the experiment.
    quantity, unit : ``C_xxxx``, ``Y_x``, ``nu_yx``, ``loop_length`` … and its unit in the table.
    printed : the figure as printed, as text, so that its rounding is known.
    corrected : the value to use.
    standard_deviation : the printed ±, if there is one.
    reason : why the corrected value (or unit) differs from the print; empty if it does not.
    """

    table: int
    material: str
    variant: str
    fabric: str
    direction: str
    quantity: str
    unit: str
    printed: str
    corrected: float
    standard_deviation: float | None
    reason: str

    @property
    def half_unit(self) -> float:
        """Half a unit of the last printed digit."""
        _, _, decimals = self.printed.partition(".")
        return 0.5 * 10.0 ** -len(decimals)


class FigureTable:
    """The packaged figures, looked up by material, fabric, direction and quantity."""

    def __init__(self, figures: tuple[Figure, ...]) -> None:
        self._figures = figures
        self._by_key = {
            (f.material, f.variant, f.fabric, f.direction, f.quantity): f for f in figures
        }

    def __iter__(self) -> Iterator[Figure]:
        return iter(self._figures)

    def __len__(self) -> int:
        return len(self._figures)

    def find(
        self,
        material: str,
        quantity: str,
        *,
        variant: str = "",
        fabric: str = "",
        direction: str = "",
    ) -> Figure | None:
        """The figure of that description, or None if no table has it."""
        return self._by_key.get((material, variant, fabric, direction, quantity))

    def get(self, material: str, quantity: str, **place: str) -> Figure:
        """The figure of that description, placed as in :meth:`find`.

        Raises
        ------
        InputError
            If no table of the paper has it.
        """
        figure = self.find(material, quantity, **place)
        if figure is None:
            what = " ".join(word for word in (material, *place.values()) if word)
            raise InputError(
                "quantity", f"the paper has no {quantity} for {what}.", "Look at paper_figures()."
            )
        return figure

    def errata(self) -> tuple[Figure, ...]:
        """The figures that are not used as printed, or not in the printed unit."""
        return tuple(f for f in self._figures if f.reason)


@cache
def paper_figures() -> FigureTable:
    """Every figure of the paper's tables 1-20 that this package uses.

    Examples
    --------
    >>> paper_figures().get("acrylic", "Y_x", fabric="garter").corrected
    0.223
    >>> figure = paper_figures().get("lace-blue-mohair", "Y_y", fabric="garter")
    >>> figure.printed, figure.corrected, figure.reason
    ('0.100', 0.045, '(1 - nu_xy nu_yx) C_yyyy')
    """
    return FigureTable(tuple(_figure(row) for row in read_packaged("figures.csv")))


@cache
def read_packaged(name: str) -> tuple[Mapping[str, str], ...]:
    """Rows of a packaged CSV file."""
    text = files("knitcore.materials").joinpath("data", name).read_text(encoding="utf-8")
    return tuple(MappingProxyType(row) for row in csv.DictReader(text.splitlines()))


def _figure(row: Mapping[str, str]) -> Figure:
    texts = ("material", "variant", "fabric", "direction", "quantity", "unit", "printed", "reason")
    return Figure(
        table=int(row["table"]),
        corrected=float(row["corrected"]),
        standard_deviation=float(row["sd"]) if row["sd"] else None,
        **{name: row[name] for name in texts},
    )
