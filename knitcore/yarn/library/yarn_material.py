"""A characterised yarn as a material, usable like any other."""

from knitcore.base.errors import InputError
from knitcore.materials.law_uncertainty import MODEL_POISSON_SD, YARN_LEVEL_LOG_SD, LawUncertainty
from knitcore.materials.material import FabricRecord, Material, Origin, Yarn
from knitcore.yarn.library.yarn_table import YarnRow, YarnTable


def material_of(table: YarnTable, setting: str | None = None) -> Material:
    """The material of a characterised yarn at one setting.

    Its laws are simulated, so predictions from it are labelled ``yarn level``.

    Parameters
    ----------
    setting : name of one of the plan's settings; the reference if left out.

    Raises
    ------
    InputError
        If there is no such setting, or no fabric has a law at this setting.
    """
    plan = table.plan
    names = [entry.name for entry in plan.settings]
    chosen = names[plan.reference] if setting is None else setting
    if chosen not in names:
        raise InputError("setting", f"there is no {chosen!r}.", f"Use {', '.join(names)}.")
    rows = table.at(chosen)
    fabrics = {fabric: _record(row) for fabric, row in rows.items() if row.law is not None}
    if not fabrics:
        reasons = "; ".join(
            f"{f}: {r.failure or r.document['law_failure']}" for f, r in rows.items()
        )
        raise InputError(
            "loop_lengths", f"no fabric has a law at {chosen} ({reasons}).", "Use other lengths."
        )
    left_out = [f"{f} (no law at this setting)" for f in rows if f not in fabrics]
    first = next(iter(rows.values())).yarn
    top = min(rows[f].document["law_range"]["max_stress_n_per_mm"] for f in fabrics)
    note = (
        f"Simulated at the yarn level ({plan.branch} branch, {plan.convention} convention, without "
        f"friction or set); laws hold from 0 to {top:.3g} N/mm. Yarn: "
        f"{plan.provenance}."
    )
    if left_out:
        note += f" Missing: {', '.join(left_out)}."
    return Material(
        identifier=plan.identifier,
        name=f"{plan.name}, {chosen}",
        yarn=Yarn(
            bending_modulus_n_mm2=first.bending_modulus_n_mm2,
            compression_stiffness_n_per_mm3=first.contact_stiffness_n_per_mm3,
            compression_exponent=first.contact_exponent,
            diameter_mm=2.0 * first.radius_mm,
        ),
        fabrics=fabrics,
        note=note,
    )


def _record(row: YarnRow) -> FabricRecord:
    law = row.law
    assert law is not None  # noqa: S101 - the caller has looked
    return FabricRecord(
        fabric=row.fabric,
        law=law,
        stitch_course_mm=row.document["cell_course_mm"],
        stitch_wale_mm=row.document["cell_wale_mm"],
        stitch_size_source="yarn level",
        uncertainty=LawUncertainty(
            YARN_LEVEL_LOG_SD, YARN_LEVEL_LOG_SD, MODEL_POISSON_SD, MODEL_POISSON_SD,
            source="of the yarn level against measured fabrics",
        ),
        origin=Origin.SIMULATED,
        loop_length_mm=row.loop_length_mm,
        yarn_diameter_mm=2.0 * row.yarn.radius_mm,
        setting=row.setting,
    )  # fmt: skip
