"""A method for every operation (made by scripts/client_code.py)."""

from __future__ import annotations

from typing import Any, Literal, TypeVar, Unpack, overload

from pydantic import BaseModel

from knitcore_client.models import (
    AtlasRequest,
    AtlasResult,
    BendingRequest,
    BendingResult,
    BendRequest,
    BendResult,
    BiasRequest,
    BiasResult,
    BiaxialRequest,
    BiaxialResult,
    BorderRequest,
    BorderResult,
    CalibrateRequest,
    CalibrateResult,
    CharacteriseRequest,
    CharacteriseResult,
    CompareRequest,
    CompareResult,
    CompressionRequest,
    CompressionResult,
    CurlRequest,
    CurlResult,
    CurveRequest,
    CurveResult,
    DesignSchema,
    DrapeRequest,
    DrapeResult,
    EstimateRequest,
    EstimateResult,
    ExportRequest,
    ExportResult,
    Extensions,
    FillRequest,
    FillResult,
    FindRequest,
    FindResult,
    FitRequest,
    FitResult,
    GarmentRequest,
    GarmentResult,
    GloveRequest,
    GloveResult,
    HangRequest,
    HangResult,
    HysteresisRequest,
    HysteresisResult,
    ImportRequest,
    ImportResult,
    JobResult,
    JobStatus,
    LimbRequest,
    LimbResult,
    MaterialDetail,
    MaterialRequest,
    Materials,
    ModelReport,
    OverhangRequest,
    OverhangResult,
    ParsedChart,
    ParseRequest,
    Patterns,
    PieceRequest,
    PieceResult,
    PredictRequest,
    PredictResult,
    PressureRequest,
    PressureResult,
    RelaxRequest,
    RelaxResult,
    RSRequest,
    RSResult,
    ShapeRequest,
    ShapeResult,
    StretchRequest,
    StretchResult,
    SweepRequest,
    SweepResult,
    TrellisRequest,
    TrellisResult,
    TubeRequest,
    TubeResult,
    VersionResult,
    WholeRequest,
    WholeResult,
)

Model = TypeVar("Model", bound=BaseModel)


