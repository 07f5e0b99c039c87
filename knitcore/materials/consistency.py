"""Laws that agree with all figures printed for them, and the check that figures agree.

The paper prints the stiffnesses C, the Young's moduli Y and the Poisson ratios to three decimals.
They are related (Note 7): nu_yx = C_yyxx / C_yyyy, nu_xy = C_xxyy / C_xxxx and
Y = (1 - nu_xy nu_yx) C. Where C is small its rounding is coarse: for acrylic rib C_xxxx = 0.011 and
Y_x = 0.010 are printed, 3 % off the printed ratios. The law takes the ratios as printed,
C = Y / (1 - nu_xy nu_yx) as far as the printed C's rounding allows, and the couplings nu C. So
every Young's modulus stays within 1 % of its printed value, and every stiffness on the diagonal
rounds to the printed one.
"""

from collections.abc import Mapping

from knitcore.base.errors import InputError
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.printed_figures import Figure

MODULUS_TOLERANCE = 0.01
"""Largest relative deviation of a law's Young's moduli from those stated for it."""

POISSON_TOLERANCE = 0.002
"""Largest deviation of a law's Poisson ratios from those stated for it."""

LINEAR_QUANTITIES = ("C_xxxx", "C_yyyy", "C_xxyy", "C_yyxx", "Y_x", "Y_y", "nu_yx", "nu_xy")
STIFFENING_QUANTITIES = ("alpha_xx", "alpha_yy", "beta_xx", "beta_yy")
LAW_QUANTITIES = LINEAR_QUANTITIES + STIFFENING_QUANTITIES


def consistent_law(figures: Mapping[str, Figure]) -> ConstitutiveLaw:
    """The law behind one row of the paper's constitutive tables.

    Parameters
    ----------
    figures : the row's twelve figures by quantity (:data:`LAW_QUANTITIES`).

    Raises
    ------
    InputError
        If the figures contradict each other or the stiffness is not positive definite.
    """
    nu_yx, nu_xy = figures["nu_yx"].corrected, figures["nu_xy"].corrected
    stiffness_xxxx = _diagonal(figures["Y_x"], figures["C_xxxx"], 1 - nu_xy * nu_yx)
    stiffness_yyyy = _diagonal(figures["Y_y"], figures["C_yyyy"], 1 - nu_xy * nu_yx)
    law = ConstitutiveLaw(
        stiffness_xxxx=stiffness_xxxx,
        stiffness_yyyy=stiffness_yyyy,
        stiffness_xxyy=nu_xy * stiffness_xxxx,
        stiffness_yyxx=nu_yx * stiffness_yyyy,
        alpha_xx=figures["alpha_xx"].corrected,
        alpha_yy=figures["alpha_yy"].corrected,
        beta_xx=figures["beta_xx"].corrected,
        beta_yy=figures["beta_yy"].corrected,
    )
    moduli = {"modulus_course": figures["Y_x"].corrected, "modulus_wale": figures["Y_y"].corrected}
    check_stated_constants(law, moduli | {"poisson_yx": nu_yx, "poisson_xy": nu_xy})
    for name, coupling in (("C_xxyy", law.stiffness_xxyy), ("C_yyxx", law.stiffness_yyxx)):
        figure = figures[name]
        # A coupling is a product of two rounded figures, so its own rounding is not enough.
        if abs(coupling - figure.corrected) > max(2 * figure.half_unit, 0.02 * figure.corrected):
            raise InputError(
                name,
                f"{figure.corrected} contradicts its Poisson ratio, which gives {coupling:.4f}.",
                "Correct the one that is wrong.",
            )
    return law


def check_stated_constants(law: ConstitutiveLaw, stated: Mapping[str, float | None]) -> None:
    """Refuse a law whose moduli or Poisson ratios differ from those stated with it by name.

    Raises
    ------
    InputError
        Naming the constant, its stated value and the law's.
    """
    for name, value in stated.items():
        if value is None:
            continue
        actual: float = getattr(law, name)
        is_ratio = name.startswith("poisson")
        off, allowed = (
            (actual - value, POISSON_TOLERANCE)
            if is_ratio
            else (actual / value - 1, MODULUS_TOLERANCE)
        )
        if abs(off) > allowed:
            problem = f"{value:g} is stated, but the stiffnesses give {actual:.4g}."
            raise InputError(name, problem, _RELATIONS)


_RELATIONS = "nu_yx = C_yyxx/C_yyyy, nu_xy = C_xxyy/C_xxxx and Y = (1 - nu_xy nu_yx) C must hold."


def _diagonal(modulus: Figure, stiffness: Figure, factor: float) -> float:
    low = stiffness.corrected - stiffness.half_unit
    high = stiffness.corrected + stiffness.half_unit
    return min(max(modulus.corrected / factor, low), high)
