"""Requests and answers of the service (made by scripts/client_code.py)."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal, NotRequired, TypedDict

from pydantic import AwareDatetime, BaseModel, RootModel

VERSION = "0.1.0"
"""Of the program that it was made from."""

Branch = Literal["published", "mirrored", "free"]

CameraSide = Literal["face", "back", "edge", "angle"]

Clamps = Literal["clamped", "sliding"]

Colour = Literal[
    "yarn",
    "region",
    "fabric",
    "phase",
    "course",
    "wale",
    "anisotropy",
    "strain",
    "utilisation",
    "pressure",
    "field",
]

Construction = Literal["flat", "round"]

Convention = Literal["published", "paper", "authors-code"]

Direction = Literal["course", "wale"]

Edges = Literal["measured", "rigid"]

EnergyModel = Literal["published", "full"]

ExportKind = Literal[
    "knitout",
    "knitspeak",
    "png",
    "svg",
    "pdf",
    "pattern",
    "pattern-svg",
    "report",
    "text",
    "written",
    "design",
    "glb",
    "stl",
    "vtu",
    "csv",
]

Fabric = Literal["stockinette", "garter", "rib", "seed"]

Finish = Literal["waste", "bind-off"]

History = Literal["agitated", "as-knitted", "stretched-course", "stretched-wale"]

HungBy = Literal["edge", "corners"]

KnownBy = Literal["gauge", "relaxation"]

Laws = Literal["refitted", "published"]

Quantity = Literal[
    "modulus_course_n_per_mm",
    "modulus_wale_n_per_mm",
    "extensibility_course_mm_per_n",
    "extensibility_wale_mm_per_n",
    "anisotropy",
    "poisson_yx",
    "poisson_xy",
    "stretch_course",
    "stretch_wale",
    "pressure_course_mmhg",
    "pressure_wale_mmhg",
]

RectangleGroups = Literal["stitch", "block", "region"]

Reduction = Literal["published", "uniform", "recommended"]

ShareMode = Literal["read", "copy"]

Side = Literal["RS", "WS"]

Curl = Literal["flat", "front", "back"]

Group = Literal[
    "knitcore.patterns", "knitcore.materials", "knitcore.exporters", "knitcore.measures"
]

JobState = Literal["waiting", "running", "done", "failed", "cancelled", "interrupted"]

Origin = Literal["measured", "simulated", "fitted", "estimated"]

Parity = Literal["even", "odd"]


class AtlasRequest(TypedDict):
    """The atlas to compute."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    repeats: NotRequired[Literal["small", "all"]]
    """small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of two fabrics."""


class BendRequest(TypedDict):
    """A repeat and its yarn."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    loop_length_mm: NotRequired[float | None]
    """Yarn per stitch; the material's by default."""
    linear_density_g_per_m: NotRequired[float | None]
    """Of the yarn; needed for the bending lengths."""


class BendingRequest(TypedDict):
    """Photos of hanging yarn, with the lengths and weight needed to read them."""

    images: list[UploadedFile | Path]
    linear_density_g_per_m: float
    """Mass per length: weigh some metres; 0.5 g/m is 500 tex."""
    length_mm: NotRequired[list[float] | float | None]
    """Hanging length, clamp to free end; one for all photos or one per photo."""
    px_per_mm: NotRequired[float | None]
    """Scale, if it is known."""


class BiasRequest(TypedDict):
    """A strip and how far it is pulled."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    steps: NotRequired[int]
    """Steps of the load."""
    shear_modulus_n_per_mm: NotRequired[float | None]
    """C_xyxy; that of the laws by default."""
    mesh_mm: NotRequired[float | None]
    """Length of an element's side; by default there are about 600 elements."""
    strain: float
    """Last clamp-to-clamp strain: 0.5 is 50 %."""
    width_mm: NotRequired[float]
    """Distance between the free sides."""
    length_mm: NotRequired[float]
    """Distance between the clamps."""
    angle_deg: NotRequired[float]
    """Angle from the width to the rows: 0 pulls along columns, 90 along rows."""


class BiaxialRequest(TypedDict):
    """A rectangle and how far its edges are pulled."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    steps: NotRequired[int]
    """Steps of the load."""
    shear_modulus_n_per_mm: NotRequired[float | None]
    """C_xyxy; that of the laws by default."""
    mesh_mm: NotRequired[float | None]
    """Length of an element's side; by default there are about 600 elements."""
    strain_x: float
    """Last strain along x."""
    strain_y: float
    """Last strain along y."""
    width_mm: NotRequired[float]
    """Along x."""
    length_mm: NotRequired[float]
    """Along y."""
    grain_deg: NotRequired[float]
    """Angle from the x axis to the rows."""


class BorderRequest(TypedDict):
    """A piece and the fabric of its border."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    linear_density_g_per_m: float
    """Of the yarn, g/m: weigh some metres; tex divided by 1000."""
    chart: str | PureFabricChart
    border: NotRequired[Fabric]
    """Fabric of the border."""


class BoxInput(TypedDict):
    """Some stitches: rows ``row0`` (the bottom row is 0) to ``row1 - 1``, columns likewise."""

    row0: int
    column0: int
    row1: int
    column1: int


class CalibrateRequest(TypedDict):
    """The law to start from, and tests whose forces the law has to match."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    field: UploadedFile | Path
    """.npz: displacement (frames, 2, rows, columns), frame."""
    direction: Direction
    """Direction in which the fabric was pulled."""
    frames: NotRequired[list[int] | None]
    """Frames to use; all by default."""
    material: str
    """Identifier of a material of the library."""
    fabric: Fabric
    tests: NotRequired[list[UploadedFile | Path]]
    """Stretch tests: of the direction (forces), or course and wale (forces and start)."""


class CameraRequest(TypedDict):
    """From where to look."""

    side: CameraSide


class CharacteriseRequest(TypedDict):
    """A yarn, of a material or by its parameters."""

    fabrics: NotRequired[list[Fabric]]
    loop_lengths_mm: NotRequired[list[float]]
    """Yarn per stitch, for all fabrics; `tensions` is not used then."""
    tensions: NotRequired[list[float]]
    """Loop lengths as parts of the material's own."""
    branch: NotRequired[Branch]
    convention: NotRequired[Convention]
    max_stress_n_per_mm: NotRequired[float]
    """Largest stress of the fitted laws."""
    material: NotRequired[str | None]
    yarn: NotRequired[YarnInput | None]


class CompareRequest(TypedDict):
    """A law, or a fabric of a material, and a field to compare it with."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    field: UploadedFile | Path
    """.npz: displacement (frames, 2, rows, columns), frame."""
    direction: Direction
    """Direction in which the fabric was pulled."""
    frames: NotRequired[list[int] | None]
    """Frames to use; all by default."""
    material: NotRequired[str | None]
    fabric: NotRequired[Fabric | None]
    """A fabric of the material."""
    law: NotRequired[UploadedFile | Path | None]
    """A law file, LAW.json, in place of material and fabric."""
    edges: NotRequired[Edges]
    model: NotRequired[EnergyModel]


class CompressionRequest(TypedDict):
    """Compression tests of yarns."""

    file: UploadedFile | Path
    yarn: NotRequired[str | None]
    """Use only the samples of this yarn (sheets named yarn-number)."""
    diameter_mm: NotRequired[float | None]
    """Diameter of the yarn, if the file does not state it."""
    probe_width_mm: NotRequired[float]


class CurlRequest(TypedDict):
    """A whole piece whose edges are free, all or beside two clamps."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out."""
    pull: NotRequired[PullInput | None]
    """By clamps, whose free sides curl."""
    after: NotRequired[str | None]
    """Id of a shape of as many stitches, such as that before a stitch was changed: the
    calculation begins there, and its first shapes come sooner. Has no effect if the service has
    forgotten it, or with another size."""
    corners: NotRequired[bool]
    """Also return the corners of all stitches."""
    time_limit_s: NotRequired[float]
    """CPU time after which the current shape is returned, not converged."""


class Curled(TypedDict):
    """The shape of a piece that was computed before."""

    id: str
    """The id that `curl`, `hang`, `limb` or `glove` returned."""


class CurveRequest(TypedDict):
    """A chart, a direction and the stresses to ask for."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    gauge: NotRequired[GaugeInput | None]
    """Measured gauge of the chart; its relaxed size is estimated if left out."""
    direction: Direction
    """Along rows, or along columns."""
    stress_n_per_mm: NotRequired[list[float]]
    """Increasing."""


class DesignDocument(BaseModel):
    """A design as a file holds it; ``knitcore`` reads the same on the command line."""

    outline: str | None = None
    """Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out."""
    regions: list[DesignRegion] = []
    repeats: list[DesignRepeat] = []
    shelf: list[ShelfPattern] = []
    format: Literal["knitcore-design"] = "knitcore-design"
    version: Literal[2] = 2
    name: str
    material: str
    chart: str
    """K/P lines, the top row first, as seen from the face; or separated by /."""
    note: str = ""


class DesignPatch(TypedDict):
    """Fields to change; the others stay."""

    name: NotRequired[str | None]
    material: NotRequired[str | None]
    note: NotRequired[str | None]


class DesignRegion(BaseModel):
    """A part of the chart with a fill or a yarn of its own; later regions lie on top."""

    id: str
    name: str
    colour: str
    yarn: str | None = None
    """Intarsia yarn; None leaves the yarn beneath."""
    fill: str | None = None
    """Repeat that fills it, counted from the chart's corner."""
    runs: list[tuple[int, int, int]]
    """[row, column, length] of adjacent stitches; row 0 is the bottom."""
    locked: bool = False
    hidden: bool = False


class DesignRepeat(BaseModel):
    """A motif whose placements all follow it; "multiple of n + m" has m ``edge_columns``."""

    id: str
    name: str
    motif: str
    """A repeat; its rows from the top, separated by /."""
    edge_columns: int = 0
    edge_rows: int = 0
    placements: list[Placement] = []


class DrapeRequest(TypedDict):
    """A fabric, and the sizes of the test."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    linear_density_g_per_m: float
    """Of the yarn, g/m: weigh some metres; tex divided by 1000."""
    chart: str | PureFabricChart
    piece_mm: NotRequired[float]
    """Diameter of the round piece."""
    disc_mm: NotRequired[float]
    """Diameter of the disc."""
    across: NotRequired[int]
    """Rectangles of the sheet across the piece."""
    corners: NotRequired[bool]
    """Also return the corners of the sheet."""


class EstimateRequest(TypedDict):
    """What is known of the yarn and the product."""

    bending_modulus_n_mm2: float
    """B of the yarn (`measure bending`)."""
    product_setting: NotRequired[str]
    """Needle or stitch setting of the product."""
    loop_length_mm: float | dict[Fabric, float]
    """Yarn per stitch."""
    swatches: NotRequired[list[SwatchInput]]


class ExportRequest(TypedDict):
    """A chart and the format to write it in."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out."""
    regions: NotRequired[list[DesignRegion]]
    repeats: NotRequired[list[DesignRepeat]]
    shelf: NotRequired[list[ShelfPattern]]
    chart: str | PureFabricChart
    to: ExportKind | str
    """knitout, knitspeak, png, svg, pdf, pattern, pattern-svg, report, text, written, design,
    glb, stl, vtu, csv; or a format of an installed extension."""
    material: NotRequired[str]
    """Gives sizes and values."""
    construction: NotRequired[Construction]
    first_side: NotRequired[Side]
    """The side of row 1, in flat knitting."""
    finish: NotRequired[Finish]
    """The end of a knitout program."""
    gauge: NotRequired[GaugeInput | None]
    """Known gauge of the chart; its relaxed size is estimated if left out."""
    name: NotRequired[str]
    note: NotRequired[str]
    """Printed."""
    linear_density_tex: NotRequired[float | None]
    """Linear density of the yarn, for its mass."""
    photo: NotRequired[str | None]
    """PNG picture of the cloth, base64, for the first page of a pattern."""


