"""Law files that also say which sheet model they were calibrated for."""

from __future__ import annotations

import json
from pathlib import Path

from knitcore.errors import InputError
from knitcore.formats.law_files import LawFile, load_law, save_law
from knitcore.swatch.models import EnergyModel, SheetModel

KEY = "sheet_model"


def save_calibrated(file: LawFile, model: SheetModel, path: Path) -> None:
    """Write a law file (see :mod:`knitcore.formats.law_files`) with ``sheet_model`` added."""
    save_law(file, path)
    data = json.loads(path.read_text(encoding="utf-8"))
    data[KEY] = {
        "energy": model.energy.value,
        "stiffening_coupling": model.stiffening_coupling,
        "tension_field": model.tension_field,
    }
    path.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


def load_calibrated(path: Path) -> tuple[LawFile, SheetModel]:
    """A law and the model it was calibrated for (plain ``full`` if the file does not say).

    Raises
    ------
    InputError
        If the file holds no sound law or model.
    """
    file = load_law(path)
    stored = json.loads(path.read_text(encoding="utf-8")).get(KEY, {})
    try:
        return file, SheetModel(
            EnergyModel(stored.get("energy", EnergyModel.FULL.value)),
            stiffening_coupling=float(stored.get("stiffening_coupling", 0.0)),
            tension_field=bool(stored.get("tension_field", False)),
        )
    except (AttributeError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"law.{KEY}", f"cannot be used ({error}).", "Leave it out or write it by `calibrate`."
        ) from error
