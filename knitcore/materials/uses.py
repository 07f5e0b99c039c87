"""Uses that a yarn's data serve for, and what is missing for the others."""

from dataclasses import dataclass

from knitcore.base.choice import Choice
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials.law_uncertainty import log_deviation
from knitcore.materials.material import Material

ROUGH_LOG_STRESS = 0.25
"""Standard deviation of the logarithm of a stress beyond which sizes under load are rough: 90 %
intervals of a factor of 1.5."""
ROUGH_LOG_BENDING = 0.25
"""Standard deviation of the logarithm of a bending modulus beyond which it is rough."""


class Serves(Choice):
    """How well a yarn serves for a use."""

    YES = "yes"
    ROUGHLY = "roughly"
    NO = "no"


@dataclass(frozen=True)
class Suitability:
    """A use, and how well a yarn serves for it.

    Attributes
    ----------
    name : of the use.
    serves : how well.
    missing : what would make it serve, or serve better; empty where nothing is.
    """

    name: str
    serves: Serves
    missing: str = ""


def uses_of(material: Material) -> tuple[Suitability, ...]:
    """The uses that the page and the library have for a yarn, the commonest first."""
    return (_any_chart(material), *_under_load(material), _amount(material), _yarn_level(material))


def _any_chart(material: Material) -> Suitability:
    name = "charts on the page, which mix fabrics"
    lacking = [fabric.value for fabric in Fabric if fabric not in material.fabrics]
    if lacking:
        missing = f"laws of {', '.join(lacking)}: let them be estimated, or test them"
        return Suitability(name, Serves.NO, missing)
    worst = max(material.fabrics, key=lambda fabric: max(_errors(material, fabric)))
    if max(_errors(material, worst)) <= ROUGH_LOG_STRESS:
        return Suitability(name, Serves.YES)
    return Suitability(name, Serves.ROUGHLY, f"a swatch of {worst}, hung or tested")


def _under_load(material: Material) -> list[Suitability]:
    """Sizes of fabrics, together where they are rough in the same directions."""
    groups: dict[tuple[Direction, ...], list[str]] = {}
    for fabric in material.fabrics:
        errors = _errors(material, fabric)
        rough = tuple(d for d in Direction if errors[d.axis] > ROUGH_LOG_STRESS)
        groups.setdefault(rough, []).append(fabric.value)
    uses = []
    for rough, fabrics in groups.items():
        name = f"sizes of {', '.join(fabrics)} under load: garments, tubes, pressure"
        ways = " and ".join(f"{direction}-wise" for direction in rough)
        swatch = "its swatch" if len(fabrics) == 1 else "a swatch of each"
        missing = f"photos or tests of {swatch}, pulled {ways}"
        uses.append(
            Suitability(name, Serves.ROUGHLY, missing) if rough else Suitability(name, Serves.YES)
        )
    return uses


def _amount(material: Material) -> Suitability:
    name = "amount of yarn, and weight (with the tex of the ball band)"
    serves, missing = _loops(material)
    return Suitability(name, serves, missing)


def _loops(material: Material) -> tuple[Serves, str]:
    """Yarn in a stitch: one fabric's says roughly what the others have."""
    lacking = [f.value for f, r in material.fabrics.items() if r.loop_length_mm is None]
    if not lacking:
        return Serves.YES, ""
    serves = Serves.NO if len(lacking) == len(material.fabrics) else Serves.ROUGHLY
    return serves, f"yarn in a stitch of {', '.join(lacking)}: unravel ten"


def _yarn_level(material: Material) -> Suitability:
    name = "curl, drape and yarn simulations"
    yarn = material.yarn
    missing = []
    if yarn.bending_modulus_n_mm2 is None:
        missing.append("the bending stiffness: photos of hanging yarn")
    loops, unravel = _loops(material)
    if loops is Serves.NO:
        missing.append(unravel)
    if missing:
        return Suitability(name, Serves.NO, "; ".join(missing))
    deviation = log_deviation(
        yarn.bending_modulus_n_mm2 or 1.0, yarn.bending_modulus_sd_n_mm2 or 0.0
    )
    if deviation > ROUGH_LOG_BENDING:
        return Suitability(name, Serves.ROUGHLY, "the bending stiffness: photos of hanging yarn")
    if yarn.compression_stiffness_n_per_mm3 is None:
        return Suitability(name, Serves.ROUGHLY, "a squeezing test of the yarn")
    return Suitability(name, loops, unravel)


def _errors(material: Material, fabric: Fabric) -> tuple[float, float]:
    """Standard deviations of the logarithm of the stress in use, course-wise and wale-wise."""
    uncertainty = material.record(fabric).uncertainty
    course, wale = (uncertainty.curve(direction).log_stress for direction in Direction)
    return course, wale