class FieldColours(TypedDict):
    """Any value of each stitch on a colour map."""

    values: list[float]
    """Row by row from the bottom, each from the left."""
    low: float
    high: float
    log: NotRequired[bool]
    map: NotRequired[Literal["batlow", "vik"]]


class FillRequest(TypedDict):
    """Wanted moduli, stitch by stitch or part by part."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    modulus_course_n_per_mm: NotRequired[list[list[float | None]] | None]
    """[row][column], the bottom row first; null where any value will do."""
    modulus_wale_n_per_mm: NotRequired[list[list[float | None]] | None]
    rows: NotRequired[int | None]
    """Of the chart, if wishes are given."""
    columns: NotRequired[int | None]
    wishes: NotRequired[list[WishInput] | None]
    """In place of the two maps."""
    chart: NotRequired[str | None]
    """K/P lines, the top row first: stitches without a target stay as in this chart; otherwise
    they are filled."""
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out."""
    repeats: NotRequired[Literal["small", "all"]]
    smallest_patch: NotRequired[int]
    """Smallest side of a patch, where its part is not smaller."""
    scattered: NotRequired[bool]
    """Single stitches may be turned over where that comes nearer; otherwise every patch is a
    repeat, or stripes of two."""
    seed: NotRequired[int]
    """The same seed gives the same chart."""
    check: NotRequired[bool]
    """Pull the chart in the finite swatch; choose again where the result differs."""


class FindRequest(TypedDict):
    """Target properties, and the yarns to search."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    materials: list[str]
    targets: list[TargetInput]
    limits: NotRequired[LimitsInput | None]
    repeats: NotRequired[Literal["small", "all"]]
    """small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of two fabrics."""
    count: NotRequired[int]
    elsewhere: NotRequired[bool]
    """Search the other yarns too if nothing meets the targets."""


class FingerSize(TypedDict):
    """Measurements of one finger."""

    length_mm: float
    circumference_mm: float


class FitRequest(TypedDict):
    """Two stretch tests of one fabric."""

    test_course: UploadedFile | Path
    """Pulled along the rows; HDF5, CSV or XLSX."""
    test_wale: UploadedFile | Path
    """Pulled along the columns."""
    format: NotRequired[Literal["csv", "h5"] | None]
    """Recognised from the content if not given."""
    reduction: NotRequired[Reduction]
    """recommended: force and waist of the simulated test, clamp to clamp; uniform: clamp to
    clamp, as if the cloth strained evenly; published: as in the paper."""
    width_course_mm: NotRequired[float | None]
    """Clamped width, in place of the course-wise test's."""
    width_wale_mm: NotRequired[float | None]
    """The same, wale-wise."""
    residuals: NotRequired[bool]
    """Whether to return residuals at each point."""


class Focus(TypedDict):
    """A stitch."""

    row: int
    """From 0, the bottom row."""
    column: int
    """From 0, at the left."""


class GarmentRequest(TypedDict):
    """A template with measurements, and the yarn."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    gauge: NotRequired[GaugeCount | None]
    """The knitter's gauge; the material's by default."""
    garment: WristBrace | SockLeg | Limb | Glove
    linear_density_tex: NotRequired[float | None]
    """Linear density of the yarn (g/km), for its mass."""
    intarsia: NotRequired[bool]
    """Whether each fabric gets a yarn of its own."""


class GaugeCount(TypedDict):
    """A gauge counted on a swatch."""

    stitches: float
    rows: float
    per: NotRequired[Literal["10 cm", "4 in", "5 cm"]]
    fabric: NotRequired[Fabric]
    """Repeat of the swatch."""


class GaugeInput(TypedDict):
    """The gauge of a chart: counted on your own relaxed cloth, or from a relaxation."""

    stitches_per_10_cm: float
    """Counted on your own relaxed swatch; give stitches and rows, or neither."""
    rows_per_10_cm: float
    """Counted on your own relaxed swatch; give stitches and rows, or neither."""
    log_sd: NotRequired[float]
    """How uncertain both numbers are: standard deviation of their logarithms."""
    known_by: NotRequired[KnownBy]
    """`relaxation` for the `gauge` in the result of `relax`."""


class Glove(TypedDict):
    """The therapeutic glove; measurements default to an adult's hand."""

    ease: NotRequired[float]
    target_mmhg: NotRequired[float | None]
    """Target pressure; takes precedence over the ease."""
    template: Literal["glove"]
    cuff_mm: NotRequired[float]
    wrist_mm: NotRequired[float]
    wrist_circumference_mm: NotRequired[float]
    palm_mm: NotRequired[float]
    thumb_crotch_mm: NotRequired[float]
    palm_circumference_mm: NotRequired[float]
    gusset_mm: NotRequired[float]
    gusset_girth_mm: NotRequired[float]
    thumb: NotRequired[FingerSize | None]
    fingers: NotRequired[list[FingerSize] | None]


class GloveRequest(TypedDict):
    """The measurements of a hand, and the yarn."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    gauge: NotRequired[GaugeCount | None]
    """The knitter's gauge; the material's by default."""
    garment: Glove


class HangRequest(TypedDict):
    """A whole piece and what holds it."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    linear_density_g_per_m: float
    """Of the yarn, g/m: weigh some metres; tex divided by 1000."""
    chart: str | PureFabricChart
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out."""
    by: NotRequired[HungBy]
    """The edge of the highest stitches, or its ends."""
    corners: NotRequired[bool]
    """Also return the corners of the sheet."""
    time_limit_s: NotRequired[float]
    """CPU time after which the current shape is returned, not converged."""


class HeldInput(TypedDict):
    """An edge that is gripped, or sewn to something stiff, and moved as a whole."""

    kind: Literal["held"]
    edge: str
    x_mm: NotRequired[float | None]
    """Moved so far; null lets it slide along x."""
    y_mm: NotRequired[float | None]
    """Moved so far; null lets it slide along y."""


class HysteresisRequest(TypedDict):
    """A repeat, its yarn and the pull."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    loop_length_mm: NotRequired[float | None]
    """Yarn per stitch; the material's by default."""
    direction: NotRequired[Direction]
    """Along rows, or along columns."""
    max_strain: NotRequired[float]
    """Largest strain: 0.5 is 50 %."""
    friction: NotRequired[float | None]
    """Coefficient of friction between yarns; that of the fibre by default."""
    points: NotRequired[int]
    """Number of strains in loading."""
    cycles: NotRequired[int]
    rest_sizes: NotRequired[bool]
    """Also find the rest size after every history."""
    intervals: NotRequired[bool]
    """Also pull with the ends of the interval of friction, in three times the time."""


class ImportRequest(TypedDict):
    """A file of any kind that holds a chart."""

    file: UploadedFile | Path
    """`.txt` (K/P lines, written rows, KnitSpeak), `.ks`, `.png`, `.json` (design) or `.k`
    (knitout)."""


class Limb(TypedDict):
    """A sleeve for any limb."""

    ease: NotRequired[float]
    target_mmhg: NotRequired[float | None]
    """Target pressure; takes precedence over the ease."""
    template: Literal["limb"]
    profile: list[tuple[float, float]]
    """[position_mm, circumference_mm] along the limb."""
    body: NotRequired[Fabric]
    hem: NotRequired[Fabric]
    hem_mm: NotRequired[float]


class LimbInput(TypedDict):
    """A tube on a limb."""

    rest_mm: float
    """Circumference of the unworn tube."""
    worn_mm: float
    """Circumference of the limb."""


class LimbRequest(TypedDict):
    """A tube of a chart, and a limb by its girths."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    direction: NotRequired[Direction]
    """Around the limb."""
    girths: list[TubeGirth]
    """From one end to the other; between them sizes change evenly."""


class LimitsInput(TypedDict):
    """Limits on the effort of knitting; null for no limit."""

    transfers_per_stitch: NotRequired[float | None]
    """Loops moved between the beds, per stitch."""
    crossings_per_stitch: NotRequired[float | None]
    """Yarn between face and back, per stitch."""
    curl: NotRequired[float | None]
    """Knits minus purls over all stitches, either way."""


class MarkRequest(TypedDict):
    """What to outline."""

    box: NotRequired[BoxInput | None]


class MaterialRequest(TypedDict):
    """A material by its identifier."""

    identifier: str
    """Identifier of a material of the library."""


class NoRequest(TypedDict):
    """The request of an operation without inputs."""


class OverhangRequest(TypedDict):
    """A fabric, and how far a strip of it hangs over the edge of a table."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    linear_density_g_per_m: float
    """Of the yarn, g/m: weigh some metres; tex divided by 1000."""
    chart: str | PureFabricChart
    direction: NotRequired[Direction]
    """Along the strip."""
    overhang_mm: NotRequired[float | None]
    """Beyond the edge; that which falls by 41.5° if left out."""
    corners: NotRequired[bool]
    """Also return the corners of the sheet."""


class Palette(TypedDict):
    """Colours that carry a meaning; the page sends those of its theme."""

    yarn: NotRequired[str | None]
    """By default that of the yarn's name."""
    stockinette: NotRequired[str]
    garter: NotRequired[str]
    rib: NotRequired[str]
    seed: NotRequired[str]


class ParseRequest(TypedDict):
    """A chart as typed text."""

    text: str
    """K/P lines, the top row first, as seen from the face; or separated by /."""


class PieceInput(TypedDict):
    """A piece cut from cloth, and the conditions on its edges at the last step."""

    outline: list[tuple[float, float]]
    """Corners in mm; side 1 goes from the first to the second."""
    holes: NotRequired[list[list[tuple[float, float]]]]
    """Corners of each hole; their sides continue the numbering."""
    grain_deg: NotRequired[float]
    """Angle from the x axis to the rows, counter-clockwise: 45 is on the bias."""
    edges: dict[str, list[int]]
    """Names of parts of the boundary, by the numbers of their sides."""
    conditions: list[HeldInput | PulledInput | TractionInput | SewnInput]


class PieceRequest(TypedDict):
    """Cloth, the piece cut from it, and the conditions on its edges."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    steps: NotRequired[int]
    """Steps of the load."""
    shear_modulus_n_per_mm: NotRequired[float | None]
    """C_xyxy; that of the laws by default."""
    mesh_mm: NotRequired[float | None]
    """Length of an element's side; by default there are about 600 elements."""
    piece: PieceInput
    fields: NotRequired[bool]
    """Whether to return the final shape and strains."""


class Placement(BaseModel):
    """Where a linked repeat lies."""

    row: int
    """From 0, the bottom row or the left column."""
    column: int
    """From 0, the bottom row or the left column."""
    rows: int
    columns: int


class PredictRequest(TypedDict):
    """A chart and its material; constants of a shaped piece are those of the largest rectangle
    inside its outline, its size is that of the whole."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    gauge: NotRequired[GaugeInput | None]
    """Measured gauge of the chart; its relaxed size is estimated if left out."""
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out."""
    measures: NotRequired[list[str]]
    """Further numbers, by the names of installed extensions."""


