"""Laws of the paper's yarns refitted clamp to clamp, as packaged data (``data/refitted.csv``).

The paper takes strain between the middle of the sample and the lower clamp; from clamp to clamp it
is smaller. Acrylic's four fabrics are refitted from the authors' raw tests. Cotton, pulled on the
same rig, is converted by the ratio found there. The lace and glove yarns were pulled on a testing
machine, clamp to clamp: their laws stay. ``scripts/refit_laws.py`` writes the file;
``docs/fit-a-law.md`` gives the errors.
"""

from collections.abc import Mapping
from dataclasses import fields, replace
from functools import cache
from types import MappingProxyType

from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.law_uncertainty import CurveUncertainty, LawUncertainty
from knitcore.materials.material import FabricRecord, Origin
from knitcore.materials.printed_figures import read_packaged

CONSTANTS = tuple(field.name for field in fields(ConstitutiveLaw))
CURVE = tuple(field.name for field in fields(CurveUncertainty))
DEVIATIONS = ("log_modulus_course", "log_modulus_wale", "poisson_yx", "poisson_xy", "log_shear")
COLUMNS = (
    "material",
    "variant",
    "fabric",
    *CONSTANTS,
    *DEVIATIONS,
    *(f"{name}_{direction}" for direction in ("course", "wale") for name in CURVE),
    "source",
)


def refitted(record: FabricRecord) -> FabricRecord:
    """A measured record of the paper with its refitted law; other records unchanged."""
    if record.origin is not Origin.MEASURED or "C_xxxx" not in record.printed:
        return record
    figure = record.printed["C_xxxx"]
    row = _rows()[figure.material, figure.variant, record.fabric]
    deviations = {name: float(row[name]) for name in DEVIATIONS}
    course, wale = (
        CurveUncertainty(**{name: float(row[f"{name}_{direction}"]) for name in CURVE})
        for direction in ("course", "wale")
    )
    return replace(
        record,
        law=ConstitutiveLaw(**{name: float(row[name]) for name in CONSTANTS}),
        law_source=row["source"],
        inconsistent=frozenset(),  # the printed figures, on which this law does not rest
        uncertainty=LawUncertainty(
            **deviations, source=row["source"], curve_course=course, curve_wale=wale
        ),
    )


@cache
def _rows() -> Mapping[tuple[str, str, str], Mapping[str, str]]:
    rows = read_packaged("refitted.csv")
    return MappingProxyType({(r["material"], r["variant"], r["fabric"]): r for r in rows})