class AsyncOperations:
    """Every operation of the service, as a method."""

    async def _ask(self, result: type[Model], method: str, path: str, request: Any) -> Model:
        raise NotImplementedError

    async def _submit(self, kind: str, request: Any) -> JobStatus:
        raise NotImplementedError

    async def _run(self, kind: str, request: Any) -> JobResult:
        raise NotImplementedError

    async def atlas(self, **request: Unpack[AtlasRequest]) -> AtlasResult:
        """Predicted constants of all small repeats of a material."""
        return await self._ask(AtlasResult, "POST", "/atlas", request)

    async def bend(self, **request: Unpack[BendRequest]) -> BendResult:
        """Bending, curl and shear of a repeat at the yarn level."""
        return await self._ask(BendResult, "POST", "/bend", request)

    async def bending(self, **request: Unpack[BendingRequest]) -> BendingResult:
        """Bending modulus from photos of hanging yarn."""
        return await self._ask(BendingResult, "POST", "/measure/bending", request)

    async def bias(self, **request: Unpack[BiasRequest]) -> BiasResult:
        """Pull a strip cut at an angle."""
        return await self._ask(BiasResult, "POST", "/bias", request)

    async def biaxial(self, **request: Unpack[BiaxialRequest]) -> BiaxialResult:
        """Pull a rectangle in both directions."""
        return await self._ask(BiaxialResult, "POST", "/biaxial", request)

    async def border(self, **request: Unpack[BorderRequest]) -> BorderResult:
        """How wide a border keeps a piece flat."""
        return await self._ask(BorderResult, "POST", "/border", request)

    async def calibrate(self, **request: Unpack[CalibrateRequest]) -> CalibrateResult:
        """Shear modulus and couplings from a displacement field."""
        return await self._ask(CalibrateResult, "POST", "/calibrate", request)

    async def compare(self, **request: Unpack[CompareRequest]) -> CompareResult:
        """A law compared with a measured displacement field."""
        return await self._ask(CompareResult, "POST", "/compare", request)

    async def compression(self, **request: Unpack[CompressionRequest]) -> CompressionResult:
        """Contact constants from compression tests."""
        return await self._ask(CompressionResult, "POST", "/measure/compression", request)

    async def curl(self, **request: Unpack[CurlRequest]) -> CurlResult:
        """How a piece curls and folds."""
        return await self._ask(CurlResult, "POST", "/curl", request)

    async def curve(self, **request: Unpack[CurveRequest]) -> CurveResult:
        """Stress-strain curve of a chart."""
        return await self._ask(CurveResult, "POST", "/curve", request)

    async def design_schema(self) -> DesignSchema:
        """JSON schema of the project file."""
        return await self._ask(DesignSchema, "GET", "/schemas/design", {})

    async def drape(self, **request: Unpack[DrapeRequest]) -> DrapeResult:
        """Drape coefficient: a round piece over a disc."""
        return await self._ask(DrapeResult, "POST", "/drape", request)

    async def estimate(self, **request: Unpack[EstimateRequest]) -> EstimateResult:
        """The four fabrics of a yarn that is not in the library."""
        return await self._ask(EstimateResult, "POST", "/estimate", request)

    async def estimate_report(self) -> ModelReport:
        """How well left-out yarns are predicted."""
        return await self._ask(ModelReport, "GET", "/estimate/report", {})

    async def export(self, **request: Unpack[ExportRequest]) -> ExportResult:
        """A chart as a file."""
        return await self._ask(ExportResult, "POST", "/export", request)

    async def extensions(self) -> Extensions:
        """What installed packages add."""
        return await self._ask(Extensions, "GET", "/extensions", {})

    async def fill(self, **request: Unpack[FillRequest]) -> FillResult:
        """A chart for a map of target stiffness."""
        return await self._ask(FillResult, "POST", "/fill", request)

    async def find(self, **request: Unpack[FindRequest]) -> FindResult:
        """Fabrics with target properties."""
        return await self._ask(FindResult, "POST", "/find", request)

    async def fit(self, **request: Unpack[FitRequest]) -> FitResult:
        """A law from two stretch tests."""
        return await self._ask(FitResult, "POST", "/fit", request)

    async def garment(self, **request: Unpack[GarmentRequest]) -> GarmentResult:
        """A garment from measurements."""
        return await self._ask(GarmentResult, "POST", "/garment", request)

    async def glove(self, **request: Unpack[GloveRequest]) -> GloveResult:
        """The glove on a hand."""
        return await self._ask(GloveResult, "POST", "/glove", request)

    async def hang(self, **request: Unpack[HangRequest]) -> HangResult:
        """How a piece hangs under its own weight."""
        return await self._ask(HangResult, "POST", "/hang", request)

    async def hysteresis(self, **request: Unpack[HysteresisRequest]) -> HysteresisResult:
        """Loading, unloading and rest sizes of a repeat with friction."""
        return await self._ask(HysteresisResult, "POST", "/hysteresis", request)

    async def import_(self, **request: Unpack[ImportRequest]) -> ImportResult:
        """The chart in a file."""
        return await self._ask(ImportResult, "POST", "/import", request)

    async def limb(self, **request: Unpack[LimbRequest]) -> LimbResult:
        """Fit and pressure of a knitted tube along a limb."""
        return await self._ask(LimbResult, "POST", "/limb", request)

    async def material(self, **request: Unpack[MaterialRequest]) -> MaterialDetail:
        """Everything known about a material."""
        return await self._ask(MaterialDetail, "GET", "/materials/{identifier}", request)

    async def materials(self) -> Materials:
        """The library of materials."""
        return await self._ask(Materials, "GET", "/materials", {})

    async def overhang(self, **request: Unpack[OverhangRequest]) -> OverhangResult:
        """Peirce's bending length: a strip over the edge of a table."""
        return await self._ask(OverhangResult, "POST", "/overhang", request)

    async def parse(self, **request: Unpack[ParseRequest]) -> ParsedChart:
        """Read a chart text and find its repeat."""
        return await self._ask(ParsedChart, "POST", "/charts/parse", request)

    async def patterns(self) -> Patterns:
        """Named patterns."""
        return await self._ask(Patterns, "GET", "/patterns", {})

    async def piece(self, **request: Unpack[PieceRequest]) -> PieceResult:
        """Load a piece of any outline at its edges."""
        return await self._ask(PieceResult, "POST", "/piece", request)

    async def predict(self, **request: Unpack[PredictRequest]) -> PredictResult:
        """Moduli and extensibility of a chart."""
        return await self._ask(PredictResult, "POST", "/predict", request)

    async def pressure(self, **request: Unpack[PressureRequest]) -> PressureResult:
        """Pressure of a knitted tube on a limb."""
        return await self._ask(PressureResult, "POST", "/pressure", request)

    async def relax(self, **request: Unpack[RelaxRequest]) -> RelaxResult:
        """Relax a repeat at the yarn level."""
        return await self._ask(RelaxResult, "POST", "/relax", request)

    async def rs(self, **request: Unpack[RSRequest]) -> RSResult:
        """Moduli from the shape of the yarn."""
        return await self._ask(RSResult, "GET", "/rs/{material}", request)

    async def shape(self, **request: Unpack[ShapeRequest]) -> ShapeResult:
        """A chart that takes a target outline when it is stretched."""
        return await self._ask(ShapeResult, "POST", "/shape", request)

    async def stretch(self, **request: Unpack[StretchRequest]) -> StretchResult:
        """Pull a chart between two clamps."""
        return await self._ask(StretchResult, "POST", "/stretch", request)

    async def sweep(self, **request: Unpack[SweepRequest]) -> SweepResult:
        """Stretch a repeat at the yarn level."""
        return await self._ask(SweepResult, "POST", "/sweep", request)

    async def trellis(self, **request: Unpack[TrellisRequest]) -> TrellisResult:
        """Shear a square in a hinged frame."""
        return await self._ask(TrellisResult, "POST", "/trellis", request)

    async def tube(self, **request: Unpack[TubeRequest]) -> TubeResult:
        """Relax a repeat in the round."""
        return await self._ask(TubeResult, "POST", "/tube", request)

    async def version(self) -> VersionResult:
        """The version of the service."""
        return await self._ask(VersionResult, "GET", "/version", {})

    @overload
    async def submit(
        self, kind: Literal["atlas"], **request: Unpack[AtlasRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["bend"], **request: Unpack[BendRequest]) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["bending"], **request: Unpack[BendingRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["bias"], **request: Unpack[BiasRequest]) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["biaxial"], **request: Unpack[BiaxialRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["border"], **request: Unpack[BorderRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["calibrate"], **request: Unpack[CalibrateRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["characterise"], **request: Unpack[CharacteriseRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["compare"], **request: Unpack[CompareRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["compression"], **request: Unpack[CompressionRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["curl"], **request: Unpack[CurlRequest]) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["curve"], **request: Unpack[CurveRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["drape"], **request: Unpack[DrapeRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["fill"], **request: Unpack[FillRequest]) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["find"], **request: Unpack[FindRequest]) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["fit"], **request: Unpack[FitRequest]) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["hang"], **request: Unpack[HangRequest]) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["hysteresis"], **request: Unpack[HysteresisRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["overhang"], **request: Unpack[OverhangRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["piece"], **request: Unpack[PieceRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["relax"], **request: Unpack[RelaxRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["shape"], **request: Unpack[ShapeRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["stretch"], **request: Unpack[StretchRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["sweep"], **request: Unpack[SweepRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["trellis"], **request: Unpack[TrellisRequest]
    ) -> JobStatus: ...
    @overload
    async def submit(self, kind: Literal["tube"], **request: Unpack[TubeRequest]) -> JobStatus: ...
    @overload
    async def submit(
        self, kind: Literal["whole"], **request: Unpack[WholeRequest]
    ) -> JobStatus: ...

    async def submit(self, kind: Any, **request: Any) -> JobStatus:
        """Run an operation in the background."""
        return await self._submit(kind, request)

    @overload
    async def run(self, kind: Literal["atlas"], **request: Unpack[AtlasRequest]) -> AtlasResult: ...
    @overload
    async def run(self, kind: Literal["bend"], **request: Unpack[BendRequest]) -> BendResult: ...
    @overload
    async def run(
        self, kind: Literal["bending"], **request: Unpack[BendingRequest]
    ) -> BendingResult: ...
    @overload
    async def run(self, kind: Literal["bias"], **request: Unpack[BiasRequest]) -> BiasResult: ...
    @overload
    async def run(
        self, kind: Literal["biaxial"], **request: Unpack[BiaxialRequest]
    ) -> BiaxialResult: ...
    @overload
    async def run(
        self, kind: Literal["border"], **request: Unpack[BorderRequest]
    ) -> BorderResult: ...
    @overload
    async def run(
        self, kind: Literal["calibrate"], **request: Unpack[CalibrateRequest]
    ) -> CalibrateResult: ...
    @overload
    async def run(
        self, kind: Literal["characterise"], **request: Unpack[CharacteriseRequest]
    ) -> CharacteriseResult: ...
    @overload
    async def run(
        self, kind: Literal["compare"], **request: Unpack[CompareRequest]
    ) -> CompareResult: ...
    @overload
    async def run(
        self, kind: Literal["compression"], **request: Unpack[CompressionRequest]
    ) -> CompressionResult: ...
    @overload
    async def run(self, kind: Literal["curl"], **request: Unpack[CurlRequest]) -> CurlResult: ...
    @overload
    async def run(self, kind: Literal["curve"], **request: Unpack[CurveRequest]) -> CurveResult: ...
    @overload
    async def run(self, kind: Literal["drape"], **request: Unpack[DrapeRequest]) -> DrapeResult: ...
    @overload
    async def run(self, kind: Literal["fill"], **request: Unpack[FillRequest]) -> FillResult: ...
    @overload
    async def run(self, kind: Literal["find"], **request: Unpack[FindRequest]) -> FindResult: ...
    @overload
    async def run(self, kind: Literal["fit"], **request: Unpack[FitRequest]) -> FitResult: ...
    @overload
    async def run(self, kind: Literal["hang"], **request: Unpack[HangRequest]) -> HangResult: ...
    @overload
    async def run(
        self, kind: Literal["hysteresis"], **request: Unpack[HysteresisRequest]
    ) -> HysteresisResult: ...
    @overload
    async def run(
        self, kind: Literal["overhang"], **request: Unpack[OverhangRequest]
    ) -> OverhangResult: ...
    @overload
    async def run(self, kind: Literal["piece"], **request: Unpack[PieceRequest]) -> PieceResult: ...
    @overload
    async def run(self, kind: Literal["relax"], **request: Unpack[RelaxRequest]) -> RelaxResult: ...
    @overload
    async def run(self, kind: Literal["shape"], **request: Unpack[ShapeRequest]) -> ShapeResult: ...
    @overload
    async def run(
        self, kind: Literal["stretch"], **request: Unpack[StretchRequest]
    ) -> StretchResult: ...
    @overload
    async def run(self, kind: Literal["sweep"], **request: Unpack[SweepRequest]) -> SweepResult: ...
    @overload
    async def run(
        self, kind: Literal["trellis"], **request: Unpack[TrellisRequest]
    ) -> TrellisResult: ...
    @overload
    async def run(self, kind: Literal["tube"], **request: Unpack[TubeRequest]) -> TubeResult: ...
    @overload
    async def run(self, kind: Literal["whole"], **request: Unpack[WholeRequest]) -> WholeResult: ...

    async def run(self, kind: Any, **request: Any) -> JobResult:
        """The result of an operation that runs in the background; given up, it is cancelled."""
        return await self._run(kind, request)


class Operations:
    """Every operation of the service, as a method."""

    def _ask(self, result: type[Model], method: str, path: str, request: Any) -> Model:
        raise NotImplementedError

    def _submit(self, kind: str, request: Any) -> JobStatus:
        raise NotImplementedError

    def _run(self, kind: str, request: Any) -> JobResult:
        raise NotImplementedError

    def atlas(self, **request: Unpack[AtlasRequest]) -> AtlasResult:
        """Predicted constants of all small repeats of a material."""
        return self._ask(AtlasResult, "POST", "/atlas", request)

    def bend(self, **request: Unpack[BendRequest]) -> BendResult:
        """Bending, curl and shear of a repeat at the yarn level."""
        return self._ask(BendResult, "POST", "/bend", request)

    def bending(self, **request: Unpack[BendingRequest]) -> BendingResult:
        """Bending modulus from photos of hanging yarn."""
        return self._ask(BendingResult, "POST", "/measure/bending", request)

    def bias(self, **request: Unpack[BiasRequest]) -> BiasResult:
        """Pull a strip cut at an angle."""
        return self._ask(BiasResult, "POST", "/bias", request)

    def biaxial(self, **request: Unpack[BiaxialRequest]) -> BiaxialResult:
        """Pull a rectangle in both directions."""
        return self._ask(BiaxialResult, "POST", "/biaxial", request)

    def border(self, **request: Unpack[BorderRequest]) -> BorderResult:
        """How wide a border keeps a piece flat."""
        return self._ask(BorderResult, "POST", "/border", request)

    def calibrate(self, **request: Unpack[CalibrateRequest]) -> CalibrateResult:
        """Shear modulus and couplings from a displacement field."""
        return self._ask(CalibrateResult, "POST", "/calibrate", request)

    def compare(self, **request: Unpack[CompareRequest]) -> CompareResult:
        """A law compared with a measured displacement field."""
        return self._ask(CompareResult, "POST", "/compare", request)

    def compression(self, **request: Unpack[CompressionRequest]) -> CompressionResult:
        """Contact constants from compression tests."""
        return self._ask(CompressionResult, "POST", "/measure/compression", request)

    def curl(self, **request: Unpack[CurlRequest]) -> CurlResult:
        """How a piece curls and folds."""
        return self._ask(CurlResult, "POST", "/curl", request)

    def curve(self, **request: Unpack[CurveRequest]) -> CurveResult:
        """Stress-strain curve of a chart."""
        return self._ask(CurveResult, "POST", "/curve", request)

    def design_schema(self) -> DesignSchema:
        """JSON schema of the project file."""
        return self._ask(DesignSchema, "GET", "/schemas/design", {})

    def drape(self, **request: Unpack[DrapeRequest]) -> DrapeResult:
        """Drape coefficient: a round piece over a disc."""
        return self._ask(DrapeResult, "POST", "/drape", request)

    def estimate(self, **request: Unpack[EstimateRequest]) -> EstimateResult:
        """The four fabrics of a yarn that is not in the library."""
        return self._ask(EstimateResult, "POST", "/estimate", request)

    def estimate_report(self) -> ModelReport:
        """How well left-out yarns are predicted."""
        return self._ask(ModelReport, "GET", "/estimate/report", {})

    def export(self, **request: Unpack[ExportRequest]) -> ExportResult:
        """A chart as a file."""
        return self._ask(ExportResult, "POST", "/export", request)

    def extensions(self) -> Extensions:
        """What installed packages add."""
        return self._ask(Extensions, "GET", "/extensions", {})

    def fill(self, **request: Unpack[FillRequest]) -> FillResult:
        """A chart for a map of target stiffness."""
        return self._ask(FillResult, "POST", "/fill", request)

    def find(self, **request: Unpack[FindRequest]) -> FindResult:
        """Fabrics with target properties."""
        return self._ask(FindResult, "POST", "/find", request)

    def fit(self, **request: Unpack[FitRequest]) -> FitResult:
        """A law from two stretch tests."""
        return self._ask(FitResult, "POST", "/fit", request)

    def garment(self, **request: Unpack[GarmentRequest]) -> GarmentResult:
        """A garment from measurements."""
        return self._ask(GarmentResult, "POST", "/garment", request)

    def glove(self, **request: Unpack[GloveRequest]) -> GloveResult:
        """The glove on a hand."""
        return self._ask(GloveResult, "POST", "/glove", request)

    def hang(self, **request: Unpack[HangRequest]) -> HangResult:
        """How a piece hangs under its own weight."""
        return self._ask(HangResult, "POST", "/hang", request)

    def hysteresis(self, **request: Unpack[HysteresisRequest]) -> HysteresisResult:
        """Loading, unloading and rest sizes of a repeat with friction."""
        return self._ask(HysteresisResult, "POST", "/hysteresis", request)

    def import_(self, **request: Unpack[ImportRequest]) -> ImportResult:
        """The chart in a file."""
        return self._ask(ImportResult, "POST", "/import", request)

    def limb(self, **request: Unpack[LimbRequest]) -> LimbResult:
        """Fit and pressure of a knitted tube along a limb."""
        return self._ask(LimbResult, "POST", "/limb", request)

    def material(self, **request: Unpack[MaterialRequest]) -> MaterialDetail:
        """Everything known about a material."""
        return self._ask(MaterialDetail, "GET", "/materials/{identifier}", request)

    def materials(self) -> Materials:
        """The library of materials."""
        return self._ask(Materials, "GET", "/materials", {})

    def overhang(self, **request: Unpack[OverhangRequest]) -> OverhangResult:
        """Peirce's bending length: a strip over the edge of a table."""
        return self._ask(OverhangResult, "POST", "/overhang", request)

    def parse(self, **request: Unpack[ParseRequest]) -> ParsedChart:
        """Read a chart text and find its repeat."""
        return self._ask(ParsedChart, "POST", "/charts/parse", request)

    def patterns(self) -> Patterns:
        """Named patterns."""
        return self._ask(Patterns, "GET", "/patterns", {})

    def piece(self, **request: Unpack[PieceRequest]) -> PieceResult:
        """Load a piece of any outline at its edges."""
        return self._ask(PieceResult, "POST", "/piece", request)

    def predict(self, **request: Unpack[PredictRequest]) -> PredictResult:
        """Moduli and extensibility of a chart."""
        return self._ask(PredictResult, "POST", "/predict", request)

    def pressure(self, **request: Unpack[PressureRequest]) -> PressureResult:
        """Pressure of a knitted tube on a limb."""
        return self._ask(PressureResult, "POST", "/pressure", request)

    def relax(self, **request: Unpack[RelaxRequest]) -> RelaxResult:
        """Relax a repeat at the yarn level."""
        return self._ask(RelaxResult, "POST", "/relax", request)

    def rs(self, **request: Unpack[RSRequest]) -> RSResult:
        """Moduli from the shape of the yarn."""
        return self._ask(RSResult, "GET", "/rs/{material}", request)

    def shape(self, **request: Unpack[ShapeRequest]) -> ShapeResult:
        """A chart that takes a target outline when it is stretched."""
        return self._ask(ShapeResult, "POST", "/shape", request)

    def stretch(self, **request: Unpack[StretchRequest]) -> StretchResult:
        """Pull a chart between two clamps."""
        return self._ask(StretchResult, "POST", "/stretch", request)

    def sweep(self, **request: Unpack[SweepRequest]) -> SweepResult:
        """Stretch a repeat at the yarn level."""
        return self._ask(SweepResult, "POST", "/sweep", request)

    def trellis(self, **request: Unpack[TrellisRequest]) -> TrellisResult:
        """Shear a square in a hinged frame."""
        return self._ask(TrellisResult, "POST", "/trellis", request)

    def tube(self, **request: Unpack[TubeRequest]) -> TubeResult:
        """Relax a repeat in the round."""
        return self._ask(TubeResult, "POST", "/tube", request)

    def version(self) -> VersionResult:
        """The version of the service."""
        return self._ask(VersionResult, "GET", "/version", {})

    @overload
    def submit(self, kind: Literal["atlas"], **request: Unpack[AtlasRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["bend"], **request: Unpack[BendRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["bending"], **request: Unpack[BendingRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["bias"], **request: Unpack[BiasRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["biaxial"], **request: Unpack[BiaxialRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["border"], **request: Unpack[BorderRequest]) -> JobStatus: ...
    @overload
    def submit(
        self, kind: Literal["calibrate"], **request: Unpack[CalibrateRequest]
    ) -> JobStatus: ...
    @overload
    def submit(
        self, kind: Literal["characterise"], **request: Unpack[CharacteriseRequest]
    ) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["compare"], **request: Unpack[CompareRequest]) -> JobStatus: ...
    @overload
    def submit(
        self, kind: Literal["compression"], **request: Unpack[CompressionRequest]
    ) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["curl"], **request: Unpack[CurlRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["curve"], **request: Unpack[CurveRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["drape"], **request: Unpack[DrapeRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["fill"], **request: Unpack[FillRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["find"], **request: Unpack[FindRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["fit"], **request: Unpack[FitRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["hang"], **request: Unpack[HangRequest]) -> JobStatus: ...
    @overload
    def submit(
        self, kind: Literal["hysteresis"], **request: Unpack[HysteresisRequest]
    ) -> JobStatus: ...
    @overload
    def submit(
        self, kind: Literal["overhang"], **request: Unpack[OverhangRequest]
    ) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["piece"], **request: Unpack[PieceRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["relax"], **request: Unpack[RelaxRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["shape"], **request: Unpack[ShapeRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["stretch"], **request: Unpack[StretchRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["sweep"], **request: Unpack[SweepRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["trellis"], **request: Unpack[TrellisRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["tube"], **request: Unpack[TubeRequest]) -> JobStatus: ...
    @overload
    def submit(self, kind: Literal["whole"], **request: Unpack[WholeRequest]) -> JobStatus: ...

    def submit(self, kind: Any, **request: Any) -> JobStatus:
        """Run an operation in the background."""
        return self._submit(kind, request)

    @overload
    def run(self, kind: Literal["atlas"], **request: Unpack[AtlasRequest]) -> AtlasResult: ...
    @overload
    def run(self, kind: Literal["bend"], **request: Unpack[BendRequest]) -> BendResult: ...
    @overload
    def run(self, kind: Literal["bending"], **request: Unpack[BendingRequest]) -> BendingResult: ...
    @overload
    def run(self, kind: Literal["bias"], **request: Unpack[BiasRequest]) -> BiasResult: ...
    @overload
    def run(self, kind: Literal["biaxial"], **request: Unpack[BiaxialRequest]) -> BiaxialResult: ...
    @overload
    def run(self, kind: Literal["border"], **request: Unpack[BorderRequest]) -> BorderResult: ...
    @overload
    def run(
        self, kind: Literal["calibrate"], **request: Unpack[CalibrateRequest]
    ) -> CalibrateResult: ...
    @overload
    def run(
        self, kind: Literal["characterise"], **request: Unpack[CharacteriseRequest]
    ) -> CharacteriseResult: ...
    @overload
    def run(self, kind: Literal["compare"], **request: Unpack[CompareRequest]) -> CompareResult: ...
    @overload
    def run(
        self, kind: Literal["compression"], **request: Unpack[CompressionRequest]
    ) -> CompressionResult: ...
    @overload
    def run(self, kind: Literal["curl"], **request: Unpack[CurlRequest]) -> CurlResult: ...
    @overload
    def run(self, kind: Literal["curve"], **request: Unpack[CurveRequest]) -> CurveResult: ...
    @overload
    def run(self, kind: Literal["drape"], **request: Unpack[DrapeRequest]) -> DrapeResult: ...
    @overload
    def run(self, kind: Literal["fill"], **request: Unpack[FillRequest]) -> FillResult: ...
    @overload
    def run(self, kind: Literal["find"], **request: Unpack[FindRequest]) -> FindResult: ...
    @overload
    def run(self, kind: Literal["fit"], **request: Unpack[FitRequest]) -> FitResult: ...
    @overload
    def run(self, kind: Literal["hang"], **request: Unpack[HangRequest]) -> HangResult: ...
    @overload
    def run(
        self, kind: Literal["hysteresis"], **request: Unpack[HysteresisRequest]
    ) -> HysteresisResult: ...
    @overload
    def run(
        self, kind: Literal["overhang"], **request: Unpack[OverhangRequest]
    ) -> OverhangResult: ...
    @overload
    def run(self, kind: Literal["piece"], **request: Unpack[PieceRequest]) -> PieceResult: ...
    @overload
    def run(self, kind: Literal["relax"], **request: Unpack[RelaxRequest]) -> RelaxResult: ...
    @overload
    def run(self, kind: Literal["shape"], **request: Unpack[ShapeRequest]) -> ShapeResult: ...
    @overload
    def run(self, kind: Literal["stretch"], **request: Unpack[StretchRequest]) -> StretchResult: ...
    @overload
    def run(self, kind: Literal["sweep"], **request: Unpack[SweepRequest]) -> SweepResult: ...
    @overload
    def run(self, kind: Literal["trellis"], **request: Unpack[TrellisRequest]) -> TrellisResult: ...
    @overload
    def run(self, kind: Literal["tube"], **request: Unpack[TubeRequest]) -> TubeResult: ...
    @overload
    def run(self, kind: Literal["whole"], **request: Unpack[WholeRequest]) -> WholeResult: ...

    def run(self, kind: Any, **request: Any) -> JobResult:
        """The result of an operation that runs in the background; given up, it is cancelled."""
        return self._run(kind, request)