class PressureRequest(TypedDict):
    """A tube on a limb: its law, or a fabric or chart of a material, and its sizes."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    direction: Direction
    """The material direction around the limb."""
    rest_mm: NotRequired[float | None]
    """Circumference of the unworn tube."""
    worn_mm: float
    """Circumference of the limb."""
    target_mmhg: NotRequired[float | None]
    """Target pressure, in place of rest_mm: finds the size of the tube."""
    material: NotRequired[str | None]
    fabric: NotRequired[Fabric | None]
    """A fabric of the material."""
    chart: NotRequired[str | PureFabricChart | None]
    """A chart of the material, in place of a fabric."""
    law: NotRequired[dict[str, float] | None]
    """Constants of a law, by name."""


class PullInput(TypedDict):
    """Two clamps that hold the outermost rows or columns and move apart."""

    direction: NotRequired[Direction]
    """Of the pull."""
    strain: float
    """From clamp to clamp: 0.3 is 30 %."""


class PulledInput(TypedDict):
    """An edge in a clamp that does not turn and moves freely under a force."""

    kind: Literal["pulled"]
    edge: str
    x_n: NotRequired[float]
    y_n: NotRequired[float]


class PureFabricChart(TypedDict):
    """A pure fabric by name and size."""

    fabric: Fabric
    columns: int
    rows: int


class RSRequest(TypedDict):
    """A yarn whose shape the paper gives: acrylic or cotton."""

    material: str
    """Identifier of a material of the library."""


class RelaxRequest(TypedDict):
    """A repeat, its yarn, what may be held while it relaxes, and what happened to the fabric."""

    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    loop_length_mm: NotRequired[float | None]
    """Yarn per stitch; the material's by default."""
    loop_lengths_mm: NotRequired[list[list[float]] | None]
    """Instead of one length: a list for every row of the chart, the bottom row first, of one
    length for all its stitches or one for each."""
    flat: NotRequired[bool]
    """Hold the stitches in one plane, as a fabric laid flat; not in the published branch."""
    branch: NotRequired[Branch | None]
    """By default symmetry is only the start: the mirrored shape is followed to the minimum that
    it leads to without the symmetries of the chart. Shapes that are held, or have friction, keep
    them; repeats of more than 16 stitches are relaxed in the free branch."""
    convention: NotRequired[Convention]
    fresh: NotRequired[bool]
    """Compute again, even if the result is stored."""
    friction: NotRequired[float | None]
    """Coefficient of friction between yarns. Without it, and without the other options that need
    one, there is no friction."""
    history: NotRequired[History | None]
    """What happened to the fabric before it came to rest, with the friction of the yarn unless a
    coefficient is given. If only a coefficient is given, as-knitted."""
    cell_course_mm: NotRequired[float | None]
    """Hold a stitch at this width."""
    cell_wale_mm: NotRequired[float | None]
    """Hold a stitch at this height."""
    centre_lines: NotRequired[bool]
    """Return the centre lines of the yarn too."""


class Run(TypedDict):
    """Adjacent stitches of one kind in a row."""

    row: int
    """From 0, the bottom row."""
    column: int
    """First stitch; from 0, at the left."""
    stitches: str


class SewnInput(TypedDict):
    """An edge with a tape or elastic sewn on, which resists stretching and bends freely."""

    kind: Literal["sewn"]
    edge: str
    stiffness_n: float
    """Force of the tape over its strain."""


class ShapeRequest(TypedDict):
    """A profile of widths at a stretch."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    material: str
    """Identifier of a material of the library."""
    direction: NotRequired[Direction]
    """Direction of the pull."""
    strain: float
    """From clamp to clamp: 0.3 is 30 %."""
    width: list[float | None]
    """Stretched width over width at rest, line by line across the pull, from the bottom (wale-
    wise) or the left (course-wise); null where any width will do."""
    across: int
    """Stitches in a line."""
    repeats: NotRequired[Literal["small", "all"]]
    smallest_band: NotRequired[int]
    """Fewest lines in a band."""
    seed: NotRequired[int]
    """The same seed gives the same chart."""


class ShareRequest(TypedDict):
    """A link to give away."""

    mode: NotRequired[ShareMode]


class SharedViewRequest(TypedDict):
    """A design, as it lies or with its stretch test as an animation."""

    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out."""
    colour: NotRequired[Colour]
    field: NotRequired[FieldColours | None]
    """Values for the colour `field`."""
    regions: NotRequired[list[DesignRegion]]
    """Of the design; coloured by `yarn` and `region`."""
    palette: NotRequired[Palette]
    rectangles: NotRequired[bool]
    rectangle_groups: NotRequired[RectangleGroups]
    rectangle_block: NotRequired[int]
    """Stitches on a side of a block."""
    stretch: NotRequired[StretchStep | None]
    curl: NotRequired[Curled | None]
    """Show it as it lies, hangs or is worn; not while it is stretched."""
    focus: NotRequired[Focus | None]
    """Around it a chart is drawn as yarn that is too large to be drawn whole."""
    animated: NotRequired[bool]
    """All steps of the stretch test, not only the one."""
    dark: NotRequired[bool]
    """Dark background of a page."""


class ShelfPattern(BaseModel):
    """A pattern of the user's."""

    name: str
    motif: str
    """A repeat; its rows from the top, separated by /."""


class SockLeg(TypedDict):
    """The leg of a sock."""

    ease: NotRequired[float]
    target_mmhg: NotRequired[float | None]
    """Target pressure; takes precedence over the ease."""
    template: Literal["sock-leg"]
    ankle_mm: float
    calf_mm: float
    length_mm: float


class StretchRequest(TypedDict):
    """A chart between two clamps, which hold the outermost stitches, and how it is pulled."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    gauge: NotRequired[GaugeInput | None]
    """Measured gauge of the chart; its relaxed size is estimated if left out."""
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out."""
    direction: Direction
    """Along rows, or along columns."""
    strain: NotRequired[float | None]
    """Last clamp-to-clamp strain: 0.5 is 50 %. Give this or a force."""
    force_n: NotRequired[float | None]
    """Last force on the clamps, in place of a strain."""
    steps: NotRequired[int]
    clamps: NotRequired[Clamps]
    """Ends gripped, or free to slide along the clamps."""
    model: NotRequired[EnergyModel]
    shear_modulus_n_per_mm: NotRequired[float | None]
    """C_xyxy in N/mm; that of the laws by default."""
    width_mm: NotRequired[float | None]
    """Size course-wise; from the gauge by default."""
    length_mm: NotRequired[float | None]
    """Size wale-wise; from the gauge by default."""


class StretchStep(TypedDict):
    """A state of a stretch test that was run before."""

    id: str
    """The id that the stretch test returned."""
    step: int


class Strokes(TypedDict):
    """Paint: new values of stitches, so that strokes of several people merge."""

    rows: int
    """Size of the chart that was painted on."""
    columns: int
    runs: list[Run]


class SwatchInput(TypedDict):
    """A measured swatch of the yarn."""

    fabric: Fabric
    law: dict[str, float]
    """Constants of its law, by name."""
    loop_length_mm: float
    setting: NotRequired[str]
    """Needle or stitch setting."""


class SweepRequest(TypedDict):
    """A repeat, its yarn and the stretch."""

    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    loop_length_mm: NotRequired[float | None]
    """Yarn per stitch; the material's by default."""
    loop_lengths_mm: NotRequired[list[list[float]] | None]
    """Instead of one length: a list for every row of the chart, the bottom row first, of one
    length for all its stitches or one for each."""
    flat: NotRequired[bool]
    """Hold the stitches in one plane, as a fabric laid flat; not in the published branch."""
    branch: NotRequired[Branch]
    convention: NotRequired[Convention]
    fresh: NotRequired[bool]
    """Compute again, even if the result is stored."""
    friction: NotRequired[float | None]
    """Coefficient of friction between yarns. Without it, and without the other options that need
    one, there is no friction."""
    direction: Direction
    """Along rows, or along columns."""
    max_strain: float
    """Largest strain: 0.5 is 50 %."""
    points: NotRequired[int]
    slide_quenching: NotRequired[bool]
    """Keep the yarn from sliding where it touches at rest. The published branch does so for seed
    along the course, as the paper did, and has no other setting."""
    there_and_back: NotRequired[bool]
    """Release the fabric again until it is free of force, with friction: that of the yarn unless
    a coefficient is given."""


class TargetInput(TypedDict):
    """One target property of a fabric."""

    quantity: Quantity
    value: float
    """Stretch as a strain: 0.5 is 50 %."""
    tolerance: NotRequired[float]
    """Relative (0.1 is 10 %); a difference for Poisson's ratios."""
    weight: NotRequired[float]
    load_n_per_mm: NotRequired[float]
    """Load of a target stretch, per width of cloth."""
    limb: NotRequired[LimbInput | None]
    """For a pressure."""


class TractionInput(TypedDict):
    """A load spread evenly along an edge, per length at rest."""

    kind: Literal["traction"]
    edge: str
    x_n_per_mm: NotRequired[float]
    y_n_per_mm: NotRequired[float]


class TrellisRequest(TypedDict):
    """A square and how far it is sheared."""

    laws: NotRequired[Laws | None]
    """Of the library's yarns: refitted clamp to clamp (default), or as published."""
    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    steps: NotRequired[int]
    """Steps of the load."""
    shear_modulus_n_per_mm: NotRequired[float | None]
    """C_xyxy; that of the laws by default."""
    mesh_mm: NotRequired[float | None]
    """Length of an element's side; by default there are about 600 elements."""
    angle_deg: float
    """How far the frame's right angle closes at the last step."""
    side_mm: NotRequired[float]
    """Side of the square."""
    grain_deg: NotRequired[float]
    """Angle from a bar of the frame to the rows."""


class TubeGirth(TypedDict):
    """Circumferences at one place."""

    at_mm: float
    """Along the limb, from where the tube begins."""
    girth_mm: float
    """Around the limb."""
    rest_mm: NotRequired[float | None]
    """Around the unworn tube. Left out at all places, the whole chart is the tube."""


class TubeRequest(TypedDict):
    """A repeat, its yarn, and how many stitches go around."""

    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    loop_length_mm: NotRequired[float | None]
    """Yarn per stitch; the material's by default."""
    wales: int
    """Stitches around, a multiple of the repeat's columns."""
    face_outside: NotRequired[bool]
    """Whether the face is outside."""


class UploadedFile(TypedDict):
    """A file's name and its content."""

    name: str
    content: str
    """The file, base64."""


class VersionRequest(TypedDict):
    """A name for the design's present state."""

    name: str


class ViewRequest(TypedDict):
    """A design and how to show it."""

    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    outline: NotRequired[str | None]
    """Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out."""
    colour: NotRequired[Colour]
    field: NotRequired[FieldColours | None]
    """Values for the colour `field`."""
    regions: NotRequired[list[DesignRegion]]
    """Of the design; coloured by `yarn` and `region`."""
    palette: NotRequired[Palette]
    rectangles: NotRequired[bool]
    rectangle_groups: NotRequired[RectangleGroups]
    rectangle_block: NotRequired[int]
    """Stitches on a side of a block."""
    stretch: NotRequired[StretchStep | None]
    curl: NotRequired[Curled | None]
    """Show it as it lies, hangs or is worn; not while it is stretched."""
    focus: NotRequired[Focus | None]
    """Around it a chart is drawn as yarn that is too large to be drawn whole."""


