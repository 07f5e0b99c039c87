"""Laws in results."""

from __future__ import annotations

from pydantic import Field

from app.models.base import ResultModel


class LawResult(ResultModel):
    """The nine constants of a constitutive law."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float
    shear_modulus_n_per_mm: float = Field(description="An assumption unless it was calibrated.")
