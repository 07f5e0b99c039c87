"""Files with one constitutive law (``LAW.json``).

::

    {"format": "knitcore-law", "version": 1, "source": "fitted, recommended reduction",
     "law": {"stiffness_xxxx": 0.23, …, "beta_yy": 0.02, "shear_modulus": 0.01},
     "standard_errors": {"stiffness_xxxx": 0.006, …}, "largest_strain": {"course": 0.55, …},
     "curves": {"course": {"strain": […], "stress_n_per_mm": […], "pulls": 4}, …}}

Only ``law`` is needed; the constants may also stand at the top, with or without their unit
(``stiffness_xxxx_n_per_mm``), so that the output of ``knitcore fit --json`` is such a file too.
"""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.fabric import Direction
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.material_document import CurveDocument, LawDocument
from knitcore.materials.measured_curves import MeasuredCurve

FORMAT = "knitcore-law"
MAX_BYTES = 10_000_000
_GIVE = "Give a LAW.json that `knitcore fit` wrote."
_UNIT = "_n_per_mm"


@dataclass(frozen=True)
class LawFile:
    """A law and its provenance.

    Attributes
    ----------
    law : the constants.
    source : where they come from, in words.
    standard_errors : by the law's field names, where known.
    largest_strain : strain that the tests reached, by direction, where known.
    curves : median curves of the tests, by direction, where known.
    """

    law: ConstitutiveLaw
    source: str = ""
    standard_errors: Mapping[str, float] = field(default_factory=dict)
    largest_strain: Mapping[Direction, float] = field(default_factory=dict)
    curves: Mapping[Direction, MeasuredCurve] = field(default_factory=dict)


def save_law(file: LawFile, path: Path) -> None:
    """Write a law."""
    data = {
        "format": FORMAT,
        "version": 1,
        "source": file.source,
        "law": asdict(file.law),
        "standard_errors": dict(file.standard_errors),
        "largest_strain": {str(d): e for d, e in file.largest_strain.items()},
        "curves": {str(d): asdict(curve) for d, curve in file.curves.items()},
    }
    Path(path).write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


@in_reading_time
def load_law(path: Path) -> LawFile:
    """Read a law.

    Raises
    ------
    InputError
        If the file is missing, is not JSON, or does not hold a valid law.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError("law", f"{path} is not a file.", _GIVE)
    if path.stat().st_size > MAX_BYTES:
        raise InputError("law", f"{path.name} is too large for a law.", _GIVE)
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError):
        raise InputError("law", f"{path.name} is not JSON.", _GIVE) from None
    if not isinstance(data, dict):
        raise InputError("law", f"{path.name} does not hold an object.", _GIVE)
    return law_from_mapping(data)


def law_from_mapping(data: Mapping[str, Any]) -> LawFile:
    """A law from the content of such a file.

    Raises
    ------
    InputError
        Naming the first constant that cannot be used.
    """
    nested = data.get("law", data)
    constants = _plain(nested if isinstance(nested, Mapping) else {})
    try:
        curves = _Curves.model_validate({"curves": data.get("curves", {})})
        document = LawDocument.model_validate(
            {k: v for k, v in constants.items() if k in ConstitutiveLaw.__dataclass_fields__}
        )
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        if where.startswith("curves"):
            remedy = "Give curves as `knitcore fit --out` writes them, or leave them out."
            raise InputError(where, f"{first['msg']}.", remedy) from None
        raise InputError(
            f"law.{where}" if where else "law",
            f"{first['msg']}.",
            "Give stiffness_xxxx, stiffness_yyyy, stiffness_xxyy, stiffness_yyxx, alpha_xx,"
            " alpha_yy, beta_xx and beta_yy.",
        ) from None
    return LawFile(
        law=document.to_law(),
        source=str(data.get("source", "")),
        standard_errors=_floats(_plain(data.get("standard_errors"))),
        largest_strain={
            Direction(k): v
            for k, v in _floats(data.get("largest_strain")).items()
            if k in set(Direction)
        },
        curves={d: curve.to_curve() for d, curve in curves.curves.items()},
    )


class _Curves(BaseModel):
    curves: dict[Direction, CurveDocument]


def _plain(data: Any) -> dict[str, Any]:
    """Constants by their names without units."""
    if not isinstance(data, Mapping):
        return {}
    return {str(key).removesuffix(_UNIT): value for key, value in data.items()}


def _floats(data: Any) -> dict[str, float]:
    if not isinstance(data, Mapping):
        return {}
    return {str(k): float(v) for k, v in data.items() if isinstance(v, int | float)}