class WholeRequest(TypedDict):
    """A chart, its yarn, and when to stop."""

    chart: str | PureFabricChart
    material: str
    """Identifier of a material of the library."""
    loop_length_mm: NotRequired[float | None]
    """Yarn per stitch; the material's by default."""
    flat: NotRequired[bool]
    """Hold the stitches in one plane, as a fabric laid flat."""
    convention: NotRequired[Convention]
    tolerance: NotRequired[float]
    """Stop when a round changes the energy by less than this part of it, and the sizes by less
    than ten times this part."""
    rounds: NotRequired[int]
    """Most rounds on each of two grids."""
    centre_lines: NotRequired[bool]
    """Return the centre lines of the yarn too."""


class WishInput(TypedDict):
    """Stiffness wanted in one part of the chart."""

    name: NotRequired[str]
    runs: list[tuple[int, int, int]]
    """Its stitches as runs [row, first column, length], with row 0 at the bottom."""
    modulus_course_n_per_mm: NotRequired[float | None]
    modulus_wale_n_per_mm: NotRequired[float | None]


class WristBrace(TypedDict):
    """A brace, knitted sideways and grafted."""

    ease: NotRequired[float]
    target_mmhg: NotRequired[float | None]
    """Target pressure; takes precedence over the ease."""
    template: Literal["wrist-brace"]
    wrist_mm: float
    length_mm: float
    edge_mm: NotRequired[float]


class YarnInput(TypedDict):
    """A yarn by its parameters."""

    name: str
    """Name of a yarn that is given by the five numbers below."""
    bending_modulus_n_mm2: float
    """B of the yarn."""
    contact_stiffness_n_per_mm3: float
    """k of its contact law."""
    contact_exponent: float
    """p of its contact law."""
    radius_mm: float
    """Outer radius."""
    core_radius_mm: float
    """Core radius."""


class AtlasResult(BaseModel):
    """An atlas as columns, for the rigidity-rigidity scatter."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["atlas"] = "atlas"
    material: str
    repeats: list[str]
    modulus_course_n_per_mm: list[float]
    modulus_course_interval_n_per_mm: tuple[list[float], list[float]]
    modulus_wale_n_per_mm: list[float]
    modulus_wale_interval_n_per_mm: tuple[list[float], list[float]]
    poisson_yx: list[float]
    poisson_xy: list[float]
    stretch_course: list[float]
    """Strain at 0.1 N/mm."""
    stretch_wale: list[float]
    relaxed_course_mm: list[float]
    """Width of the mean stitch at rest."""
    relaxed_wale_mm: list[float]
    """Height of the mean stitch at rest."""
    transfers_per_stitch: list[float]
    crossings_per_stitch: list[float]
    curl: list[float]
    provenance: list[str]


class BandResult(BaseModel):
    """A band of lines of one repeat."""

    repeat: str
    """A repeat: K/P, the top row first, rows separated by /."""
    first: int
    """Its first line: from 1, at the bottom or the left."""
    lines: int


class BendResult(BaseModel):
    """Linear response of the relaxed repeat; course: bent along the rows."""

    kind: Literal["bend"] = "bend"
    moment_course_n: float
    """Derivative of the energy per area by the curvature, N·mm per mm of width. Negative: left
    alone, the fabric curves with its face outside."""
    moment_wale_n: float
    bending_course_n_mm: float
    """Bending rigidity, with the size across free to change."""
    bending_wale_n_mm: float
    bending_held_course_n_mm: float
    """Bending rigidity, with the size across held."""
    bending_held_wale_n_mm: float
    strain_across_course_mm: float
    """Strain across the bend per curvature, bent along the rows."""
    strain_across_wale_mm: float
    shear_modulus_n_per_mm: float | None
    """Null where no stable state was found."""
    twist_n_mm: float | None
    """Rigidity of twist D66; null, as is the coupling, without a stable state."""
    coupling_n_mm: float | None
    """Coupling D1 of the two curvatures."""
    thickness_mm: float
    curl: str
    """How free edges curl."""
    curl_course: Curl
    """The way the sides curl."""
    curl_wale: Curl
    """The way the top and bottom curl."""
    bending_length_course_mm: float | None
    """Peirce's, of a strip cut along the rows; null where the weight is not known."""
    bending_length_wale_mm: float | None
    stable: bool
    """Whether the state is still a minimum when it may lose its symmetries."""
    provenance: str
    yarn: YarnResult
    notes: list[str]


class BendingPhotoResult(BaseModel):
    """The result of one photo."""

    name: str
    bending_modulus_n_mm2: float
    length_mm: float
    px_per_mm: float
    yarn_width_mm: float
    rms_mm: float
    """Distance between the traced line and the fitted elastica."""


class BendingResult(BaseModel):
    """Mean over photos; proportional to the linear density given."""

    kind: Literal["bending"] = "bending"
    bending_modulus_n_mm2: float
    standard_deviation: float | None
    """Of a single photo, N·mm²; null if there is only one."""
    standard_error: float | None
    """Of the mean, N·mm²."""
    photos: list[BendingPhotoResult]
    notes: list[str]


class BiasResult(BaseModel):
    """A simulated strip test at an angle, not a certified one."""

    interval_source: str
    """What the 90 % intervals rest on."""
    energy_n_mm: list[float]
    """Energy stored in the cloth."""
    converged: bool
    seconds: float
    nodes: int
    elements: int
    utilisation: float
    """Largest alpha * strain at the last step; 1 is the lock-up."""
    messages: list[str]
    kind: Literal["bias"] = "bias"
    strain: list[float]
    force_n: list[float]
    """Force along the pull."""
    force_interval_n: tuple[list[float], list[float]]
    sideways_n: list[float]
    """Force across the pull: the clamps keep the cloth from shearing sideways."""
    stress_n_per_mm: list[float]
    """Force per width."""
    waist_strain: list[float]


class BiaxialResult(BaseModel):
    """A simulated biaxial test: edges stay straight and slide along themselves."""

    interval_source: str
    """What the 90 % intervals rest on."""
    energy_n_mm: list[float]
    """Energy stored in the cloth."""
    converged: bool
    seconds: float
    nodes: int
    elements: int
    utilisation: float
    """Largest alpha * strain at the last step; 1 is the lock-up."""
    messages: list[str]
    kind: Literal["biaxial"] = "biaxial"
    strain_x: list[float]
    strain_y: list[float]
    force_x_n: list[float]
    force_x_interval_n: tuple[list[float], list[float]]
    force_y_n: list[float]
    force_y_interval_n: tuple[list[float], list[float]]
    stress_x_n_per_mm: list[float]
    """Force per length of the edge."""
    stress_y_n_per_mm: list[float]


class BorderResult(BaseModel):
    """Borders of a piece that lies on a table."""

    kind: Literal["border"] = "border"
    sides: EdgesResult
    ends: EdgesResult
    """Top and bottom."""
    notes: list[str]


class CalibrateResult(BaseModel):
    """The calibrated law; its shear modulus is calibrated, too."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float
    shear_modulus_n_per_mm: float
    """An assumption unless it was fitted or calibrated."""
    kappa_xx: float
    """Share of the strain across in the stiffening."""
    kappa_yy: float
    shear_stiffening: float = 0.0
    """Growth of the shear stiffness with the angle squared, 1/rad²."""
    kind: Literal["calibrate"] = "calibrate"
    parameters: dict[str, float]
    standard_errors: dict[str, float]
    frames: list[int]
    """The frames that were fitted."""
    comparison: list[FrameErrorResult]
    """Errors at all frames, with the edges moved as measured."""
    force_strain: list[float]
    force_ratio: list[float]
    """Simulated force over measured force."""
    evaluations: int


class CandidateResult(BaseModel):
    """A repeat, and how near it comes to the targets."""

    material: str
    repeat: str
    """A repeat: K/P, the top row first, rows separated by /."""
    values: dict[str, float | None]
    """Values by quantity, with @load or @rest/worn; null beyond the lock-up."""
    intervals: dict[str, tuple[float | None, float | None]]
    """90 % intervals; null where an end lies beyond the computed curve."""
    deviations: dict[str, float | None]
    """Predicted over wanted, minus one; the difference for Poisson's ratios."""
    chance: float
    """Probability that all quantities are within their tolerances, by the intervals."""
    misfit: float | None
    """Weighted rms of deviations in units of their tolerances."""
    reached: bool
    provenance: str
    transfers_per_stitch: float
    crossings_per_stitch: float
    """Moves of the yarn between face and back, or between beds, per stitch."""
    curl: float
    """Knits minus purls over all stitches; far from 0 it curls."""


class CharacteriseResult(BaseModel):
    """The table of a yarn; `material` holds its laws at the reference setting."""

    kind: Literal["characterise"] = "characterise"
    identifier: str
    provenance: str
    estimated: bool
    """Whether contact data were estimated."""
    branch: Branch
    convention: Convention
    reference: str
    """The setting that `material` was made at."""
    rows: list[CharacterisedFabric]
    material: MaterialDocument | None
    """A material file; null if no fabric has a law at the reference."""
    materials: dict[str, MaterialDocument]
    """A material file for every setting, by its name."""


class CharacterisedFabric(BaseModel):
    """A pure fabric at one stitch setting, with its stress-strain curves."""

    fabric: Fabric
    setting: str
    loop_length_mm: float
    stitch_course_mm: float | None
    stitch_wale_mm: float | None
    stitches_per_cm2: float | None
    energy_n_mm: float | None
    bending_share: float | None
    contact_share: float | None
    contact_overtakes_at_strain_course: float | None
    jumps_course: int | None
    contact_overtakes_at_strain_wale: float | None
    jumps_wale: int | None
    modulus_course_n_per_mm: float | None
    modulus_wale_n_per_mm: float | None
    poisson_yx: float | None
    poisson_xy: float | None
    alpha_xx: float | None
    alpha_yy: float | None
    beta_xx_n_per_mm: float | None
    beta_yy_n_per_mm: float | None
    max_stress_n_per_mm: float | None
    largest_strain_course: float | None
    largest_strain_wale: float | None
    rms_course_n_per_mm: float | None
    rms_wale_n_per_mm: float | None
    converged: bool | None
    remark: str
    """Cautions, and why anything is missing."""
    curves: dict[Direction, FabricCurve]


class ClothPiece(BaseModel):
    """The stitches of a piece of cloth in a test, to show them in 3D: chart and shape."""

    id: str
    """Name of the shape, for 3D views of this chart."""
    chart: str
    """K/P lines, the top row first, as seen from the face."""
    outline: str
    """Lines of x (part of it) and . (not part of it), the top row first."""


class CompareResult(BaseModel):
    """Errors of each frame, in the order of the stretch."""

    kind: Literal["compare"] = "compare"
    frames: list[FrameErrorResult]
    edges: Edges
    model: EnergyModel
    messages: list[str]


class CompressionMeanResult(BaseModel):
    """Mean over the samples of one yarn."""

    yarn: str
    samples: int
    k_n_per_mm3: float
    k_standard_deviation_n_per_mm3: float | None
    p: float
    p_standard_deviation: float | None


class CompressionResult(BaseModel):
    """Constants of the contact law, per sample and mean."""

    kind: Literal["compression"] = "compression"
    k_n_per_mm3: float | None
    """Mean of the yarn; null if there are several yarns, whose means are in `mean`."""
    p: float | None
    """The same."""
    mean: dict[str, CompressionMeanResult]
    """By yarn."""
    samples: list[CompressionSampleResult]
    notes: list[str]


class CompressionSampleResult(BaseModel):
    """The result of one test, with the standard errors of its fit."""

    name: str
    yarn: str
    k_n_per_mm3: float
    k_error_n_per_mm3: float
    p: float
    p_error: float
    thickness_mm: float
    diameter_mm: float
    rms_n: float


