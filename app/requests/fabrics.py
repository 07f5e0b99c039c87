"""Fabrics in requests and results: a chart of a material, its laws and its gauge."""

from dataclasses import replace
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import Laws, Material, load_library
from knitcore.prediction.size import KnownBy, RelaxedSize

from ..context import Context
from .base import UNIT, Ends, RequestModel, ResultModel
from .charts import AnyChartInput, ChartInput, MaterialName, to_chart, to_stitches


class LawsRequest(RequestModel):
    """A request about materials, with a choice of the laws of the paper's yarns.

    The choice becomes part of the materials' names, so that nothing else depends on it.
    """

    laws: Laws | None = Field(
        None,
        description="Laws of library yarns: refitted clamp to clamp (default), or as published.",
    )

    @model_validator(mode="after")
    def _name_laws(self) -> Self:
        if self.laws is not None:
            for field in ("material", "materials"):
                given = getattr(self, field, None)
                if isinstance(given, str):
                    setattr(self, field, self._named(given))
                elif given:
                    setattr(self, field, [self._named(name) for name in given])
        return self

    def _named(self, material: str) -> str:
        """A material's name with the laws chosen; files and own materials have one law only."""
        yarn = material.strip().lower().partition(":")[0]
        if self.laws is None or yarn not in load_library():
            if self.laws is Laws.PUBLISHED:
                raise ValueError(
                    f"{material} has one law only; omit laws, or choose a yarn of the library."
                )
            return material
        return self.laws.of(material)


class FabricRequest(LawsRequest):
    """A chart of a material."""

    chart: ChartInput
    material: MaterialName

    def fabric(self, context: Context) -> tuple[StitchChart, Material]:
        """Look up the chart and the material that the request names."""
        return to_chart(self.chart), context.material(self.material)


Count = Annotated[
    float,
    Field(
        gt=0,
        le=1000,
        description="Counted on your own relaxed swatch; give stitches and rows, or neither.",
    ),
]


YarnPerStitch = Annotated[float | None, Field(gt=0, le=1000)]


class GaugeInput(RequestModel):
    """The gauge of a chart: counted on your own relaxed cloth, or from a relaxation."""

    stitches_per_10_cm: Count
    rows_per_10_cm: Count
    log_sd: float = Field(
        RelaxedSize.log_sd,
        ge=0.001,
        le=1,
        description="Uncertainty of both numbers: standard deviation of their logarithms.",
    )
    known_by: KnownBy = Field(
        KnownBy.GAUGE, description="`relaxation` for the `gauge` in the result of `relax`."
    )

    def relaxed_size(self) -> RelaxedSize:
        """The relaxed size of one stitch."""
        size = RelaxedSize.from_gauge(self.stitches_per_10_cm, self.rows_per_10_cm)
        return replace(size, log_sd=self.log_sd, known_by=self.known_by)


class RelaxedGauge(ResultModel):
    """The gauge that a relaxation found; other requests take it as it is."""

    stitches_per_10_cm: float
    rows_per_10_cm: float
    log_sd: float
    known_by: KnownBy


class Gauged(RequestModel):
    """A part of every request about a chart whose gauge may have been counted."""

    gauge: GaugeInput | None = Field(
        None, description="Measured gauge of the chart; its relaxed size is estimated if left out."
    )

    @property
    def relaxed_size(self) -> RelaxedSize | None:
        """The relaxed size of one stitch, if the gauge was measured."""
        return self.gauge.relaxed_size() if self.gauge else None


class GaugedRequest(Gauged, FabricRequest):
    """A chart of a material, and how somebody knits it."""


class Moduli(ResultModel):
    """Young's moduli along rows and along columns."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float


class ElasticConstants(Moduli):
    """Moduli and Poisson ratios."""

    poisson_yx: float = Field(description="Contraction wale-wise when pulled course-wise.")
    poisson_xy: float = Field(description="Contraction course-wise when pulled wale-wise.")


class Extensibility(ResultModel):
    """Extensibility, the inverse of the moduli."""

    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float


class HandStretchResult(ResultModel):
    """Stretch along one direction at one pull."""

    strain: float = Field(description="From the size at rest, the other direction free.")
    strain_interval: Ends
    word: Literal["firm", "slightly stretchy", "stretchy", "very stretchy"]
    more_than: list[Fabric] = Field(description="Pure fabrics of this yarn that stretch less.")
    less_than: list[Fabric] = Field(description="Pure fabrics of this yarn that stretch more.")


class HandPullResult(ResultModel):
    """Stretch at one pull of a hand."""

    pull: Literal["light", "hand", "firm"]
    n_per_mm: float = Field(description="Force per width of cloth: 0.1 N/mm is 10 N on 10 cm.")
    course: HandStretchResult
    wale: HandStretchResult


class LawConstants(ResultModel):
    """The constants of stress and strain in the plane."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float


class LawResult(LawConstants):
    """The constants of a constitutive law."""

    shear_modulus_n_per_mm: float = Field(
        description="Shear modulus; an assumption unless it was fitted or calibrated."
    )
    kappa_xx: float = Field(description="Coupling: share of the strain across in the stiffening.")
    kappa_yy: float
    shear_stiffening: float = Field(
        0.0, description="Growth of the shear stiffness with the angle squared, 1/rad²."
    )


def law_fields(law: ConstitutiveLaw, *models: type[ResultModel]) -> dict[str, float]:
    """Return the constants of a law that models have fields for, under these fields' names."""
    names = (name for model in models for name in model.model_fields)
    return {name: getattr(law, name.removesuffix(UNIT)) for name in names}


class StitchesRequest(GaugedRequest):
    """A chart of any stitches, of a material, and how somebody knits it."""

    chart: AnyChartInput

    def stitches(self, context: Context) -> tuple[StitchChart | SymbolChart, Material]:
        """Look up the chart and the material that the request names."""
        return to_stitches(self.chart), context.material(self.material)
