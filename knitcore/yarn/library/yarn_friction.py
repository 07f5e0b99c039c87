"""Coefficient of friction between yarns: measured, or by fibre.

The yarns of the library were not measured. Listed are static and kinetic coefficients of fibre on
fibre (Röder 1953, in Morton and Hearle, Physical Properties of Textile Fibres, 4th ed., chapter
25). The default is the kinetic one, which a slow pull meets most of the time; the interval goes up
to the static one and down to half the kinetic one, as knitting yarns are waxed.
"""

from __future__ import annotations

from dataclasses import dataclass

from knitcore.materials import Material

SOURCE = (
    "fibre on fibre, kinetic, up to static and down to half for waxed yarn (Röder 1953, in Morton "
    "and Hearle, Physical Properties of Textile Fibres, chapter 25); not measured on this yarn"
)

_STATIC_AND_KINETIC = {
    "cotton": (0.51, 0.26),
    "nylon": (0.47, 0.40),
    "polyamide": (0.47, 0.40),
    "polyester": (0.15, 0.12),
    "viscose": (0.35, 0.26),
    "rayon": (0.35, 0.26),
    "bamboo": (0.35, 0.26),
    # with and against the scales, which point both ways in a yarn
    "wool": (0.37, 0.25),
    "mohair": (0.37, 0.25),
    "cashmere": (0.37, 0.25),
    "alpaca": (0.37, 0.25),
}
_UNLISTED = (0.51, 0.26)
"""Of fibres that are not listed, such as acrylic: as cotton, the widest of the common ones."""


@dataclass(frozen=True)
class YarnFriction:
    """Friction between yarns of a material.

    Attributes
    ----------
    coefficient, low, high : default and interval.
    source : where they come from, in one sentence.
    """

    coefficient: float
    low: float
    high: float
    source: str


def yarn_friction(of: Material) -> YarnFriction:
    """The coefficient of friction of a material's yarn: its own, or by the first fibre it names.

    A coefficient that is given without an interval is taken as exact.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> yarn_friction(material("cotton")).coefficient
    0.26
    """
    own = of.yarn
    if own.friction is not None:
        ends = own.friction_interval or (own.friction, own.friction)
        return YarnFriction(own.friction, *ends, "given with the material")
    fibre = own.fibre.lower()
    named = [(fibre.find(name), name) for name in _STATIC_AND_KINETIC if name in fibre]
    static, kinetic = _STATIC_AND_KINETIC[min(named)[1]] if named else _UNLISTED
    unlisted = "" if named else "as cotton, since the fibre is not listed: "
    return YarnFriction(kinetic, 0.5 * kinetic, static, unlisted + SOURCE)