class CurlResult(BaseModel):
    """The piece as it lies; heights are positive towards the face (the front)."""

    kind: Literal["curl"] = "curl"
    id: str
    """Name of the shape, for 3D views."""
    rows: int
    columns: int
    width_mm: float
    """Extent along the rows of the piece as a whole."""
    height_mm: float
    depth_mm: float
    curl_course_mm: float | None
    """Height of the sides above the fabric next to them; negative to the back. Null for a shaped
    piece."""
    curl_wale_mm: float | None
    """Height of the top and bottom above the fabric next to them."""
    flat_width_mm: float
    """Extent of the piece laid flat."""
    flat_height_mm: float
    thickness_mm: float
    converged: bool
    """If false, the shape is only a preview."""
    seconds: float
    """CPU time."""
    corners_mm: list[list[tuple[float, float, float] | None]] | None = None
    """Corners of the sheet line by line, mm; null outside the piece."""
    notes: list[str]


class CurveDeviationDocument(BaseModel):
    """Standard deviations of a stress-strain curve, as logarithms."""

    log_stress: float
    """of the natural logarithm"""
    log_lock_up: float = 0.0
    """of the natural logarithm"""


class CurveDocument(BaseModel):
    """A measured stress–strain curve."""

    strain: list[float]
    stress_n_per_mm: list[float]
    pulls: int = 1


class CurveResult(BaseModel):
    """Strain at each stress, transverse direction free."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["curve"] = "curve"
    stress_n_per_mm: list[float]
    strain: list[float]
    strain_interval: tuple[list[float], list[float]]
    """At each stress."""
    stress_interval_n_per_mm: tuple[list[float], list[float]]
    """At each strain; at most 10 N/mm."""
    provenance: str


class DeformedPiece(BaseModel):
    """The mesh after the last step."""

    corners_mm: list[tuple[float, float]]
    """At rest."""
    moved_mm: list[tuple[float, float]]
    """Displacement of each corner."""
    elements: list[list[int]]
    """Corner numbers of each element, from 0."""
    strain_course: list[float]
    """Per element, like the fields below."""
    strain_wale: list[float]
    shear_angle: list[float]
    """In radians."""
    stress_course: list[float]
    """N/mm."""
    stress_wale: list[float]
    stress_shear: list[float]
    utilisation: list[float]
    """alpha * strain; 1 is the lock-up."""


class Design(BaseModel):
    """A design with its document."""

    id: str
    name: str
    material: str
    rows: int
    columns: int
    revision: int
    """Grows with every change; the ETag is made of it."""
    created_at: AwareDatetime
    changed_at: AwareDatetime
    deleted_at: AwareDatetime | None = None
    document: DesignDocument


class DesignFile(BaseModel):
    """A design as a file holds it."""

    outline: str | None = None
    """Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out."""
    regions: list[DesignRegion] = []
    repeats: list[DesignRepeat] = []
    shelf: list[ShelfPattern] = []
    format: Literal["knitcore-design"] = "knitcore-design"
    version: Literal[2] = 2
    name: str = "Untitled"
    material: str | None = None
    """Library id or name of a material file."""
    chart: str
    """K/P lines, the top row first, face side."""
    note: str = ""


class DesignLayout(BaseModel):
    """Everything in a design except its chart and its names."""

    outline: str | None = None
    """Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out."""
    regions: list[DesignRegion] = []
    repeats: list[DesignRepeat] = []
    shelf: list[ShelfPattern] = []


class DesignPage(BaseModel):
    """A part of a list, latest changes first."""

    designs: list[DesignSummary]
    next_cursor: str | None
    """Send it to get the next page; null at the end."""


class DesignSchema(RootModel[dict[str, Any]]):
    """A JSON schema."""


class DesignSummary(BaseModel):
    """A design in a list."""

    id: str
    name: str
    material: str
    rows: int
    columns: int
    revision: int
    """Grows with every change; the ETag is made of it."""
    created_at: AwareDatetime
    changed_at: AwareDatetime
    deleted_at: AwareDatetime | None = None


class DeviationDocument(BaseModel):
    """Standard deviations of the linear constants, in their units, and of what goes beyond
    them."""

    modulus_course: float | None = None
    modulus_wale: float | None = None
    poisson_yx: float | None = None
    poisson_xy: float | None = None
    curve_course: CurveDeviationDocument | None = None
    curve_wale: CurveDeviationDocument | None = None
    log_shear: float | None = None
    source: str = ""


class DrapeResult(BaseModel):
    """The draped piece in the state of least energy of those found."""

    kind: Literal["drape"] = "drape"
    coefficient: float
    """Share of the ring outside the disc that its shadow covers: 1 for a board."""
    coefficient_of_states: tuple[float, float]
    """Smallest and largest of the states found: draped cloth has several."""
    folds: int
    """Around the rim."""
    fall_mm: float
    """From the disc to the lowest point."""
    bending_length_course_mm: float
    bending_length_wale_mm: float
    weight_g_per_m2: float
    converged: bool
    piece: ClothPiece
    corners_mm: list[list[tuple[float, float, float] | None]] | None = None
    """Corners of the sheet line by line, mm; null outside the piece."""
    notes: list[str]


class EdgesResult(BaseModel):
    """A border along two opposite edges."""

    moment_n: float
    """Per width, with which the piece curls there, N."""
    width_mm: float
    """Of a border that its own weight just keeps from being tipped over."""
    stitches: int
    """That width in stitches, or rows, of the border."""
    rule_share: float
    """Share of the moment that the weight of a border by the knitters' rule holds."""
    holds: bool
    """Whether a border 1.2 times as wide keeps a strip on a smooth table from rolling up."""
    ridge_mm: float
    """How high this strip rises beside its borders."""


class EstimateResult(BaseModel):
    """All four fabrics of the yarn."""

    interval_source: str
    """What the 90 % intervals rest on."""
    fabrics: dict[Fabric, FabricEstimateResult]
    left_out: LeftOutResult | None
    """None if all fabrics are measured."""
    material: MaterialDocument
    """A material file of the four fabrics."""
    warnings: list[str]


class ExportResult(BaseModel):
    """A file inside JSON."""

    kind: str
    rows: int
    columns: int
    bytes: int
    transfers: int | None = None
    """Of a knitout program, without the finish."""
    carriers: int | None = None
    """Of a knitout program, without waste."""
    notes: list[str]
    name: str
    media_type: str
    content: str
    """The file, base64."""


class ExtensionResult(BaseModel):
    """An extension of an installed package."""

    name: str
    group: Group
    package: str
    """Its name and version."""
    offers: list[str]
    """Identifiers."""
    problem: str | None
    """Why it cannot be used; null if it can."""


class Extensions(BaseModel):
    """All extensions."""

    extensions: list[ExtensionResult]


class FabricCurve(BaseModel):
    """A stretch, free across."""

    strain: list[float]
    transverse_strain: list[float]
    stress_n_per_mm: list[float]
    bending_share: list[float]
    contact_share: list[float]
    contact_overtakes_at_strain: float | None
    """Strain at which contact first holds half of the energy."""
    jumps: list[int]
    notes: list[str]


class FabricDetail(BaseModel):
    """A pure fabric of a material in full."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    stitch_course_mm: float
    """Relaxed width of one stitch."""
    stitch_wale_mm: float
    """Relaxed height of one stitch."""
    loop_length_mm: float | None
    poisson_yx: float
    """Contraction wale-wise when pulled course-wise."""
    poisson_xy: float
    """Contraction course-wise when pulled wale-wise."""
    law: LawResult
    lock_up_strain_course: float
    lock_up_strain_wale: float
    setting: str
    origin: str
    stitch_size_source: str
    uncertainty_source: str
    figures: list[FigureResult]


class FabricDocument(BaseModel):
    """One pure fabric of a user's material."""

    law: LawDocument
    stitch_course_mm: float
    """mm"""
    stitch_wale_mm: float
    """mm"""
    stitch_size_source: str = "given by the user"
    loop_length_mm: float | None = None
    hand_loop_length_mm: float | None = None
    yarn_diameter_mm: float | None = None
    hand_yarn_diameter_mm: float | None = None
    setting: str = ""
    origin: Origin = "fitted"
    law_source: str = ""
    inconsistent: list[Direction] = []
    standard_deviation: DeviationDocument | None = None
    measured: dict[Direction, CurveDocument] | None = None


class FabricEstimateResult(BaseModel):
    """One fabric; extension under load comes first because it is predicted best."""

    strain_at_0_1_n_per_mm: dict[Direction, float]
    strain_at_0_1_n_per_mm_interval: dict[Direction, tuple[float, float]]
    """Without width where the fabric is measured, like all intervals here."""
    modulus_n_per_mm: dict[Direction, float]
    modulus_interval_n_per_mm: dict[Direction, tuple[float, float]]
    alpha: dict[Direction, float]
    alpha_interval: dict[Direction, tuple[float, float]]
    beta_n_per_mm: dict[Direction, float]
    beta_interval_n_per_mm: dict[Direction, tuple[float, float]]
    law: LawResult
    loop_length_mm: float
    measured: bool


class FabricSummary(BaseModel):
    """A summary of a pure fabric of a material."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    stitch_course_mm: float
    """Relaxed width of one stitch."""
    stitch_wale_mm: float
    """Relaxed height of one stitch."""
    loop_length_mm: float | None


class Fault(BaseModel):
    """One thing that is wrong with a request."""

    detail: str
    """What is wrong, in words."""
    field: str | None = None
    """The input that is to blame."""
    remedy: str | None = None
    """What would be accepted."""


class FigureResult(BaseModel):
    """A figure of the paper: as printed, as used, and why they differ."""

    table: int
    quantity: str
    unit: str
    printed: str
    used: float
    standard_deviation: float | None
    reason: str


class FillResult(BaseModel):
    """A chart, and how near it comes to the targets."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["fill"] = "fill"
    rows: int
    columns: int
    chart: str
    """K/P lines, the top row first, as seen from the face."""
    off_share: float
    """Share of the stitches with a target that miss it by more than 10 %."""
    patches: list[PatchResult]
    messages: list[str]


class FindResult(BaseModel):
    """Ranked repeats, the surest first."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["find"] = "find"
    reached: bool
    message: str
    searched: int
    ranges: dict[str, tuple[float, float]]
    """Range of each quantity over all repeats."""
    candidates: list[CandidateResult]
    elsewhere: list[CandidateResult]
    """Nearest fabrics in other yarns, if none of those asked for meets the targets."""


class FitResult(BaseModel):
    """The constants of a law with their uncertainty."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float
    shear_modulus_n_per_mm: float
    """An assumption unless it was fitted or calibrated."""
    kappa_xx: float
    """Share of the strain across in the stiffening."""
    kappa_yy: float
    shear_stiffening: float = 0.0
    """Growth of the shear stiffness with the angle squared, 1/rad²."""
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float
    """Contraction wale-wise when pulled course-wise."""
    poisson_xy: float
    """Contraction course-wise when pulled wale-wise."""
    kind: Literal["fit"] = "fit"
    standard_errors: LawErrors
    rms_n_per_mm: float
    """Rms of all residuals."""
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float
    largest_strain: dict[Direction, float]
    """Largest strain of the fit."""
    runs: dict[Direction, int]
    """Pulls used."""
    reduction: Reduction
    error_method: str
    notes: list[str]
    waist_rms: dict[Direction, float] | None = None
    """Simulated minus measured strain of the waist (recommended reduction)."""
    residuals: dict[Direction, ResidualPoints] | None = None
    curves: dict[Direction, CurveDocument]
    """Median curve of the pulls in each direction; kept with the law in a file."""


class FoundGauge(BaseModel):
    """The gauge that a relaxation found; other requests take it as it is."""

    stitches_per_10_cm: float
    rows_per_10_cm: float
    log_sd: float
    known_by: KnownBy


class FrameErrorResult(BaseModel):
    """Simulated minus measured displacement at one frame, in per cent of the width."""

    frame: int
    applied_stretch: float
    ux_rms_percent_width: float
    ux_max_percent_width: float
    uy_rms_percent_width: float
    uy_max_percent_width: float


class GarmentResult(BaseModel):
    """A garment as a chart with an outline."""

    interval_source: str
    """What the 90 % intervals rest on."""
    name: str
    rows: int
    columns: int
    chart: str
    """K/P lines, the top row first, as seen from the face."""
    outline: str
    """Lines of x (part of it) and . (not part of it), the top row first."""
    stitches: int
    around: Direction
    """The material direction around the limb."""
    closing: str
    regions: list[RegionResult]
    gauges: list[GaugeResult]
    worn: list[WornResult]
    yarn_m: float
    yarn_g: float | None
    yarn_interval_m: tuple[float, float]
    """90 % interval."""
    yarn_interval_g: tuple[float, float] | None
    notes: list[str]
    warnings: list[str]
    """Notes on borders between regions of different gauge."""
    design: DesignFile
    """The garment as a project file, ready to edit."""


class GaugeResult(BaseModel):
    """The gauge of a fabric."""

    fabric: Fabric
    stitches_per_10_cm: float
    rows_per_10_cm: float
    stitches_per_4_in: float
    rows_per_4_in: float
    stitches_per_5_cm: float
    rows_per_5_cm: float
    source: str


class GlovePart(BaseModel):
    """Fit of a part of the glove where it is nearest to its lock-up."""

    at_mm: float
    rest_mm: float
    """Around the unworn tube."""
    girth_mm: float
    """Around the limb."""
    ease: float
    """Tube over limb, minus one; negative where it is stretched."""
    mmhg: tuple[float, float] | None
    """Mean pressure, from axially free to axially fixed; null where there is none."""
    mmhg_with_spread: tuple[float, float] | None
    """The same, widened by the 90 % interval of the chart's stress."""
    lock_up_share: float
    """Strain around the limb over that at which the chart is locked."""
    problem: str
    """Why there is no pressure, such as a loose fit."""
    name: str


class GloveResult(BaseModel):
    """How the glove sits; no medical class."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["glove"] = "glove"
    id: str
    """Name of the shape, for 3D views of the glove's chart."""
    rows: int
    columns: int
    parts: list[GlovePart]
    notes: list[str]


class HangResult(BaseModel):
    """The piece as it hangs."""

    kind: Literal["hang"] = "hang"
    id: str
    """Name of the shape, for 3D views."""
    weight_g: float
    drop_mm: float
    """From the highest point to the lowest."""
    width_mm: float
    depth_mm: float
    lengthening: float
    """Strain of the middle column."""
    converged: bool
    """If false, the shape is only a preview."""
    corners_mm: list[list[tuple[float, float, float] | None]] | None = None
    """Corners of the sheet line by line, mm; null outside the piece."""
    notes: list[str]


class HysteresisResult(BaseModel):
    """Cycles of pulling and letting go, and what is left of them."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["hysteresis"] = "hysteresis"
    direction: Direction
    friction: float
    """Coefficient of friction that was used."""
    friction_interval: tuple[float, float] | None
    """Of the yarn or its fibre; null where the request gave the coefficient."""
    friction_source: str
    legs: list[LoopLeg]
    """Loading and unloading in turn."""
    lost_per_cycle_n_per_mm: float
    """Energy that the last cycle loses per area of fabric, N·mm/mm²."""
    lost_per_cycle_interval_n_per_mm: tuple[float, float] | None = None
    """Over the interval of friction, as all further intervals."""
    lost_share: float
    """The same as a share of the work of the pull."""
    lost_share_interval: tuple[float, float] | None = None
    left_strain: float
    """Strain that remains after unloading."""
    left_strain_interval: tuple[float, float] | None = None
    closes_within: float
    """Change of the greatest stress from the first cycle to the last, as a part of the first."""
    rest_sizes: list[RestSizeResult]
    yarn: YarnResult
    notes: list[str]


class ImportResult(BaseModel):
    """The content of a file."""

    outline: str | None = None
    """Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out."""
    regions: list[DesignRegion] = []
    repeats: list[DesignRepeat] = []
    shelf: list[ShelfPattern] = []
    chart: str
    """K/P lines, the top row first, as seen from the face."""
    name: str | None = None
    """Of a design."""
    material: str | None = None
    note: str | None = None
    rows: int
    columns: int
    repeat: str
    """A repeat: K/P, the top row first, rows separated by /."""
    notes: list[str] = []
    """What may have been read wrongly or lost, such as a region."""


class JobPage(BaseModel):
    """A part of a list of jobs, latest first."""

    jobs: list[JobStatus]
    next_cursor: str | None
    """Send it to get the next page; null at the end."""


class JobStatus(BaseModel):
    """A job as its owner sees it."""

    id: str
    kind: str
    state: JobState
    progress: float
    """Share done, where the computation reports it."""
    problem: Problem | None = None
    """Why it failed or was interrupted."""
    created_at: AwareDatetime
    started_at: AwareDatetime | None = None
    finished_at: AwareDatetime | None = None


class LawCurve(BaseModel):
    """A stress-strain curve, transverse direction free."""

    strain: list[float]
    stress_n_per_mm: list[float]


class LawDocument(BaseModel):
    """A law as its stiffnesses, as its moduli and Poisson ratios, or as both if they agree."""

    stiffness_xxxx: float | None = None
    stiffness_yyyy: float | None = None
    stiffness_xxyy: float | None = None
    stiffness_yyxx: float | None = None
    modulus_course: float | None = None
    modulus_wale: float | None = None
    poisson_yx: float | None = None
    poisson_xy: float | None = None
    alpha_xx: float
    alpha_yy: float
    beta_xx: float
    beta_yy: float
    shear_modulus: float = 0.01
    """N/mm"""
    kappa_xx: float = 0.0
    kappa_yy: float = 0.0
    shear_stiffening: float = 0.0


class LawErrors(BaseModel):
    """Standard errors of a law's constants."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float
    """Contraction wale-wise when pulled course-wise."""
    poisson_xy: float
    """Contraction course-wise when pulled wale-wise."""
    shear_modulus_n_per_mm: float | None = None
    """Recommended reduction only; mostly that of its prior, a factor of 1.5."""
    kappa_xx: float | None = None
    kappa_yy: float | None = None


class LawResult(BaseModel):
    """The constants of a constitutive law."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float
    shear_modulus_n_per_mm: float
    """An assumption unless it was fitted or calibrated."""
    kappa_xx: float
    """Share of the strain across in the stiffening."""
    kappa_yy: float
    shear_stiffening: float = 0.0
    """Growth of the shear stiffness with the angle squared, 1/rad²."""


class LeftOutResult(BaseModel):
    """Errors for the library's yarns when each is left out; rms errors are factors."""

    measured: list[Fabric]
    values: int
    strain_rms_factor: float
    modulus_rms_factor: float
    modulus_median_factor: float
    modulus_within_two: float
    """Share predicted within a factor of two."""
    alpha_rms_factor: float
    beta_rms_factor: float
    modulus_coverage: float
    """Of the 90 % intervals."""
    strain_coverage: float


class LimbPlaceResult(BaseModel):
    """Fit at one place along the limb."""

    at_mm: float
    rest_mm: float
    """Around the unworn tube."""
    girth_mm: float
    """Around the limb."""
    ease: float
    """Tube over limb, minus one; negative where it is stretched."""
    mmhg: tuple[float, float] | None
    """Mean pressure, from axially free to axially fixed; null where there is none."""
    mmhg_with_spread: tuple[float, float] | None
    """The same, widened by the 90 % interval of the chart's stress."""
    lock_up_share: float
    """Strain around the limb over that at which the chart is locked."""
    problem: str
    """Why there is no pressure, such as a loose fit."""


class LimbResult(BaseModel):
    """Fit along the limb; no medical class."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["limb"] = "limb"
    places: list[LimbPlaceResult]
    tightest_mm: float
    """Where the tube is nearest to its lock-up."""
    loose_mm: float
    """Length along the limb on which the tube is loose."""
    id: str | None = None
    """Name of the shape, for 3D views, if the whole chart is the tube."""
    length_mm: float | None = None
    """Of the whole chart on the limb, held by nothing along it."""
    relaxed_length_mm: float | None = None
    notes: list[str]


class LoadedEdge(BaseModel):
    """Force and motion of an edge at each step."""

    edge: str
    kind: str
    force_x_n: list[float]
    """Force on the whole edge; 0 for a tape."""
    force_y_n: list[float]
    moved_x_mm: list[float]
    """Mean displacement of the edge."""
    moved_y_mm: list[float]
    force_x_interval_n: tuple[list[float], list[float]]
    force_y_interval_n: tuple[list[float], list[float]]
    moved_x_interval_mm: tuple[list[float], list[float]]
    moved_y_interval_mm: tuple[list[float], list[float]]


class LoopLeg(BaseModel):
    """One way of a cycle."""

    loading: bool
    strain: list[float]
    """From the rest size without friction."""
    transverse_strain: list[float]
    stress_n_per_mm: list[float]


class MaterialDetail(BaseModel):
    """A material in full."""

    id: str
    name: str
    description: str
    notes: list[str]
    bending_modulus_n_mm2: float | None
    bending_modulus_sd_n_mm2: float | None
    compression_stiffness_n_per_mm3: float | None
    compression_exponent: float | None
    fabrics: dict[Fabric, FabricDetail]
    stitch_table: StitchTableResult | None
    """Null for a material that lacks one of the four fabrics."""
    curves: dict[Fabric, dict[Direction, LawCurve]]
    """Curves of the laws."""
    measured: dict[Fabric, dict[Direction, CurveDocument]]
    """Curves of the stretch tests, if they are stored with the material."""


class MaterialDocument(BaseModel):
    """A material file."""

    format: Literal["knitcore-material"] = "knitcore-material"
    version: Literal[1] = 1
    identifier: str
    name: str
    yarn: YarnDocument | None = None
    fabrics: dict[Fabric, FabricDocument]
    note: str = ""


class MaterialSummary(BaseModel):
    """A summary of a material."""

    id: str
    name: str
    description: str
    fabrics: dict[Fabric, FabricSummary]
    added_by_you: bool
    """You may replace and remove it."""


class Materials(BaseModel):
    """The library."""

    materials: list[MaterialSummary]


class MeasureResult(BaseModel):
    """A number that an extension adds."""

    identifier: str
    value: float | None
    """Null where it has no finite value."""
    unit: str
    description: str


class ModelReport(BaseModel):
    """The model refitted from the packaged tables, and its leave-one-yarn-out figures."""

    yarns: int
    modulus_constant: dict[Fabric, dict[Direction, float]]
    """K in Y = K B / L³, geometric mean."""
    alpha: dict[Fabric, dict[Direction, float]]
    beta_n_per_mm: dict[Fabric, dict[Direction, float]]
    left_out: list[LeftOutResult]


class NearestLockUp(BaseModel):
    """The place nearest to its lock-up at the last step."""

    utilisation: float
    row: int
    """From 0, the bottom row."""
    column: int
    """From 0, at the left."""
    direction: Direction
    fabric: str


class NewShare(BaseModel):
    """A new link with its secret."""

    id: str
    mode: ShareMode
    created_at: AwareDatetime
    token: str
    """The design is at /api/v1/shared/{token} for who has this."""


class OtherShapeResult(BaseModel):
    """Energy and size of a stitch in another shape of the repeat."""

    energy_n_mm: float
    cell_course_mm: float
    cell_wale_mm: float


class OverhangResult(BaseModel):
    """A strip at rest."""

    kind: Literal["overhang"] = "overhang"
    overhang_mm: float
    angle_deg: float
    """From the edge to the tip, below the horizontal."""
    reach_mm: float
    """How far out the tip is."""
    fall_mm: float
    """How far down the tip is."""
    bending_length_mm: float
    """By Peirce's formula from overhang and angle."""
    rigidity_n_mm: float
    """Weight per area times the bending length cubed."""
    yarn_level_rigidity_n_mm: float
    """That with which the strip was bent."""
    weight_g_per_m2: float
    converged: bool
    piece: ClothPiece
    corners_mm: list[list[tuple[float, float, float] | None]] | None = None
    """Corners of the sheet line by line, mm; null outside the piece."""
    notes: list[str]


class Painted(BaseModel):
    """The design's state after strokes were kept."""

    revision: int
    changed_at: AwareDatetime
    map: StitchKinds
    """What looks different now: the strokes and one around."""


class ParsedChart(BaseModel):
    """A chart in canonical form and its smallest repeat."""

    rows: int
    columns: int
    text: str
    """K/P lines, the top row first, as seen from the face."""
    repeat: str
    """A repeat: K/P, the top row first, rows separated by /."""


class PatchResult(BaseModel):
    """A region of one repeat."""

    repeat: str
    """A repeat: K/P, the top row first, rows separated by /."""
    stitches: int
    row: int
    """Of its first stitch: from 0, the bottom row."""
    column: int
    """From 0, at the left."""
    deviation_course: float | None
    """Of the repeat; null without a target."""
    deviation_wale: float | None
    swatch_course: float | None
    """Of the patch in the finite swatch; null if it was not pulled."""
    swatch_wale: float | None
    modulus_course_n_per_mm: float
    """Of the patch, in the finite swatch if it was pulled there."""
    modulus_course_interval_n_per_mm: tuple[float, float]
    """90 % interval; includes that of a large cloth of the repeat."""
    modulus_wale_n_per_mm: float
    modulus_wale_interval_n_per_mm: tuple[float, float]


class PatternResult(BaseModel):
    """A repeat with a name."""

    id: str
    name: str
    repeat: str
    """A repeat: K/P, the top row first, rows separated by /."""
    note: str


class Patterns(BaseModel):
    """All named patterns."""

    patterns: list[PatternResult]


class PieceResult(BaseModel):
    """Equilibria of a piece under a growing load."""

    interval_source: str
    """What the 90 % intervals rest on."""
    energy_n_mm: list[float]
    """Energy stored in the cloth."""
    converged: bool
    seconds: float
    nodes: int
    elements: int
    utilisation: float
    """Largest alpha * strain at the last step; 1 is the lock-up."""
    messages: list[str]
    kind: Literal["piece"] = "piece"
    share: list[float]
    """Share of the load at each step."""
    area_mm2: float
    edges: list[LoadedEdge]
    """In the order of the conditions."""
    shape: DeformedPiece | None


class PredictResult(BaseModel):
    """Effective elastic constants of the whole chart at small strain, with 90 % intervals."""

    interval_source: str
    """What the 90 % intervals rest on."""
    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float
    """Contraction wale-wise when pulled course-wise."""
    poisson_xy: float
    """Contraction course-wise when pulled wale-wise."""
    rows: int
    """Size of the chart that the constants describe."""
    columns: int
    segments: dict[Direction, SegmentCountsResult]
    modulus_course_interval_n_per_mm: tuple[float, float]
    modulus_wale_interval_n_per_mm: tuple[float, float]
    poisson_yx_interval: tuple[float, float]
    poisson_xy_interval: tuple[float, float]
    modulus_course_bounds_n_per_mm: tuple[float, float]
    """Reuss and Voigt bounds, widened where folds require it."""
    modulus_wale_bounds_n_per_mm: tuple[float, float]
    shear_modulus_n_per_mm: float
    """An assumption unless it was calibrated."""
    relaxed_course_mm: float
    """Mean width of a stitch at rest."""
    relaxed_wale_mm: float
    """Mean height of a stitch at rest."""
    relaxed_course_interval_mm: tuple[float, float]
    relaxed_wale_interval_mm: tuple[float, float]
    relaxed_source: str
    width_mm: float
    """Of the whole piece at rest, at its widest."""
    height_mm: float
    """Of the whole piece at rest, at its highest."""
    width_interval_mm: tuple[float, float]
    height_interval_mm: tuple[float, float]
    provenance: str
    """measured; estimated; swept; learned; or learned with known size"""
    method: str
    worth_relaxing: str | None
    """Chart of the repeat whose relaxation (`relax`, some seconds) has a `gauge` with which these
    numbers would be more certain; null if there is none."""
    notes: list[str]
    measures: list[MeasureResult] = []
    """The measures that were asked for."""


class PressureResult(BaseModel):
    """Mean pressure; no medical class."""

    interval_source: str
    """What the 90 % intervals rest on."""
    mmhg: tuple[float, float]
    """Mean pressure, from axially free to axially fixed."""
    kpa: tuple[float, float]
    mmhg_with_law_spread: tuple[float, float] | None
    """That range, widened by the 90 % interval of the fabric's stress, if known."""
    strain: float
    """Strain around the limb."""
    rest_mm: float
    worn_mm: float
    tension_n_per_mm: tuple[float, float]
    """Hoop tension per worn length."""
    axial_strain_free: float
    lock_up_share: float | None
    """Strain over lock-up strain; null for a chart, whose stitches differ."""
    rest_mm_for_target: tuple[float, float] | None
    """Sizes that give the target pressure, axially free to axially fixed."""
    warnings: list[str]
    law_source: str
    """Where the law comes from; empty if unknown."""


class Problem(BaseModel):
    """What every error response looks like."""

    type: str
    """The kind of problem: the address of a page about it."""
    title: str
    status: int
    detail: str
    """What is wrong, in words."""
    field: str | None = None
    """The input that is to blame."""
    remedy: str | None = None
    """What would be accepted."""
    most: float | None = None
    """The largest number that the field would accept, where that is known."""
    errors: list[Fault] = []
    """Of inputs that cannot be used: all that is wrong, at most 100; `field`, `detail` and
    `remedy` are those of the first."""


class RSFabricResult(BaseModel):
    """A pure fabric in the model."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    segments: dict[Direction, RSSegment]


class RSResult(BaseModel):
    """The four fabrics of a yarn."""

    interval_source: str
    """What the 90 % intervals rest on."""
    material: str
    fabrics: dict[Fabric, RSFabricResult]


class RSSegment(BaseModel):
    """The connecting segments of one direction."""

    parity: Parity
    separation_mm: float
    """lambda, distance of the segment's ends."""
    length_mm: float
    """L, yarn between them."""
    slope: float
    """v, the ends' tangent across the line between them."""
    angle_rad: float | None
    """phi, tilt out of the cloth; odd segments only."""
    delta: float
    rigidity_n_per_mm: float
    modulus_n_per_mm: float
    modulus_interval_n_per_mm: tuple[float, float]
    """90 % interval for the knitted fabric."""
    published_n_per_mm: float | None
    """The paper's value for this modulus."""


class RegionResult(BaseModel):
    """One region: its repeat, colour and size, and the initial moduli of its fabric."""

    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    name: str
    fill: str
    """A repeat: K/P, the top row first, rows separated by /."""
    colour: str
    stitches: int
    columns: int
    """Stitches of its longest row."""
    rows: int
    """Rows of its longest column."""
    width_mm: float
    """Size at rest of that many stitches of its fabric, without neighbours."""
    height_mm: float
    width_interval_mm: tuple[float, float]
    """90 % interval, from that of the gauge."""
    height_interval_mm: tuple[float, float]
    yarn_m: float
    yarn_g: float | None
    cells: str
    """Lines of x (part of it) and . (not part of it), the top row first."""


class RelaxResult(BaseModel):
    """The shape of least energy, free of force or held; sizes and energies of one stitch."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["relax"] = "relax"
    branch: Branch
    convention: Convention
    repeat_rows: int
    """At least 2 in the free branch, as are the columns."""
    repeat_columns: int
    cell_course_mm: float
    cell_wale_mm: float
    cell_course_interval_mm: tuple[float, float] | None
    """90 % interval for knitted cloth; null for a width that was held."""
    cell_wale_interval_mm: tuple[float, float] | None
    energy_n_mm: float
    bending_share: float
    contact_share: float
    yarn_length_mm: float
    force_course_n: float | None
    """Force per stitch that holds a prescribed width; near 0 where it is free."""
    force_wale_n: float | None
    min_distance_mm: float | None
    seconds: float
    """CPU time of the solve, when it was first run."""
    known: bool = False
    """Whether the result was already stored."""
    evaluations: int
    """Of the energy; the steps of a history are not counted."""
    converged: bool
    yarn: YarnResult
    starts: list[StartResult]
    friction: float | None = None
    """Coefficient of friction that was used; null without friction."""
    history: History | None = None
    """What the fabric comes to rest after; null without friction."""
    rest_sizes: list[RestSizeResult] | None = None
    """With friction, the size after each history: the range in which the fabric may rest."""
    minimum: bool | None = None
    """Whether the shape is a minimum without the mirror symmetries of the chart; null where that
    was not checked: for shapes that are held, have friction or are of the published branch, for
    mirrored ones whose free cell has more than 16 stitches, and for cells of 100 stitches and
    more."""
    mirrored: OtherShapeResult | None = None
    """The mirrored shape from which this one, of less energy, was found. The laws of stored
    repeats and learned answers are of mirrored shapes, which are nearer to knitted cloth."""
    unmirrored: OtherShapeResult | None = None
    """In the mirrored branch: the lower shape that it leads to without its symmetries, if it is
    not a minimum."""
    other_minima_mm: list[tuple[float, float]] | None = None
    """Width and height of a stitch in other shapes that were found, whose energy is the same
    within 0.1 %. Which one is shown is a rule; the intervals cover all."""
    gauge: FoundGauge | None = None
    """For the `gauge` of other requests about this chart and material, which makes their answers
    more certain. Null unless the material is simulated, and for pure fabrics, other branches,
    shapes that are held, other loop lengths than the material's, and friction."""
    notes: list[str]
    centre_lines_mm: list[list[tuple[float, float, float]]] | None = None
    """Bottom course first; each runs once across the repeat."""


class ResidualPoints(BaseModel):
    """Measured points and the fitted stress there."""

    strain_along: list[float]
    strain_across: list[float]
    stress_n_per_mm: list[float]
    fitted_n_per_mm: list[float]


class RestSizeResult(BaseModel):
    """Size of a stitch free of force after a history."""

    history: History
    course_mm: float
    wale_mm: float
    course_interval_mm: tuple[float, float] | None = None
    """Over the interval of friction."""
    wale_interval_mm: tuple[float, float] | None = None


class SegmentCountsResult(BaseModel):
    """Segments of one direction by their symmetry."""

    even: int
    odd: int


class SessionSummary(BaseModel):
    """A browser that is signed in."""

    id: str
    created_at: AwareDatetime
    is_this: bool
    """Whether it is the session of this request."""


class ShapeResult(BaseModel):
    """A chart, and the outline of its swatch."""

    kind: Literal["shape"] = "shape"
    rows: int
    columns: int
    chart: str
    """K/P lines, the top row first, as seen from the face."""
    bands: list[BandResult]
    width: list[float]
    """Width in the finite swatch, to compare with the target."""
    wanted: list[float | None]
    rms: float
    """Rms of the differences, over the width at rest."""
    largest: float
    force_n: float
    pulls: int
    """Number of swatches that were computed."""
    messages: list[str]


class Share(BaseModel):
    """A link that was given away; its secret is shown only once, when it is made."""

    id: str
    mode: ShareMode
    created_at: AwareDatetime


class SharedDesign(BaseModel):
    """The design behind a link."""

    mode: ShareMode
    document: DesignDocument
    revision: int
    changed_at: AwareDatetime


class Shares(BaseModel):
    """The links of a design that are not revoked."""

    shares: list[Share]


class SignedIn(BaseModel):
    """The user of this request, with all sessions, and what is used of the limits of one user."""

    user: str
    sessions: list[SessionSummary]
    """Latest first; scripts have none."""
    use: dict[str, Use]
    """By the name that a refusal has in `field`. Where there are several processes, figures are
    of this one, except those of stored things."""


class StartResult(BaseModel):
    """The result from one starting shape; null where it failed."""

    name: str
    outcome: str
    energy_n_mm: float | None
    cell_course_mm: float | None
    cell_wale_mm: float | None


class StitchFields(BaseModel):
    """Values at the stitches: [step][row * columns + column], bottom row first; 0 where there is
    no stitch."""

    strain_course: list[list[float]]
    strain_wale: list[list[float]]
    utilisation: list[list[float]]
    """alpha * strain; 1 is the lock-up."""
    strain_course_interval: tuple[list[list[float]], list[list[float]]] | None = None
    """Of the strain along the pull only."""
    strain_wale_interval: tuple[list[list[float]], list[list[float]]] | None = None
    utilisation_interval: tuple[list[list[float]], list[list[float]]]


class StitchKind(BaseModel):
    """One of the 16 kinds of stitch, by its odd segments: left 1, right 2, below 4, above 8."""

    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    code: int
    modulus_course_interval_n_per_mm: tuple[float, float]
    modulus_wale_interval_n_per_mm: tuple[float, float]
    fractions: dict[Fabric, float]
    """Shares of the four phases."""


class StitchKinds(BaseModel):
    """Kinds of the stitches in a box; a material's `stitches` table says what each kind does."""

    row: int
    """Bottom row of the box; from 0, the bottom row of the chart."""
    column: int
    """Left column of the box; from 0, at the left."""
    kinds: list[str]
    """A hexadecimal digit for each stitch, bottom row first: its kind, 0 to 15."""


class StitchTableResult(BaseModel):
    """Values for all 16 kinds of stitch."""

    interval_source: str
    """What the 90 % intervals rest on."""
    codes: list[StitchKind]


class StretchResult(BaseModel):
    """The curve of a test, with fields at its stitches."""

    interval_source: str
    """What the 90 % intervals rest on."""
    strain: list[float]
    force_n: list[float]
    force_interval_n: tuple[list[float], list[float]]
    stress_n_per_mm: list[float]
    """Force per width; its relative interval is that of the force."""
    waist_strain: list[float]
    waist_strain_interval: tuple[list[float], list[float]]
    iterations: list[int]
    converged: bool
    seconds: float
    dofs: int
    width_mm: float
    length_mm: float
    shear_modulus_assumed: bool
    """Whether C_xyxy is the paper's assumption rather than measured."""
    nearest_lock_up: NearestLockUp | None
    messages: list[str]
    kind: Literal["stretch"] = "stretch"
    id: str
    """Name of this test, for the 3D view."""
    rows: int
    columns: int
    stitch_fields: StitchFields


class SweepResult(BaseModel):
    """A stretch, free across; sizes and energies of one stitch."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["sweep"] = "sweep"
    direction: Direction
    branch: Branch
    strain: list[float]
    strain_interval: tuple[list[float], list[float]]
    """90 % interval for knitted cloth, at each stress."""
    transverse_strain: list[float]
    stress_n_per_mm: list[float]
    energy_n_mm: list[float]
    """Of bending and contact, without losses to friction."""
    bending_share: list[float]
    contact_share: list[float]
    jumps: list[int]
    """Points at which the shape changes abruptly."""
    cell_course_mm: float
    """Relaxed size of one stitch."""
    cell_wale_mm: float
    friction: float | None = None
    """Coefficient of friction that was used; null without friction."""
    turn: int | None = None
    """Index of the largest strain, where the fabric turns; null without the way back, as are the
    next three."""
    lost_per_cycle_n_per_mm: float | None = None
    """Energy lost there and back per area of fabric, N·mm/mm²."""
    lost_share: float | None = None
    """The same as a share of the work of the pull."""
    left_strain: float | None = None
    """Strain that remains after the release."""
    law: SweptLaw | None
    converged: bool
    seconds: float
    """CPU time of the solves, when they were first run."""
    known: bool = False
    """Whether the result was already stored."""
    yarn: YarnResult
    notes: list[str]


class SweptLaw(BaseModel):
    """Law fitted to stretches along courses and along wales; stiffnesses and errors in N/mm."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float
    """Contraction wale-wise when pulled course-wise."""
    poisson_xy: float
    """Contraction course-wise when pulled wale-wise."""
    stiffness_xxxx: float
    stiffness_yyyy: float
    stiffness_xxyy: float
    stiffness_yyxx: float
    alpha_xx: float
    alpha_yy: float
    beta_xx: float
    beta_yy: float
    max_stress_n_per_mm: float
    """Upper end of the fitted range of stress."""
    largest_strain_course: float
    largest_strain_wale: float
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float


class TrellisResult(BaseModel):
    """A simulated trellis (picture frame) test."""

    interval_source: str
    """What the 90 % intervals rest on."""
    energy_n_mm: list[float]
    """Energy stored in the cloth."""
    converged: bool
    seconds: float
    nodes: int
    elements: int
    utilisation: float
    """Largest alpha * strain at the last step; 1 is the lock-up."""
    messages: list[str]
    kind: Literal["trellis"] = "trellis"
    angle_deg: list[float]
    force_n: list[float]
    """Force that pulls two opposite corners of the frame apart."""
    force_interval_n: tuple[list[float], list[float]]
    moment_n_mm: list[float]
    """Moment about the hinges: work per radian of shear."""
    shear_stress_n_per_mm: list[float]
    """Moment over the relaxed area."""


class TubeResult(BaseModel):
    """A tube free of force, and the same repeat as a flat fabric."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["tube"] = "tube"
    wales: int
    face_outside: bool
    diameter_mm: float
    """Of the surface at the mean height of the yarn."""
    diameter_interval_mm: tuple[float, float]
    """90 % interval for knitted cloth."""
    cell_course_mm: float
    """Width of a stitch, around on that surface."""
    cell_course_interval_mm: tuple[float, float]
    cell_wale_mm: float
    """Height of a stitch."""
    cell_wale_interval_mm: tuple[float, float]
    energy_n_mm: float
    """Of a stitch."""
    flat_course_mm: float
    """Width of a stitch of the flat fabric."""
    flat_wale_mm: float
    flat_energy_n_mm: float
    yarn: YarnResult
    notes: list[str]


class Use(BaseModel):
    """How much of a limit is used."""

    used: float
    most: float


class Version(BaseModel):
    """A kept state with its document."""

    number: int
    """From 1, oldest first."""
    name: str
    automatic: bool
    """Kept by the service before a restore replaced it."""
    revision: int
    created_at: AwareDatetime
    document: DesignDocument


class VersionResult(BaseModel):
    """The program and its versions."""

    version: str
    """Version of the program, as `knitcore --version` prints it."""
    api: str
    """Version of the REST API, as in its addresses after /api/."""


class VersionSummary(BaseModel):
    """A kept state of a design."""

    number: int
    """From 1, oldest first."""
    name: str
    automatic: bool
    """Kept by the service before a restore replaced it."""
    revision: int
    created_at: AwareDatetime


class Versions(BaseModel):
    """All kept states of a design."""

    versions: list[VersionSummary]


class ViewResult(BaseModel):
    """The view of a design and its address."""

    stitches: int
    """Stitches drawn as yarn."""
    source: str
    """Where the shapes of the stitches come from."""
    scale_mm: float
    """Length of the line below the fabric."""
    url: str
    """For a browser; after the # the pass to watch this view."""


class WholeResult(BaseModel):
    """The shape of a whole chart, free of force; sizes and energies of its mean stitch."""

    interval_source: str
    """What the 90 % intervals rest on."""
    kind: Literal["whole"] = "whole"
    rows: int
    columns: int
    cell_course_mm: float
    cell_wale_mm: float
    cell_course_interval_mm: tuple[float, float]
    """90 % interval for knitted cloth."""
    cell_wale_interval_mm: tuple[float, float]
    energy_n_mm: float
    bending_share: float
    contact_share: float
    min_distance_mm: float
    converged: bool
    """Whether the last round met the tolerance."""
    rounds: int
    """On both grids together."""
    energy_change: float
    """Part of the energy that the last round took away."""
    size_change: float
    """Larger relative change of width and height in the last round."""
    may_fall: float
    """Part of the energy that further rounds may take away: the last change times all rounds."""
    largest_force_n: float
    """That is left on the yarn."""
    seconds: float
    """CPU time since the job was last started."""
    yarn: YarnResult
    notes: list[str]
    centre_lines_mm: list[list[tuple[float, float, float]]] | None = None
    """Bottom course first; each runs once across the chart."""


class WornResult(BaseModel):
    """Pressure at one place along the limb."""

    at_mm: float
    part: str
    rest_mm: float
    worn_mm: float
    ease: float
    strain: float | None
    mmhg: tuple[float, float] | None
    kpa: tuple[float, float] | None
    warnings: list[str]


class YarnDocument(BaseModel):
    """The yarn of a material; every field is optional."""

    fibre: str = ""
    product: str = ""
    bending_modulus_n_mm2: float | None = None
    bending_modulus_sd_n_mm2: float | None = None
    compression_stiffness_n_per_mm3: float | None = None
    compression_exponent: float | None = None
    diameter_mm: float | None = None
    friction: float | None = None
    friction_interval: tuple[float, float] | None = None


class YarnResult(BaseModel):
    """The yarn that was used, and the source of its numbers."""

    bending_modulus_n_mm2: float
    contact_stiffness_n_per_mm3: float
    contact_exponent: float
    radius_mm: float
    core_radius_mm: float
    provenance: str
    estimated: bool


JobResult = (
    AtlasResult
    | BendResult
    | BendingResult
    | BiasResult
    | BiaxialResult
    | BorderResult
    | CalibrateResult
    | CharacteriseResult
    | CompareResult
    | CompressionResult
    | CurlResult
    | CurveResult
    | DrapeResult
    | FillResult
    | FindResult
    | FitResult
    | HangResult
    | HysteresisResult
    | OverhangResult
    | PieceResult
    | RelaxResult
    | ShapeResult
    | StretchResult
    | SweepResult
    | TrellisResult
    | TubeResult
    | WholeResult
)
"""The result of a job; its ``kind`` says which."""
