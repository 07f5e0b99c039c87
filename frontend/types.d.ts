// Made from the service's models by scripts/page_types.py: change those, then `make types`.

/** The atlas to compute. */
export interface AtlasRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of two fabrics. */
  repeats?: "small" | "all";
}

/** An atlas as columns, for the rigidity-rigidity scatter. */
export interface AtlasResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "atlas";
  material: string;
  repeats: string[];
  modulus_course_n_per_mm: number[];
  modulus_course_interval_n_per_mm: [number[], number[]];
  modulus_wale_n_per_mm: number[];
  modulus_wale_interval_n_per_mm: [number[], number[]];
  poisson_yx: number[];
  poisson_xy: number[];
  /** Strain at 0.1 N/mm. */
  stretch_course: number[];
  stretch_wale: number[];
  /** Width of the mean stitch at rest. */
  relaxed_course_mm: number[];
  /** Height of the mean stitch at rest. */
  relaxed_wale_mm: number[];
  transfers_per_stitch: number[];
  crossings_per_stitch: number[];
  curl: number[];
  provenance: string[];
}

/** A band of lines of one repeat. */
export interface BandResult {
  /** A repeat: K/P, the top row first, rows separated by /. */
  repeat: string;
  /** Its first line: from 1, at the bottom or the left. */
  first: number;
  lines: number;
}

/** A repeat and its yarn. */
export interface BendRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Yarn per stitch; the material's by default. */
  loop_length_mm?: number | null;
  /** Of the yarn; needed for the bending lengths. */
  linear_density_g_per_m?: number | null;
}

/** Linear response of the relaxed repeat; course: bent along the rows. */
export interface BendResult {
  kind: "bend";
  /** Derivative of the energy per area by the curvature, N·mm per mm of width. Negative: left alone, the fabric curves with its face outside. */
  moment_course_n: number;
  moment_wale_n: number;
  /** Bending rigidity, with the size across free to change. */
  bending_course_n_mm: number;
  bending_wale_n_mm: number;
  /** Bending rigidity, with the size across held. */
  bending_held_course_n_mm: number;
  bending_held_wale_n_mm: number;
  /** Strain across the bend per curvature, bent along the rows. */
  strain_across_course_mm: number;
  strain_across_wale_mm: number;
  /** Null where no stable state was found. */
  shear_modulus_n_per_mm: number | null;
  /** Rigidity of twist D66; null, as is the coupling, without a stable state. */
  twist_n_mm: number | null;
  /** Coupling D1 of the two curvatures. */
  coupling_n_mm: number | null;
  thickness_mm: number;
  /** How free edges curl. */
  curl: string;
  /** The way the sides curl. */
  curl_course: Curl;
  /** The way the top and bottom curl. */
  curl_wale: Curl;
  /** Peirce's, of a strip cut along the rows; null where the weight is not known. */
  bending_length_course_mm: number | null;
  bending_length_wale_mm: number | null;
  /** Whether the state is still a minimum when it may lose its symmetries. */
  stable: boolean;
  provenance: string;
  yarn: YarnResult;
  notes: string[];
}

/** The result of one photo. */
export interface BendingPhotoResult {
  name: string;
  bending_modulus_n_mm2: number;
  length_mm: number;
  px_per_mm: number;
  yarn_width_mm: number;
  /** Distance between the traced line and the fitted elastica. */
  rms_mm: number;
}

/** Photos of hanging yarn, with the lengths and weight needed to read them. */
export interface BendingRequest {
  images: UploadedFile[];
  /** Mass per length: weigh some metres; 0.5 g/m is 500 tex. */
  linear_density_g_per_m: number;
  /** Hanging length, clamp to free end; one for all photos or one per photo. */
  length_mm?: number[] | number | null;
  /** Scale, if it is known. */
  px_per_mm?: number | null;
}

/** Mean over photos; proportional to the linear density given. */
export interface BendingResult {
  kind: "bending";
  bending_modulus_n_mm2: number;
  /** Of a single photo, N·mm²; null if there is only one. */
  standard_deviation: number | null;
  /** Of the mean, N·mm². */
  standard_error: number | null;
  photos: BendingPhotoResult[];
  notes: string[];
}

/** A strip and how far it is pulled. */
export interface BiasRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Steps of the load. */
  steps?: number;
  /** C_xyxy; that of the laws by default. */
  shear_modulus_n_per_mm?: number | null;
  /** Length of an element's side; by default there are about 600 elements. */
  mesh_mm?: number | null;
  /** Last clamp-to-clamp strain: 0.5 is 50 %. */
  strain: number;
  /** Distance between the free sides. */
  width_mm?: number;
  /** Distance between the clamps. */
  length_mm?: number;
  /** Angle from the width to the rows: 0 pulls along columns, 90 along rows. */
  angle_deg?: number;
}

/** A simulated strip test at an angle, not a certified one. */
export interface BiasResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  /** Energy stored in the cloth. */
  energy_n_mm: number[];
  converged: boolean;
  seconds: number;
  nodes: number;
  elements: number;
  /** Largest alpha * strain at the last step; 1 is the lock-up. */
  utilisation: number;
  messages: string[];
  kind: "bias";
  strain: number[];
  /** Force along the pull. */
  force_n: number[];
  force_interval_n: [number[], number[]];
  /** Force across the pull: the clamps keep the cloth from shearing sideways. */
  sideways_n: number[];
  /** Force per width. */
  stress_n_per_mm: number[];
  waist_strain: number[];
}

/** A rectangle and how far its edges are pulled. */
export interface BiaxialRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Steps of the load. */
  steps?: number;
  /** C_xyxy; that of the laws by default. */
  shear_modulus_n_per_mm?: number | null;
  /** Length of an element's side; by default there are about 600 elements. */
  mesh_mm?: number | null;
  /** Last strain along x. */
  strain_x: number;
  /** Last strain along y. */
  strain_y: number;
  /** Along x. */
  width_mm?: number;
  /** Along y. */
  length_mm?: number;
  /** Angle from the x axis to the rows. */
  grain_deg?: number;
}

/** A simulated biaxial test: edges stay straight and slide along themselves. */
export interface BiaxialResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  /** Energy stored in the cloth. */
  energy_n_mm: number[];
  converged: boolean;
  seconds: number;
  nodes: number;
  elements: number;
  /** Largest alpha * strain at the last step; 1 is the lock-up. */
  utilisation: number;
  messages: string[];
  kind: "biaxial";
  strain_x: number[];
  strain_y: number[];
  force_x_n: number[];
  force_x_interval_n: [number[], number[]];
  force_y_n: number[];
  force_y_interval_n: [number[], number[]];
  /** Force per length of the edge. */
  stress_x_n_per_mm: number[];
  stress_y_n_per_mm: number[];
}

/** A piece and the fabric of its border. */
export interface BorderRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** Of the yarn, g/m: weigh some metres; tex divided by 1000. */
  linear_density_g_per_m: number;
  chart: string | PureFabricChart;
  /** Fabric of the border. */
  border?: Fabric;
}

/** Borders of a piece that lies on a table. */
export interface BorderResult {
  kind: "border";
  sides: EdgesResult;
  /** Top and bottom. */
  ends: EdgesResult;
  notes: string[];
}

/** Some stitches: rows ``row0`` (the bottom row is 0) to ``row1 - 1``, columns likewise. */
export interface BoxInput {
  row0: number;
  column0: number;
  row1: number;
  column1: number;
}

/** Shapes of the yarn that are admitted. */
export type Branch = "published" | "mirrored" | "free";

/** The law to start from, and tests whose forces the law has to match. */
export interface CalibrateRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** .npz: displacement (frames, 2, rows, columns), frame. */
  field: UploadedFile;
  /** Direction in which the fabric was pulled. */
  direction: Direction;
  /** Frames to use; all by default. */
  frames?: number[] | null;
  /** Identifier of a material of the library. */
  material: string;
  fabric: Fabric;
  /** Stretch tests: of the direction (forces), or course and wale (forces and start). */
  tests?: UploadedFile[];
}

/** The calibrated law; its shear modulus is calibrated, too. */
export interface CalibrateResult {
  stiffness_xxxx_n_per_mm: number;
  stiffness_yyyy_n_per_mm: number;
  stiffness_xxyy_n_per_mm: number;
  stiffness_yyxx_n_per_mm: number;
  alpha_xx: number;
  alpha_yy: number;
  beta_xx_n_per_mm: number;
  beta_yy_n_per_mm: number;
  /** An assumption unless it was fitted or calibrated. */
  shear_modulus_n_per_mm: number;
  /** Share of the strain across in the stiffening. */
  kappa_xx: number;
  kappa_yy: number;
  /** Growth of the shear stiffness with the angle squared, 1/rad². */
  shear_stiffening: number;
  kind: "calibrate";
  parameters: Record<string, number>;
  standard_errors: Record<string, number>;
  /** The frames that were fitted. */
  frames: number[];
  /** Errors at all frames, with the edges moved as measured. */
  comparison: FrameErrorResult[];
  force_strain: number[];
  /** Simulated force over measured force. */
  force_ratio: number[];
  evaluations: number;
}

/** From where to look. */
export interface CameraRequest {
  side: CameraSide;
}

/** Sides of a fabric. */
export type CameraSide = "face" | "back" | "edge" | "angle";

/** A repeat, and how near it comes to the targets. */
export interface CandidateResult {
  material: string;
  /** A repeat: K/P, the top row first, rows separated by /. */
  repeat: string;
  /** Values by quantity, with @load or @rest/worn; null beyond the lock-up. */
  values: Record<string, number | null>;
  /** 90 % intervals; null where an end lies beyond the computed curve. */
  intervals: Record<string, [number | null, number | null]>;
  /** Predicted over wanted, minus one; the difference for Poisson's ratios. */
  deviations: Record<string, number | null>;
  /** Probability that all quantities are within their tolerances, by the intervals. */
  chance: number;
  /** Weighted rms of deviations in units of their tolerances. */
  misfit: number | null;
  reached: boolean;
  provenance: string;
  transfers_per_stitch: number;
  /** Moves of the yarn between face and back, or between beds, per stitch. */
  crossings_per_stitch: number;
  /** Knits minus purls over all stitches; far from 0 it curls. */
  curl: number;
}

/** A yarn, of a material or by its parameters. */
export interface CharacteriseRequest {
  fabrics?: Fabric[];
  /** Yarn per stitch, for all fabrics; `tensions` is not used then. */
  loop_lengths_mm?: number[];
  /** Loop lengths as parts of the material's own. */
  tensions?: number[];
  branch?: Branch;
  convention?: Convention;
  /** Largest stress of the fitted laws. */
  max_stress_n_per_mm?: number;
  material?: string | null;
  yarn?: YarnInput | null;
}

/** The table of a yarn; `material` holds its laws at the reference setting. */
export interface CharacteriseResult {
  kind: "characterise";
  identifier: string;
  provenance: string;
  /** Whether contact data were estimated. */
  estimated: boolean;
  branch: Branch;
  convention: Convention;
  /** The setting that `material` was made at. */
  reference: string;
  rows: CharacterisedFabric[];
  /** A material file; null if no fabric has a law at the reference. */
  material: MaterialDocument | null;
  /** A material file for every setting, by its name. */
  materials: Record<string, MaterialDocument>;
}

/** A pure fabric at one stitch setting, with its stress-strain curves. */
export interface CharacterisedFabric {
  fabric: Fabric;
  setting: string;
  loop_length_mm: number;
  stitch_course_mm: number | null;
  stitch_wale_mm: number | null;
  stitches_per_cm2: number | null;
  energy_n_mm: number | null;
  bending_share: number | null;
  contact_share: number | null;
  contact_overtakes_at_strain_course: number | null;
  jumps_course: number | null;
  contact_overtakes_at_strain_wale: number | null;
  jumps_wale: number | null;
  modulus_course_n_per_mm: number | null;
  modulus_wale_n_per_mm: number | null;
  poisson_yx: number | null;
  poisson_xy: number | null;
  alpha_xx: number | null;
  alpha_yy: number | null;
  beta_xx_n_per_mm: number | null;
  beta_yy_n_per_mm: number | null;
  max_stress_n_per_mm: number | null;
  largest_strain_course: number | null;
  largest_strain_wale: number | null;
  rms_course_n_per_mm: number | null;
  rms_wale_n_per_mm: number | null;
  converged: boolean | null;
  /** Cautions, and why anything is missing. */
  remark: string;
  curves: Record<Direction, FabricCurve>;
}

/** Ends of a strip: gripped, or free to slide along the clamp. */
export type Clamps = "clamped" | "sliding";

/** The stitches of a piece of cloth in a test, to show them in 3D: chart and shape. */
export interface ClothPiece {
  /** Name of the shape, for 3D views of this chart. */
  id: string;
  /** K/P lines, the top row first, as seen from the face. */
  chart: string;
  /** Lines of x (part of it) and . (not part of it), the top row first. */
  outline: string;
}

/** The quantity that colours the stitches. */
export type Colour = "yarn" | "region" | "fabric" | "phase" | "course" | "wale" | "anisotropy" | "strain" | "utilisation" | "pressure" | "field";

/** A law, or a fabric of a material, and a field to compare it with. */
export interface CompareRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** .npz: displacement (frames, 2, rows, columns), frame. */
  field: UploadedFile;
  /** Direction in which the fabric was pulled. */
  direction: Direction;
  /** Frames to use; all by default. */
  frames?: number[] | null;
  material?: string | null;
  /** A fabric of the material. */
  fabric?: Fabric | null;
  /** A law file, LAW.json, in place of material and fabric. */
  law?: UploadedFile | null;
  edges?: Edges;
  model?: EnergyModel;
}

/** Errors of each frame, in the order of the stretch. */
export interface CompareResult {
  kind: "compare";
  frames: FrameErrorResult[];
  edges: Edges;
  model: EnergyModel;
  messages: string[];
}

/** Mean over the samples of one yarn. */
export interface CompressionMeanResult {
  yarn: string;
  samples: number;
  k_n_per_mm3: number;
  k_standard_deviation_n_per_mm3: number | null;
  p: number;
  p_standard_deviation: number | null;
}

/** Compression tests of yarns. */
export interface CompressionRequest {
  file: UploadedFile;
  /** Use only the samples of this yarn (sheets named yarn-number). */
  yarn?: string | null;
  /** Diameter of the yarn, if the file does not state it. */
  diameter_mm?: number | null;
  probe_width_mm?: number;
}

/** Constants of the contact law, per sample and mean. */
export interface CompressionResult {
  kind: "compression";
  /** Mean of the yarn; null if there are several yarns, whose means are in `mean`. */
  k_n_per_mm3: number | null;
  /** The same. */
  p: number | null;
  /** By yarn. */
  mean: Record<string, CompressionMeanResult>;
  samples: CompressionSampleResult[];
  notes: string[];
}

/** The result of one test, with the standard errors of its fit. */
export interface CompressionSampleResult {
  name: string;
  yarn: string;
  k_n_per_mm3: number;
  k_error_n_per_mm3: number;
  p: number;
  p_error: number;
  thickness_mm: number;
  diameter_mm: number;
  rms_n: number;
}

/** How the cloth is worked. */
export type Construction = "flat" | "round";

/** A reading of the paper's energy. */
export type Convention = "published" | "paper" | "authors-code";

/** How the free edges across a direction curl. */
export type Curl = "flat" | "front" | "back";

/** A whole piece whose edges are free, all or beside two clamps. */
export interface CurlRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out. */
  outline?: string | null;
  /** By clamps, whose free sides curl. */
  pull?: PullInput | null;
  /** Id of a shape of as many stitches, such as that before a stitch was changed: the calculation begins there, and its first shapes come sooner. Has no effect if the service has forgotten it, or with another size. */
  after?: string | null;
  /** Also return the corners of all stitches. */
  corners?: boolean;
  /** CPU time after which the current shape is returned, not converged. */
  time_limit_s?: number;
}

/** The piece as it lies; heights are positive towards the face (the front). */
export interface CurlResult {
  kind: "curl";
  /** Name of the shape, for 3D views. */
  id: string;
  rows: number;
  columns: number;
  /** Extent along the rows of the piece as a whole. */
  width_mm: number;
  height_mm: number;
  depth_mm: number;
  /** Height of the sides above the fabric next to them; negative to the back. Null for a shaped piece. */
  curl_course_mm: number | null;
  /** Height of the top and bottom above the fabric next to them. */
  curl_wale_mm: number | null;
  /** Extent of the piece laid flat. */
  flat_width_mm: number;
  flat_height_mm: number;
  thickness_mm: number;
  /** If false, the shape is only a preview. */
  converged: boolean;
  /** CPU time. */
  seconds: number;
  /** Corners of the sheet line by line, mm; null outside the piece. */
  corners_mm: (([number, number, number] | null)[])[] | null;
  notes: string[];
}

/** The shape of a piece that was computed before. */
export interface Curled {
  /** The id that `curl`, `hang`, `limb` or `glove` returned. */
  id: string;
}

/** Standard deviations of a stress-strain curve, as logarithms. */
export interface CurveDeviationDocument {
  /** of the natural logarithm */
  log_stress: number;
  /** of the natural logarithm */
  log_lock_up: number;
}

/** A measured stress–strain curve. */
export interface CurveDocument {
  strain: number[];
  stress_n_per_mm: number[];
  pulls: number;
}

/** A chart, a direction and the stresses to ask for. */
export interface CurveRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Measured gauge of the chart; its relaxed size is estimated if left out. */
  gauge?: GaugeInput | null;
  /** Along rows, or along columns. */
  direction: Direction;
  /** Increasing. */
  stress_n_per_mm?: number[];
}

/** Strain at each stress, transverse direction free. */
export interface CurveResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "curve";
  stress_n_per_mm: number[];
  strain: number[];
  /** At each stress. */
  strain_interval: [number[], number[]];
  /** At each strain; at most 10 N/mm. */
  stress_interval_n_per_mm: [number[], number[]];
  provenance: string;
}

/** The mesh after the last step. */
export interface DeformedPiece {
  /** At rest. */
  corners_mm: [number, number][];
  /** Displacement of each corner. */
  moved_mm: [number, number][];
  /** Corner numbers of each element, from 0. */
  elements: number[][];
  /** Per element, like the fields below. */
  strain_course: number[];
  strain_wale: number[];
  /** In radians. */
  shear_angle: number[];
  /** N/mm. */
  stress_course: number[];
  stress_wale: number[];
  stress_shear: number[];
  /** alpha * strain; 1 is the lock-up. */
  utilisation: number[];
}

/** A design with its document. */
export interface Design {
  id: string;
  name: string;
  material: string;
  rows: number;
  columns: number;
  /** Grows with every change; the ETag is made of it. */
  revision: number;
  created_at: string;
  changed_at: string;
  deleted_at: string | null;
  document: DesignDocument;
}

/** A design as a file holds it; ``knitcore`` reads the same on the command line. */
export interface DesignDocument {
  /** Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out. */
  outline: string | null;
  regions: DesignRegion[];
  repeats: DesignRepeat[];
  shelf: ShelfPattern[];
  format: "knitcore-design";
  version: 2;
  name: string;
  material: string;
  /** K/P lines, the top row first, as seen from the face; or separated by /. */
  chart: string;
  note: string;
}

/** A design as a file holds it. */
export interface DesignFile {
  /** Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out. */
  outline: string | null;
  regions: DesignRegion[];
  repeats: DesignRepeat[];
  shelf: ShelfPattern[];
  format: "knitcore-design";
  version: 2;
  name: string;
  /** Library id or name of a material file. */
  material: string | null;
  /** K/P lines, the top row first, face side. */
  chart: string;
  note: string;
}

/** Everything in a design except its chart and its names. */
export interface DesignLayout {
  /** Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out. */
  outline: string | null;
  regions: DesignRegion[];
  repeats: DesignRepeat[];
  shelf: ShelfPattern[];
}

/** A part of a list, latest changes first. */
export interface DesignPage {
  designs: DesignSummary[];
  /** Send it to get the next page; null at the end. */
  next_cursor: string | null;
}

/** Fields to change; the others stay. */
export interface DesignPatch {
  name?: string | null;
  material?: string | null;
  note?: string | null;
}

/** A part of the chart with a fill or a yarn of its own; later regions lie on top. */
export interface DesignRegion {
  id: string;
  name: string;
  colour: string;
  /** Intarsia yarn; None leaves the yarn beneath. */
  yarn: string | null;
  /** Repeat that fills it, counted from the chart's corner. */
  fill: string | null;
  /** [row, column, length] of adjacent stitches; row 0 is the bottom. */
  runs: [number, number, number][];
  locked: boolean;
  hidden: boolean;
}

/** A motif whose placements all follow it; "multiple of n + m" has m ``edge_columns``. */
export interface DesignRepeat {
  id: string;
  name: string;
  /** A repeat; its rows from the top, separated by /. */
  motif: string;
  edge_columns: number;
  edge_rows: number;
  placements: Placement[];
}

/** A JSON schema. */
export type DesignSchema = Record<string, unknown>;

/** A design in a list. */
export interface DesignSummary {
  id: string;
  name: string;
  material: string;
  rows: number;
  columns: number;
  /** Grows with every change; the ETag is made of it. */
  revision: number;
  created_at: string;
  changed_at: string;
  deleted_at: string | null;
}

/** Standard deviations of the linear constants, in their units, and of what goes beyond them. */
export interface DeviationDocument {
  modulus_course: number | null;
  modulus_wale: number | null;
  poisson_yx: number | null;
  poisson_xy: number | null;
  curve_course: CurveDeviationDocument | null;
  curve_wale: CurveDeviationDocument | null;
  log_shear: number | null;
  source: string;
}

/** A material direction: course = along rows (x), wale = along columns (y). */
export type Direction = "course" | "wale";

/** A fabric, and the sizes of the test. */
export interface DrapeRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** Of the yarn, g/m: weigh some metres; tex divided by 1000. */
  linear_density_g_per_m: number;
  chart: string | PureFabricChart;
  /** Diameter of the round piece. */
  piece_mm?: number;
  /** Diameter of the disc. */
  disc_mm?: number;
  /** Rectangles of the sheet across the piece. */
  across?: number;
  /** Also return the corners of the sheet. */
  corners?: boolean;
}

/** The draped piece in the state of least energy of those found. */
export interface DrapeResult {
  kind: "drape";
  /** Share of the ring outside the disc that its shadow covers: 1 for a board. */
  coefficient: number;
  /** Smallest and largest of the states found: draped cloth has several. */
  coefficient_of_states: [number, number];
  /** Around the rim. */
  folds: number;
  /** From the disc to the lowest point. */
  fall_mm: number;
  bending_length_course_mm: number;
  bending_length_wale_mm: number;
  weight_g_per_m2: number;
  converged: boolean;
  piece: ClothPiece;
  /** Corners of the sheet line by line, mm; null outside the piece. */
  corners_mm: (([number, number, number] | null)[])[] | null;
  notes: string[];
}

/** Motion imposed at the clamped edges: the measured one, or its mean (rigid clamps). */
export type Edges = "measured" | "rigid";

/** A border along two opposite edges. */
export interface EdgesResult {
  /** Per width, with which the piece curls there, N. */
  moment_n: number;
  /** Of a border that its own weight just keeps from being tipped over. */
  width_mm: number;
  /** That width in stitches, or rows, of the border. */
  stitches: number;
  /** Share of the moment that the weight of a border by the knitters' rule holds. */
  rule_share: number;
  /** Whether a border 1.2 times as wide keeps a strip on a smooth table from rolling up. */
  holds: boolean;
  /** How high this strip rises beside its borders. */
  ridge_mm: number;
}

/** The energy of a sheet. */
export type EnergyModel = "published" | "full";

/** What is known of the yarn and the product. */
export interface EstimateRequest {
  /** B of the yarn (`measure bending`). */
  bending_modulus_n_mm2: number;
  /** Needle or stitch setting of the product. */
  product_setting?: string;
  /** Yarn per stitch. */
  loop_length_mm: number | Partial<Record<Fabric, number>>;
  swatches?: SwatchInput[];
}

/** All four fabrics of the yarn. */
export interface EstimateResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  fabrics: Partial<Record<Fabric, FabricEstimateResult>>;
  /** None if all fabrics are measured. */
  left_out: LeftOutResult | null;
  /** A material file of the four fabrics. */
  material: MaterialDocument;
  warnings: string[];
}

/** Formats for export. */
export type ExportKind = "knitout" | "knitspeak" | "png" | "svg" | "pdf" | "pattern" | "pattern-svg" | "report" | "text" | "written" | "design" | "glb" | "stl" | "vtu" | "csv";

/** A chart and the format to write it in. */
export interface ExportRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out. */
  outline?: string | null;
  regions?: DesignRegion[];
  repeats?: DesignRepeat[];
  shelf?: ShelfPattern[];
  chart: string | PureFabricChart;
  /** knitout, knitspeak, png, svg, pdf, pattern, pattern-svg, report, text, written, design, glb, stl, vtu, csv; or a format of an installed extension. */
  to: ExportKind | string;
  /** Gives sizes and values. */
  material?: string;
  construction?: Construction;
  /** The side of row 1, in flat knitting. */
  first_side?: Side;
  /** The end of a knitout program. */
  finish?: Finish;
  /** Known gauge of the chart; its relaxed size is estimated if left out. */
  gauge?: GaugeInput | null;
  name?: string;
  /** Printed. */
  note?: string;
  /** Linear density of the yarn, for its mass. */
  linear_density_tex?: number | null;
  /** PNG picture of the cloth, base64, for the first page of a pattern. */
  photo?: string | null;
}

/** A file inside JSON. */
export interface ExportResult {
  kind: string;
  rows: number;
  columns: number;
  bytes: number;
  /** Of a knitout program, without the finish. */
  transfers: number | null;
  /** Of a knitout program, without waste. */
  carriers: number | null;
  notes: string[];
  name: string;
  media_type: string;
  /** The file, base64. */
  content: string;
}

/** An extension of an installed package. */
export interface ExtensionResult {
  name: string;
  group: Group;
  /** Its name and version. */
  package: string;
  /** Identifiers. */
  offers: string[];
  /** Why it cannot be used; null if it can. */
  problem: string | null;
}

/** All extensions. */
export interface Extensions {
  extensions: ExtensionResult[];
}

/** A pure fabric: connecting segments are all alike course-wise, and all alike wale-wise. */
export type Fabric = "stockinette" | "garter" | "rib" | "seed";

/** A stretch, free across. */
export interface FabricCurve {
  strain: number[];
  transverse_strain: number[];
  stress_n_per_mm: number[];
  bending_share: number[];
  contact_share: number[];
  /** Strain at which contact first holds half of the energy. */
  contact_overtakes_at_strain: number | null;
  jumps: number[];
  notes: string[];
}

/** A pure fabric of a material in full. */
export interface FabricDetail {
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  /** Relaxed width of one stitch. */
  stitch_course_mm: number;
  /** Relaxed height of one stitch. */
  stitch_wale_mm: number;
  loop_length_mm: number | null;
  /** Contraction wale-wise when pulled course-wise. */
  poisson_yx: number;
  /** Contraction course-wise when pulled wale-wise. */
  poisson_xy: number;
  law: LawResult;
  lock_up_strain_course: number;
  lock_up_strain_wale: number;
  setting: string;
  origin: string;
  stitch_size_source: string;
  uncertainty_source: string;
  figures: FigureResult[];
}

/** One pure fabric of a user's material. */
export interface FabricDocument {
  law: LawDocument;
  /** mm */
  stitch_course_mm: number;
  /** mm */
  stitch_wale_mm: number;
  stitch_size_source: string;
  loop_length_mm: number | null;
  hand_loop_length_mm: number | null;
  yarn_diameter_mm: number | null;
  hand_yarn_diameter_mm: number | null;
  setting: string;
  origin: Origin;
  law_source: string;
  inconsistent: Direction[];
  standard_deviation: DeviationDocument;
  measured: Record<Direction, CurveDocument>;
}

/** One fabric; extension under load comes first because it is predicted best. */
export interface FabricEstimateResult {
  strain_at_0_1_n_per_mm: Record<Direction, number>;
  /** Without width where the fabric is measured, like all intervals here. */
  strain_at_0_1_n_per_mm_interval: Record<Direction, [number, number]>;
  modulus_n_per_mm: Record<Direction, number>;
  modulus_interval_n_per_mm: Record<Direction, [number, number]>;
  alpha: Record<Direction, number>;
  alpha_interval: Record<Direction, [number, number]>;
  beta_n_per_mm: Record<Direction, number>;
  beta_interval_n_per_mm: Record<Direction, [number, number]>;
  law: LawResult;
  loop_length_mm: number;
  measured: boolean;
}

/** A summary of a pure fabric of a material. */
export interface FabricSummary {
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  /** Relaxed width of one stitch. */
  stitch_course_mm: number;
  /** Relaxed height of one stitch. */
  stitch_wale_mm: number;
  loop_length_mm: number | null;
}

/** One thing that is wrong with a request. */
export interface Fault {
  /** What is wrong, in words. */
  detail: string;
  /** The input that is to blame. */
  field: string | null;
  /** What would be accepted. */
  remedy: string | null;
}

/** Any value of each stitch on a colour map. */
export interface FieldColours {
  /** Row by row from the bottom, each from the left. */
  values: number[];
  low: number;
  high: number;
  log?: boolean;
  map?: "batlow" | "vik";
}

/** A figure of the paper: as printed, as used, and why they differ. */
export interface FigureResult {
  table: number;
  quantity: string;
  unit: string;
  printed: string;
  used: number;
  standard_deviation: number | null;
  reason: string;
}

/** Wanted moduli, stitch by stitch or part by part. */
export interface FillRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** [row][column], the bottom row first; null where any value will do. */
  modulus_course_n_per_mm?: ((number | null)[])[] | null;
  modulus_wale_n_per_mm?: ((number | null)[])[] | null;
  /** Of the chart, if wishes are given. */
  rows?: number | null;
  columns?: number | null;
  /** In place of the two maps. */
  wishes?: WishInput[] | null;
  /** K/P lines, the top row first: stitches without a target stay as in this chart; otherwise they are filled. */
  chart?: string | null;
  /** Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out. */
  outline?: string | null;
  repeats?: "small" | "all";
  /** Smallest side of a patch, where its part is not smaller. */
  smallest_patch?: number;
  /** Single stitches may be turned over where that comes nearer; otherwise every patch is a repeat, or stripes of two. */
  scattered?: boolean;
  /** The same seed gives the same chart. */
  seed?: number;
  /** Pull the chart in the finite swatch; choose again where the result differs. */
  check?: boolean;
}

/** A chart, and how near it comes to the targets. */
export interface FillResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "fill";
  rows: number;
  columns: number;
  /** K/P lines, the top row first, as seen from the face. */
  chart: string;
  /** Share of the stitches with a target that miss it by more than 10 %. */
  off_share: number;
  patches: PatchResult[];
  messages: string[];
}

/** Target properties, and the yarns to search. */
export interface FindRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  materials: string[];
  targets: TargetInput[];
  limits?: LimitsInput | null;
  /** small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of two fabrics. */
  repeats?: "small" | "all";
  count?: number;
  /** Search the other yarns too if nothing meets the targets. */
  elsewhere?: boolean;
}

/** Ranked repeats, the surest first. */
export interface FindResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "find";
  reached: boolean;
  message: string;
  searched: number;
  /** Range of each quantity over all repeats. */
  ranges: Record<string, [number, number]>;
  candidates: CandidateResult[];
  /** Nearest fabrics in other yarns, if none of those asked for meets the targets. */
  elsewhere: CandidateResult[];
}

/** Measurements of one finger. */
export interface FingerSize {
  length_mm: number;
  circumference_mm: number;
}

/** The finish that keeps the last course from ravelling. */
export type Finish = "waste" | "bind-off";

/** Two stretch tests of one fabric. */
export interface FitRequest {
  /** Pulled along the rows; HDF5, CSV or XLSX. */
  test_course: UploadedFile;
  /** Pulled along the columns. */
  test_wale: UploadedFile;
  /** Recognised from the content if not given. */
  format?: "csv" | "h5" | null;
  /** recommended: force and waist of the simulated test, clamp to clamp; uniform: clamp to clamp, as if the cloth strained evenly; published: as in the paper. */
  reduction?: Reduction;
  /** Clamped width, in place of the course-wise test's. */
  width_course_mm?: number | null;
  /** The same, wale-wise. */
  width_wale_mm?: number | null;
  /** Whether to return residuals at each point. */
  residuals?: boolean;
}

/** The constants of a law with their uncertainty. */
export interface FitResult {
  stiffness_xxxx_n_per_mm: number;
  stiffness_yyyy_n_per_mm: number;
  stiffness_xxyy_n_per_mm: number;
  stiffness_yyxx_n_per_mm: number;
  alpha_xx: number;
  alpha_yy: number;
  beta_xx_n_per_mm: number;
  beta_yy_n_per_mm: number;
  /** An assumption unless it was fitted or calibrated. */
  shear_modulus_n_per_mm: number;
  /** Share of the strain across in the stiffening. */
  kappa_xx: number;
  kappa_yy: number;
  /** Growth of the shear stiffness with the angle squared, 1/rad². */
  shear_stiffening: number;
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  /** Contraction wale-wise when pulled course-wise. */
  poisson_yx: number;
  /** Contraction course-wise when pulled wale-wise. */
  poisson_xy: number;
  kind: "fit";
  standard_errors: LawErrors;
  /** Rms of all residuals. */
  rms_n_per_mm: number;
  rms_course_n_per_mm: number;
  rms_wale_n_per_mm: number;
  /** Largest strain of the fit. */
  largest_strain: Record<Direction, number>;
  /** Pulls used. */
  runs: Record<Direction, number>;
  reduction: Reduction;
  error_method: string;
  notes: string[];
  /** Simulated minus measured strain of the waist (recommended reduction). */
  waist_rms: Record<Direction, number> | null;
  residuals: Record<Direction, ResidualPoints> | null;
  /** Median curve of the pulls in each direction; kept with the law in a file. */
  curves: Record<Direction, CurveDocument>;
}

/** A stitch. */
export interface Focus {
  /** From 0, the bottom row. */
  row: number;
  /** From 0, at the left. */
  column: number;
}

/** The gauge that a relaxation found; other requests take it as it is. */
export interface FoundGauge {
  stitches_per_10_cm: number;
  rows_per_10_cm: number;
  log_sd: number;
  known_by: KnownBy;
}

/** Simulated minus measured displacement at one frame, in per cent of the width. */
export interface FrameErrorResult {
  frame: number;
  applied_stretch: number;
  ux_rms_percent_width: number;
  ux_max_percent_width: number;
  uy_rms_percent_width: number;
  uy_max_percent_width: number;
}

/** A template with measurements, and the yarn. */
export interface GarmentRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** The knitter's gauge; the material's by default. */
  gauge?: GaugeCount | null;
  garment: WristBrace | SockLeg | Limb | Glove;
  /** Linear density of the yarn (g/km), for its mass. */
  linear_density_tex?: number | null;
  /** Whether each fabric gets a yarn of its own. */
  intarsia?: boolean;
}

/** A garment as a chart with an outline. */
export interface GarmentResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  name: string;
  rows: number;
  columns: number;
  /** K/P lines, the top row first, as seen from the face. */
  chart: string;
  /** Lines of x (part of it) and . (not part of it), the top row first. */
  outline: string;
  stitches: number;
  /** The material direction around the limb. */
  around: Direction;
  closing: string;
  regions: RegionResult[];
  gauges: GaugeResult[];
  worn: WornResult[];
  yarn_m: number;
  yarn_g: number | null;
  /** 90 % interval. */
  yarn_interval_m: [number, number];
  yarn_interval_g: [number, number] | null;
  notes: string[];
  /** Notes on borders between regions of different gauge. */
  warnings: string[];
  /** The garment as a project file, ready to edit. */
  design: DesignFile;
}

/** A gauge counted on a swatch. */
export interface GaugeCount {
  stitches: number;
  rows: number;
  per?: "10 cm" | "4 in" | "5 cm";
  /** Repeat of the swatch. */
  fabric?: Fabric;
}

/** The gauge of a chart: counted on your own relaxed cloth, or from a relaxation. */
export interface GaugeInput {
  /** Counted on your own relaxed swatch; give stitches and rows, or neither. */
  stitches_per_10_cm: number;
  /** Counted on your own relaxed swatch; give stitches and rows, or neither. */
  rows_per_10_cm: number;
  /** How uncertain both numbers are: standard deviation of their logarithms. */
  log_sd?: number;
  /** `relaxation` for the `gauge` in the result of `relax`. */
  known_by?: KnownBy;
}

/** The gauge of a fabric. */
export interface GaugeResult {
  fabric: Fabric;
  stitches_per_10_cm: number;
  rows_per_10_cm: number;
  stitches_per_4_in: number;
  rows_per_4_in: number;
  stitches_per_5_cm: number;
  rows_per_5_cm: number;
  source: string;
}

/** The therapeutic glove; measurements default to an adult's hand. */
export interface Glove {
  ease?: number;
  /** Target pressure; takes precedence over the ease. */
  target_mmhg?: number | null;
  template: "glove";
  cuff_mm?: number;
  wrist_mm?: number;
  wrist_circumference_mm?: number;
  palm_mm?: number;
  thumb_crotch_mm?: number;
  palm_circumference_mm?: number;
  gusset_mm?: number;
  gusset_girth_mm?: number;
  thumb?: FingerSize | null;
  fingers?: FingerSize[] | null;
}

/** Fit of a part of the glove where it is nearest to its lock-up. */
export interface GlovePart {
  at_mm: number;
  /** Around the unworn tube. */
  rest_mm: number;
  /** Around the limb. */
  girth_mm: number;
  /** Tube over limb, minus one; negative where it is stretched. */
  ease: number;
  /** Mean pressure, from axially free to axially fixed; null where there is none. */
  mmhg: [number, number] | null;
  /** The same, widened by the 90 % interval of the chart's stress. */
  mmhg_with_spread: [number, number] | null;
  /** Strain around the limb over that at which the chart is locked. */
  lock_up_share: number;
  /** Why there is no pressure, such as a loose fit. */
  problem: string;
  name: string;
}

/** The measurements of a hand, and the yarn. */
export interface GloveRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** The knitter's gauge; the material's by default. */
  gauge?: GaugeCount | null;
  garment: Glove;
}

/** How the glove sits; no medical class. */
export interface GloveResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "glove";
  /** Name of the shape, for 3D views of the glove's chart. */
  id: string;
  rows: number;
  columns: number;
  parts: GlovePart[];
  notes: string[];
}

/** Groups of entry points, and what their functions return lists of. */
export type Group = "knitcore.patterns" | "knitcore.materials" | "knitcore.exporters" | "knitcore.measures";

/** A whole piece and what holds it. */
export interface HangRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** Of the yarn, g/m: weigh some metres; tex divided by 1000. */
  linear_density_g_per_m: number;
  chart: string | PureFabricChart;
  /** Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out. */
  outline?: string | null;
  /** The edge of the highest stitches, or its ends. */
  by?: HungBy;
  /** Also return the corners of the sheet. */
  corners?: boolean;
  /** CPU time after which the current shape is returned, not converged. */
  time_limit_s?: number;
}

/** The piece as it hangs. */
export interface HangResult {
  kind: "hang";
  /** Name of the shape, for 3D views. */
  id: string;
  weight_g: number;
  /** From the highest point to the lowest. */
  drop_mm: number;
  width_mm: number;
  depth_mm: number;
  /** Strain of the middle column. */
  lengthening: number;
  /** If false, the shape is only a preview. */
  converged: boolean;
  /** Corners of the sheet line by line, mm; null outside the piece. */
  corners_mm: (([number, number, number] | null)[])[] | null;
  notes: string[];
}

/** An edge that is gripped, or sewn to something stiff, and moved as a whole. */
export interface HeldInput {
  kind: "held";
  edge: string;
  /** Moved so far; null lets it slide along x. */
  x_mm?: number | null;
  /** Moved so far; null lets it slide along y. */
  y_mm?: number | null;
}

/** What happened to the fabric before it was laid down. */
export type History = "agitated" | "as-knitted" | "stretched-course" | "stretched-wale";

/** What holds a hanging piece. */
export type HungBy = "edge" | "corners";

/** A repeat, its yarn and the pull. */
export interface HysteresisRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Yarn per stitch; the material's by default. */
  loop_length_mm?: number | null;
  /** Along rows, or along columns. */
  direction?: Direction;
  /** Largest strain: 0.5 is 50 %. */
  max_strain?: number;
  /** Coefficient of friction between yarns; that of the fibre by default. */
  friction?: number | null;
  /** Number of strains in loading. */
  points?: number;
  cycles?: number;
  /** Also find the rest size after every history. */
  rest_sizes?: boolean;
  /** Also pull with the ends of the interval of friction, in three times the time. */
  intervals?: boolean;
}

/** Cycles of pulling and letting go, and what is left of them. */
export interface HysteresisResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "hysteresis";
  direction: Direction;
  /** Coefficient of friction that was used. */
  friction: number;
  /** Of the yarn or its fibre; null where the request gave the coefficient. */
  friction_interval: [number, number] | null;
  friction_source: string;
  /** Loading and unloading in turn. */
  legs: LoopLeg[];
  /** Energy that the last cycle loses per area of fabric, N·mm/mm². */
  lost_per_cycle_n_per_mm: number;
  /** Over the interval of friction, as all further intervals. */
  lost_per_cycle_interval_n_per_mm: [number, number] | null;
  /** The same as a share of the work of the pull. */
  lost_share: number;
  lost_share_interval: [number, number] | null;
  /** Strain that remains after unloading. */
  left_strain: number;
  left_strain_interval: [number, number] | null;
  /** Change of the greatest stress from the first cycle to the last, as a part of the first. */
  closes_within: number;
  rest_sizes: RestSizeResult[];
  yarn: YarnResult;
  notes: string[];
}

/** A file of any kind that holds a chart. */
export interface ImportRequest {
  /** `.txt` (K/P lines, written rows, KnitSpeak), `.ks`, `.png`, `.json` (design) or `.k` (knitout). */
  file: UploadedFile;
}

/** The content of a file. */
export interface ImportResult {
  /** Lines of x (stitch) and . (no stitch), the top row first; a full rectangle if left out. */
  outline: string | null;
  regions: DesignRegion[];
  repeats: DesignRepeat[];
  shelf: ShelfPattern[];
  /** K/P lines, the top row first, as seen from the face. */
  chart: string;
  /** Of a design. */
  name: string | null;
  material: string | null;
  note: string | null;
  rows: number;
  columns: number;
  /** A repeat: K/P, the top row first, rows separated by /. */
  repeat: string;
  /** What may have been read wrongly or lost, such as a region. */
  notes: string[];
}

/** A part of a list of jobs, latest first. */
export interface JobPage {
  jobs: JobStatus[];
  /** Send it to get the next page; null at the end. */
  next_cursor: string | null;
}

/** Where a job stands. */
export type JobState = "waiting" | "running" | "done" | "failed" | "cancelled" | "interrupted";

/** A job as its owner sees it. */
export interface JobStatus {
  id: string;
  kind: string;
  state: JobState;
  /** Share done, where the computation reports it. */
  progress: number;
  /** Why it failed or was interrupted. */
  problem: Problem | null;
  created_at: string;
  started_at: string | null;
  finished_at: string | null;
}

/** How a relaxed size became known. */
export type KnownBy = "gauge" | "relaxation";

/** A stress-strain curve, transverse direction free. */
export interface LawCurve {
  strain: number[];
  stress_n_per_mm: number[];
}

/** A law as its stiffnesses, as its moduli and Poisson ratios, or as both if they agree. */
export interface LawDocument {
  stiffness_xxxx: number | null;
  stiffness_yyyy: number | null;
  stiffness_xxyy: number | null;
  stiffness_yyxx: number | null;
  modulus_course: number | null;
  modulus_wale: number | null;
  poisson_yx: number | null;
  poisson_xy: number | null;
  alpha_xx: number;
  alpha_yy: number;
  beta_xx: number;
  beta_yy: number;
  /** N/mm */
  shear_modulus: number;
  kappa_xx: number;
  kappa_yy: number;
  shear_stiffening: number;
}

/** Standard errors of a law's constants. */
export interface LawErrors {
  stiffness_xxxx_n_per_mm: number;
  stiffness_yyyy_n_per_mm: number;
  stiffness_xxyy_n_per_mm: number;
  stiffness_yyxx_n_per_mm: number;
  alpha_xx: number;
  alpha_yy: number;
  beta_xx_n_per_mm: number;
  beta_yy_n_per_mm: number;
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  /** Contraction wale-wise when pulled course-wise. */
  poisson_yx: number;
  /** Contraction course-wise when pulled wale-wise. */
  poisson_xy: number;
  /** Recommended reduction only; mostly that of its prior, a factor of 1.5. */
  shear_modulus_n_per_mm: number | null;
  kappa_xx: number | null;
  kappa_yy: number | null;
}

/** The constants of a constitutive law. */
export interface LawResult {
  stiffness_xxxx_n_per_mm: number;
  stiffness_yyyy_n_per_mm: number;
  stiffness_xxyy_n_per_mm: number;
  stiffness_yyxx_n_per_mm: number;
  alpha_xx: number;
  alpha_yy: number;
  beta_xx_n_per_mm: number;
  beta_yy_n_per_mm: number;
  /** An assumption unless it was fitted or calibrated. */
  shear_modulus_n_per_mm: number;
  /** Share of the strain across in the stiffening. */
  kappa_xx: number;
  kappa_yy: number;
  /** Growth of the shear stiffness with the angle squared, 1/rad². */
  shear_stiffening: number;
}

/** Which laws of the paper's yarns: refitted clamp to clamp, or as published. */
export type Laws = "refitted" | "published";

/** Errors for the library's yarns when each is left out; rms errors are factors. */
export interface LeftOutResult {
  measured: Fabric[];
  values: number;
  strain_rms_factor: number;
  modulus_rms_factor: number;
  modulus_median_factor: number;
  /** Share predicted within a factor of two. */
  modulus_within_two: number;
  alpha_rms_factor: number;
  beta_rms_factor: number;
  /** Of the 90 % intervals. */
  modulus_coverage: number;
  strain_coverage: number;
}

/** A sleeve for any limb. */
export interface Limb {
  ease?: number;
  /** Target pressure; takes precedence over the ease. */
  target_mmhg?: number | null;
  template: "limb";
  /** [position_mm, circumference_mm] along the limb. */
  profile: [number, number][];
  body?: Fabric;
  hem?: Fabric;
  hem_mm?: number;
}

/** A tube on a limb. */
export interface LimbInput {
  /** Circumference of the unworn tube. */
  rest_mm: number;
  /** Circumference of the limb. */
  worn_mm: number;
}

/** Fit at one place along the limb. */
export interface LimbPlaceResult {
  at_mm: number;
  /** Around the unworn tube. */
  rest_mm: number;
  /** Around the limb. */
  girth_mm: number;
  /** Tube over limb, minus one; negative where it is stretched. */
  ease: number;
  /** Mean pressure, from axially free to axially fixed; null where there is none. */
  mmhg: [number, number] | null;
  /** The same, widened by the 90 % interval of the chart's stress. */
  mmhg_with_spread: [number, number] | null;
  /** Strain around the limb over that at which the chart is locked. */
  lock_up_share: number;
  /** Why there is no pressure, such as a loose fit. */
  problem: string;
}

/** A tube of a chart, and a limb by its girths. */
export interface LimbRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Around the limb. */
  direction?: Direction;
  /** From one end to the other; between them sizes change evenly. */
  girths: TubeGirth[];
}

/** Fit along the limb; no medical class. */
export interface LimbResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "limb";
  places: LimbPlaceResult[];
  /** Where the tube is nearest to its lock-up. */
  tightest_mm: number;
  /** Length along the limb on which the tube is loose. */
  loose_mm: number;
  /** Name of the shape, for 3D views, if the whole chart is the tube. */
  id: string | null;
  /** Of the whole chart on the limb, held by nothing along it. */
  length_mm: number | null;
  relaxed_length_mm: number | null;
  notes: string[];
}

/** Limits on the effort of knitting; null for no limit. */
export interface LimitsInput {
  /** Loops moved between the beds, per stitch. */
  transfers_per_stitch?: number | null;
  /** Yarn between face and back, per stitch. */
  crossings_per_stitch?: number | null;
  /** Knits minus purls over all stitches, either way. */
  curl?: number | null;
}

/** Force and motion of an edge at each step. */
export interface LoadedEdge {
  edge: string;
  kind: string;
  /** Force on the whole edge; 0 for a tape. */
  force_x_n: number[];
  force_y_n: number[];
  /** Mean displacement of the edge. */
  moved_x_mm: number[];
  moved_y_mm: number[];
  force_x_interval_n: [number[], number[]];
  force_y_interval_n: [number[], number[]];
  moved_x_interval_mm: [number[], number[]];
  moved_y_interval_mm: [number[], number[]];
}

/** One way of a cycle. */
export interface LoopLeg {
  loading: boolean;
  /** From the rest size without friction. */
  strain: number[];
  transverse_strain: number[];
  stress_n_per_mm: number[];
}

/** What to outline. */
export interface MarkRequest {
  box?: BoxInput | null;
}

/** A material in full. */
export interface MaterialDetail {
  id: string;
  name: string;
  description: string;
  notes: string[];
  bending_modulus_n_mm2: number | null;
  bending_modulus_sd_n_mm2: number | null;
  compression_stiffness_n_per_mm3: number | null;
  compression_exponent: number | null;
  fabrics: Partial<Record<Fabric, FabricDetail>>;
  /** Null for a material that lacks one of the four fabrics. */
  stitch_table: StitchTableResult | null;
  /** Curves of the laws. */
  curves: Partial<Record<Fabric, Record<Direction, LawCurve>>>;
  /** Curves of the stretch tests, if they are stored with the material. */
  measured: Partial<Record<Fabric, Record<Direction, CurveDocument>>>;
}

/** A material file. */
export interface MaterialDocument {
  format: "knitcore-material";
  version: 1;
  identifier: string;
  name: string;
  yarn: YarnDocument;
  fabrics: Partial<Record<Fabric, FabricDocument>>;
  note: string;
}

/** A material by its identifier. */
export interface MaterialRequest {
  /** Identifier of a material of the library. */
  identifier: string;
}

/** A summary of a material. */
export interface MaterialSummary {
  id: string;
  name: string;
  description: string;
  fabrics: Partial<Record<Fabric, FabricSummary>>;
  /** You may replace and remove it. */
  added_by_you: boolean;
}

/** The library. */
export interface Materials {
  materials: MaterialSummary[];
}

/** A number that an extension adds. */
export interface MeasureResult {
  identifier: string;
  /** Null where it has no finite value. */
  value: number | null;
  unit: string;
  description: string;
}

/** The model refitted from the packaged tables, and its leave-one-yarn-out figures. */
export interface ModelReport {
  yarns: number;
  /** K in Y = K B / L³, geometric mean. */
  modulus_constant: Partial<Record<Fabric, Record<Direction, number>>>;
  alpha: Partial<Record<Fabric, Record<Direction, number>>>;
  beta_n_per_mm: Partial<Record<Fabric, Record<Direction, number>>>;
  left_out: LeftOutResult[];
}

/** The place nearest to its lock-up at the last step. */
export interface NearestLockUp {
  utilisation: number;
  /** From 0, the bottom row. */
  row: number;
  /** From 0, at the left. */
  column: number;
  direction: Direction;
  fabric: string;
}

/** A new link with its secret. */
export interface NewShare {
  id: string;
  mode: ShareMode;
  created_at: string;
  /** The design is at /api/v1/shared/{token} for who has this. */
  token: string;
}

/** The request of an operation without inputs. */
export interface NoRequest {

}

/** Where the constants of a law come from. */
export type Origin = "measured" | "simulated" | "fitted" | "estimated";

/** Energy and size of a stitch in another shape of the repeat. */
export interface OtherShapeResult {
  energy_n_mm: number;
  cell_course_mm: number;
  cell_wale_mm: number;
}

/** A fabric, and how far a strip of it hangs over the edge of a table. */
export interface OverhangRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** Of the yarn, g/m: weigh some metres; tex divided by 1000. */
  linear_density_g_per_m: number;
  chart: string | PureFabricChart;
  /** Along the strip. */
  direction?: Direction;
  /** Beyond the edge; that which falls by 41.5° if left out. */
  overhang_mm?: number | null;
  /** Also return the corners of the sheet. */
  corners?: boolean;
}

/** A strip at rest. */
export interface OverhangResult {
  kind: "overhang";
  overhang_mm: number;
  /** From the edge to the tip, below the horizontal. */
  angle_deg: number;
  /** How far out the tip is. */
  reach_mm: number;
  /** How far down the tip is. */
  fall_mm: number;
  /** By Peirce's formula from overhang and angle. */
  bending_length_mm: number;
  /** Weight per area times the bending length cubed. */
  rigidity_n_mm: number;
  /** That with which the strip was bent. */
  yarn_level_rigidity_n_mm: number;
  weight_g_per_m2: number;
  converged: boolean;
  piece: ClothPiece;
  /** Corners of the sheet line by line, mm; null outside the piece. */
  corners_mm: (([number, number, number] | null)[])[] | null;
  notes: string[];
}

/** The design's state after strokes were kept. */
export interface Painted {
  revision: number;
  changed_at: string;
  /** What looks different now: the strokes and one around. */
  map: StitchKinds;
}

/** Colours that carry a meaning; the page sends those of its theme. */
export interface Palette {
  /** By default that of the yarn's name. */
  yarn?: string | null;
  stockinette?: string;
  garter?: string;
  rib?: string;
  seed?: string;
}

/** Symmetry of a connecting segment: even between like stitches, odd between unlike ones. */
export type Parity = "even" | "odd";

/** A chart as typed text. */
export interface ParseRequest {
  /** K/P lines, the top row first, as seen from the face; or separated by /. */
  text: string;
}

/** A chart in canonical form and its smallest repeat. */
export interface ParsedChart {
  rows: number;
  columns: number;
  /** K/P lines, the top row first, as seen from the face. */
  text: string;
  /** A repeat: K/P, the top row first, rows separated by /. */
  repeat: string;
}

/** A region of one repeat. */
export interface PatchResult {
  /** A repeat: K/P, the top row first, rows separated by /. */
  repeat: string;
  stitches: number;
  /** Of its first stitch: from 0, the bottom row. */
  row: number;
  /** From 0, at the left. */
  column: number;
  /** Of the repeat; null without a target. */
  deviation_course: number | null;
  deviation_wale: number | null;
  /** Of the patch in the finite swatch; null if it was not pulled. */
  swatch_course: number | null;
  swatch_wale: number | null;
  /** Of the patch, in the finite swatch if it was pulled there. */
  modulus_course_n_per_mm: number;
  /** 90 % interval; includes that of a large cloth of the repeat. */
  modulus_course_interval_n_per_mm: [number, number];
  modulus_wale_n_per_mm: number;
  modulus_wale_interval_n_per_mm: [number, number];
}

/** A repeat with a name. */
export interface PatternResult {
  id: string;
  name: string;
  /** A repeat: K/P, the top row first, rows separated by /. */
  repeat: string;
  note: string;
}

/** All named patterns. */
export interface Patterns {
  patterns: PatternResult[];
}

/** A piece cut from cloth, and the conditions on its edges at the last step. */
export interface PieceInput {
  /** Corners in mm; side 1 goes from the first to the second. */
  outline: [number, number][];
  /** Corners of each hole; their sides continue the numbering. */
  holes?: [number, number][][];
  /** Angle from the x axis to the rows, counter-clockwise: 45 is on the bias. */
  grain_deg?: number;
  /** Names of parts of the boundary, by the numbers of their sides. */
  edges: Record<string, number[]>;
  conditions: (HeldInput | PulledInput | TractionInput | SewnInput)[];
}

/** Cloth, the piece cut from it, and the conditions on its edges. */
export interface PieceRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Steps of the load. */
  steps?: number;
  /** C_xyxy; that of the laws by default. */
  shear_modulus_n_per_mm?: number | null;
  /** Length of an element's side; by default there are about 600 elements. */
  mesh_mm?: number | null;
  piece: PieceInput;
  /** Whether to return the final shape and strains. */
  fields?: boolean;
}

/** Equilibria of a piece under a growing load. */
export interface PieceResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  /** Energy stored in the cloth. */
  energy_n_mm: number[];
  converged: boolean;
  seconds: number;
  nodes: number;
  elements: number;
  /** Largest alpha * strain at the last step; 1 is the lock-up. */
  utilisation: number;
  messages: string[];
  kind: "piece";
  /** Share of the load at each step. */
  share: number[];
  area_mm2: number;
  /** In the order of the conditions. */
  edges: LoadedEdge[];
  shape: DeformedPiece | null;
}

/** Where a linked repeat lies. */
export interface Placement {
  /** From 0, the bottom row or the left column. */
  row: number;
  /** From 0, the bottom row or the left column. */
  column: number;
  rows: number;
  columns: number;
}

/** A chart and its material; constants of a shaped piece are those of the largest rectangle inside its outline, its size is that of the whole. */
export interface PredictRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Measured gauge of the chart; its relaxed size is estimated if left out. */
  gauge?: GaugeInput | null;
  /** Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out. */
  outline?: string | null;
  /** Further numbers, by the names of installed extensions. */
  measures?: string[];
}

/** Effective elastic constants of the whole chart at small strain, with 90 % intervals. */
export interface PredictResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  extensibility_course_mm_per_n: number;
  extensibility_wale_mm_per_n: number;
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  /** Contraction wale-wise when pulled course-wise. */
  poisson_yx: number;
  /** Contraction course-wise when pulled wale-wise. */
  poisson_xy: number;
  /** Size of the chart that the constants describe. */
  rows: number;
  columns: number;
  segments: Record<Direction, SegmentCountsResult>;
  modulus_course_interval_n_per_mm: [number, number];
  modulus_wale_interval_n_per_mm: [number, number];
  poisson_yx_interval: [number, number];
  poisson_xy_interval: [number, number];
  /** Reuss and Voigt bounds, widened where folds require it. */
  modulus_course_bounds_n_per_mm: [number, number];
  modulus_wale_bounds_n_per_mm: [number, number];
  /** An assumption unless it was calibrated. */
  shear_modulus_n_per_mm: number;
  /** Mean width of a stitch at rest. */
  relaxed_course_mm: number;
  /** Mean height of a stitch at rest. */
  relaxed_wale_mm: number;
  relaxed_course_interval_mm: [number, number];
  relaxed_wale_interval_mm: [number, number];
  relaxed_source: string;
  /** Of the whole piece at rest, at its widest. */
  width_mm: number;
  /** Of the whole piece at rest, at its highest. */
  height_mm: number;
  width_interval_mm: [number, number];
  height_interval_mm: [number, number];
  /** measured; estimated; swept; learned; or learned with known size */
  provenance: string;
  method: string;
  /** Chart of the repeat whose relaxation (`relax`, some seconds) has a `gauge` with which these numbers would be more certain; null if there is none. */
  worth_relaxing: string | null;
  notes: string[];
  /** The measures that were asked for. */
  measures: MeasureResult[];
}

/** A tube on a limb: its law, or a fabric or chart of a material, and its sizes. */
export interface PressureRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** The material direction around the limb. */
  direction: Direction;
  /** Circumference of the unworn tube. */
  rest_mm?: number | null;
  /** Circumference of the limb. */
  worn_mm: number;
  /** Target pressure, in place of rest_mm: finds the size of the tube. */
  target_mmhg?: number | null;
  material?: string | null;
  /** A fabric of the material. */
  fabric?: Fabric | null;
  /** A chart of the material, in place of a fabric. */
  chart?: string | PureFabricChart | null;
  /** Constants of a law, by name. */
  law?: Record<string, number> | null;
}

/** Mean pressure; no medical class. */
export interface PressureResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  /** Mean pressure, from axially free to axially fixed. */
  mmhg: [number, number];
  kpa: [number, number];
  /** That range, widened by the 90 % interval of the fabric's stress, if known. */
  mmhg_with_law_spread: [number, number] | null;
  /** Strain around the limb. */
  strain: number;
  rest_mm: number;
  worn_mm: number;
  /** Hoop tension per worn length. */
  tension_n_per_mm: [number, number];
  axial_strain_free: number;
  /** Strain over lock-up strain; null for a chart, whose stitches differ. */
  lock_up_share: number | null;
  /** Sizes that give the target pressure, axially free to axially fixed. */
  rest_mm_for_target: [number, number] | null;
  warnings: string[];
  /** Where the law comes from; empty if unknown. */
  law_source: string;
}

/** What every error response looks like. */
export interface Problem {
  /** The kind of problem: the address of a page about it. */
  type: string;
  title: string;
  status: number;
  /** What is wrong, in words. */
  detail: string;
  /** The input that is to blame. */
  field?: string | null;
  /** What would be accepted. */
  remedy?: string | null;
  /** The largest number that the field would accept, where that is known. */
  most?: number | null;
  /** Of inputs that cannot be used: all that is wrong, at most 100; `field`, `detail` and `remedy` are those of the first. */
  errors?: Fault[];
}

/** Two clamps that hold the outermost rows or columns and move apart. */
export interface PullInput {
  /** Of the pull. */
  direction?: Direction;
  /** From clamp to clamp: 0.3 is 30 %. */
  strain: number;
}

/** An edge in a clamp that does not turn and moves freely under a force. */
export interface PulledInput {
  kind: "pulled";
  edge: string;
  x_n?: number;
  y_n?: number;
}

/** A pure fabric by name and size. */
export interface PureFabricChart {
  fabric: Fabric;
  columns: number;
  rows: number;
}

/** A quantity that a fabric can be searched for. */
export type Quantity = "modulus_course_n_per_mm" | "modulus_wale_n_per_mm" | "extensibility_course_mm_per_n" | "extensibility_wale_mm_per_n" | "anisotropy" | "poisson_yx" | "poisson_xy" | "stretch_course" | "stretch_wale" | "pressure_course_mmhg" | "pressure_wale_mmhg";

/** A pure fabric in the model. */
export interface RSFabricResult {
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  segments: Record<Direction, RSSegment>;
}

/** A yarn whose shape the paper gives: acrylic or cotton. */
export interface RSRequest {
  /** Identifier of a material of the library. */
  material: string;
}

/** The four fabrics of a yarn. */
export interface RSResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  material: string;
  fabrics: Partial<Record<Fabric, RSFabricResult>>;
}

/** The connecting segments of one direction. */
export interface RSSegment {
  parity: Parity;
  /** lambda, distance of the segment's ends. */
  separation_mm: number;
  /** L, yarn between them. */
  length_mm: number;
  /** v, the ends' tangent across the line between them. */
  slope: number;
  /** phi, tilt out of the cloth; odd segments only. */
  angle_rad: number | null;
  delta: number;
  rigidity_n_per_mm: number;
  modulus_n_per_mm: number;
  /** 90 % interval for the knitted fabric. */
  modulus_interval_n_per_mm: [number, number];
  /** The paper's value for this modulus. */
  published_n_per_mm: number | null;
}

/** What one extensibility rectangle stands for. */
export type RectangleGroups = "stitch" | "block" | "region";

/** Reduction of points to constants. */
export type Reduction = "published" | "uniform" | "recommended";

/** One region: its repeat, colour and size, and the initial moduli of its fabric. */
export interface RegionResult {
  extensibility_course_mm_per_n: number;
  extensibility_wale_mm_per_n: number;
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  name: string;
  /** A repeat: K/P, the top row first, rows separated by /. */
  fill: string;
  colour: string;
  stitches: number;
  /** Stitches of its longest row. */
  columns: number;
  /** Rows of its longest column. */
  rows: number;
  /** Size at rest of that many stitches of its fabric, without neighbours. */
  width_mm: number;
  height_mm: number;
  /** 90 % interval, from that of the gauge. */
  width_interval_mm: [number, number];
  height_interval_mm: [number, number];
  yarn_m: number;
  yarn_g: number | null;
  /** Lines of x (part of it) and . (not part of it), the top row first. */
  cells: string;
}

/** A repeat, its yarn, what may be held while it relaxes, and what happened to the fabric. */
export interface RelaxRequest {
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Yarn per stitch; the material's by default. */
  loop_length_mm?: number | null;
  /** Instead of one length: a list for every row of the chart, the bottom row first, of one length for all its stitches or one for each. */
  loop_lengths_mm?: number[][] | null;
  /** Hold the stitches in one plane, as a fabric laid flat; not in the published branch. */
  flat?: boolean;
  /** By default symmetry is only the start: the mirrored shape is followed to the minimum that it leads to without the symmetries of the chart. Shapes that are held, or have friction, keep them; repeats of more than 16 stitches are relaxed in the free branch. */
  branch?: Branch | null;
  convention?: Convention;
  /** Compute again, even if the result is stored. */
  fresh?: boolean;
  /** Coefficient of friction between yarns. Without it, and without the other options that need one, there is no friction. */
  friction?: number | null;
  /** What happened to the fabric before it came to rest, with the friction of the yarn unless a coefficient is given. If only a coefficient is given, as-knitted. */
  history?: History | null;
  /** Hold a stitch at this width. */
  cell_course_mm?: number | null;
  /** Hold a stitch at this height. */
  cell_wale_mm?: number | null;
  /** Return the centre lines of the yarn too. */
  centre_lines?: boolean;
}

/** The shape of least energy, free of force or held; sizes and energies of one stitch. */
export interface RelaxResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "relax";
  branch: Branch;
  convention: Convention;
  /** At least 2 in the free branch, as are the columns. */
  repeat_rows: number;
  repeat_columns: number;
  cell_course_mm: number;
  cell_wale_mm: number;
  /** 90 % interval for knitted cloth; null for a width that was held. */
  cell_course_interval_mm: [number, number] | null;
  cell_wale_interval_mm: [number, number] | null;
  energy_n_mm: number;
  bending_share: number;
  contact_share: number;
  yarn_length_mm: number;
  /** Force per stitch that holds a prescribed width; near 0 where it is free. */
  force_course_n: number | null;
  force_wale_n: number | null;
  min_distance_mm: number | null;
  /** CPU time of the solve, when it was first run. */
  seconds: number;
  /** Whether the result was already stored. */
  known: boolean;
  /** Of the energy; the steps of a history are not counted. */
  evaluations: number;
  converged: boolean;
  yarn: YarnResult;
  starts: StartResult[];
  /** Coefficient of friction that was used; null without friction. */
  friction: number | null;
  /** What the fabric comes to rest after; null without friction. */
  history: History | null;
  /** With friction, the size after each history: the range in which the fabric may rest. */
  rest_sizes: RestSizeResult[] | null;
  /** Whether the shape is a minimum without the mirror symmetries of the chart; null where that was not checked: for shapes that are held, have friction or are of the published branch, for mirrored ones whose free cell has more than 16 stitches, and for cells of 100 stitches and more. */
  minimum: boolean | null;
  /** The mirrored shape from which this one, of less energy, was found. The laws of stored repeats and learned answers are of mirrored shapes, which are nearer to knitted cloth. */
  mirrored: OtherShapeResult | null;
  /** In the mirrored branch: the lower shape that it leads to without its symmetries, if it is not a minimum. */
  unmirrored: OtherShapeResult | null;
  /** Width and height of a stitch in other shapes that were found, whose energy is the same within 0.1 %. Which one is shown is a rule; the intervals cover all. */
  other_minima_mm: [number, number][];
  /** For the `gauge` of other requests about this chart and material, which makes their answers more certain. Null unless the material is simulated, and for pure fabrics, other branches, shapes that are held, other loop lengths than the material's, and friction. */
  gauge: FoundGauge | null;
  notes: string[];
  /** Bottom course first; each runs once across the repeat. */
  centre_lines_mm: [number, number, number][][] | null;
}

/** Measured points and the fitted stress there. */
export interface ResidualPoints {
  strain_along: number[];
  strain_across: number[];
  stress_n_per_mm: number[];
  fitted_n_per_mm: number[];
}

/** Size of a stitch free of force after a history. */
export interface RestSizeResult {
  history: History;
  course_mm: number;
  wale_mm: number;
  /** Over the interval of friction. */
  course_interval_mm: [number, number] | null;
  wale_interval_mm: [number, number] | null;
}

/** Adjacent stitches of one kind in a row. */
export interface Run {
  /** From 0, the bottom row. */
  row: number;
  /** First stitch; from 0, at the left. */
  column: number;
  stitches: string;
}

/** Segments of one direction by their symmetry. */
export interface SegmentCountsResult {
  even: number;
  odd: number;
}

/** A browser that is signed in. */
export interface SessionSummary {
  id: string;
  created_at: string;
  /** Whether it is the session of this request. */
  is_this: boolean;
}

/** An edge with a tape or elastic sewn on, which resists stretching and bends freely. */
export interface SewnInput {
  kind: "sewn";
  edge: string;
  /** Force of the tape over its strain. */
  stiffness_n: number;
}

/** A profile of widths at a stretch. */
export interface ShapeRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  /** Identifier of a material of the library. */
  material: string;
  /** Direction of the pull. */
  direction?: Direction;
  /** From clamp to clamp: 0.3 is 30 %. */
  strain: number;
  /** Stretched width over width at rest, line by line across the pull, from the bottom (wale-wise) or the left (course-wise); null where any width will do. */
  width: (number | null)[];
  /** Stitches in a line. */
  across: number;
  repeats?: "small" | "all";
  /** Fewest lines in a band. */
  smallest_band?: number;
  /** The same seed gives the same chart. */
  seed?: number;
}

/** A chart, and the outline of its swatch. */
export interface ShapeResult {
  kind: "shape";
  rows: number;
  columns: number;
  /** K/P lines, the top row first, as seen from the face. */
  chart: string;
  bands: BandResult[];
  /** Width in the finite swatch, to compare with the target. */
  width: number[];
  wanted: (number | null)[];
  /** Rms of the differences, over the width at rest. */
  rms: number;
  largest: number;
  force_n: number;
  /** Number of swatches that were computed. */
  pulls: number;
  messages: string[];
}

/** A link that was given away; its secret is shown only once, when it is made. */
export interface Share {
  id: string;
  mode: ShareMode;
  created_at: string;
}

/** Rights that a link gives. */
export type ShareMode = "read" | "copy";

/** A link to give away. */
export interface ShareRequest {
  mode?: ShareMode;
}

/** The design behind a link. */
export interface SharedDesign {
  mode: ShareMode;
  document: DesignDocument;
  revision: number;
  changed_at: string;
}

/** A design, as it lies or with its stretch test as an animation. */
export interface SharedViewRequest {
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out. */
  outline?: string | null;
  colour?: Colour;
  /** Values for the colour `field`. */
  field?: FieldColours | null;
  /** Of the design; coloured by `yarn` and `region`. */
  regions?: DesignRegion[];
  palette?: Palette;
  rectangles?: boolean;
  rectangle_groups?: RectangleGroups;
  /** Stitches on a side of a block. */
  rectangle_block?: number;
  stretch?: StretchStep | null;
  /** Show it as it lies, hangs or is worn; not while it is stretched. */
  curl?: Curled | null;
  /** Around it a chart is drawn as yarn that is too large to be drawn whole. */
  focus?: Focus | null;
  /** All steps of the stretch test, not only the one. */
  animated?: boolean;
  /** Dark background of a page. */
  dark?: boolean;
}

/** The links of a design that are not revoked. */
export interface Shares {
  shares: Share[];
}

/** A pattern of the user's. */
export interface ShelfPattern {
  name: string;
  /** A repeat; its rows from the top, separated by /. */
  motif: string;
}

/** Which side faces the knitter. */
export type Side = "RS" | "WS";

/** The user of this request, with all sessions, and what is used of the limits of one user. */
export interface SignedIn {
  user: string;
  /** Latest first; scripts have none. */
  sessions: SessionSummary[];
  /** By the name that a refusal has in `field`. Where there are several processes, figures are of this one, except those of stored things. */
  use: Record<string, Use>;
}

/** The leg of a sock. */
export interface SockLeg {
  ease?: number;
  /** Target pressure; takes precedence over the ease. */
  target_mmhg?: number | null;
  template: "sock-leg";
  ankle_mm: number;
  calf_mm: number;
  length_mm: number;
}

/** The result from one starting shape; null where it failed. */
export interface StartResult {
  name: string;
  outcome: string;
  energy_n_mm: number | null;
  cell_course_mm: number | null;
  cell_wale_mm: number | null;
}

/** Values at the stitches: [step][row * columns + column], bottom row first; 0 where there is no stitch. */
export interface StitchFields {
  strain_course: number[][];
  strain_wale: number[][];
  /** alpha * strain; 1 is the lock-up. */
  utilisation: number[][];
  /** Of the strain along the pull only. */
  strain_course_interval: [number[][], number[][]] | null;
  strain_wale_interval: [number[][], number[][]] | null;
  utilisation_interval: [number[][], number[][]];
}

/** One of the 16 kinds of stitch, by its odd segments: left 1, right 2, below 4, above 8. */
export interface StitchKind {
  extensibility_course_mm_per_n: number;
  extensibility_wale_mm_per_n: number;
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  code: number;
  modulus_course_interval_n_per_mm: [number, number];
  modulus_wale_interval_n_per_mm: [number, number];
  /** Shares of the four phases. */
  fractions: Partial<Record<Fabric, number>>;
}

/** Kinds of the stitches in a box; a material's `stitches` table says what each kind does. */
export interface StitchKinds {
  /** Bottom row of the box; from 0, the bottom row of the chart. */
  row: number;
  /** Left column of the box; from 0, at the left. */
  column: number;
  /** A hexadecimal digit for each stitch, bottom row first: its kind, 0 to 15. */
  kinds: string[];
}

/** Values for all 16 kinds of stitch. */
export interface StitchTableResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  codes: StitchKind[];
}

/** A chart between two clamps, which hold the outermost stitches, and how it is pulled. */
export interface StretchRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Measured gauge of the chart; its relaxed size is estimated if left out. */
  gauge?: GaugeInput | null;
  /** Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out. */
  outline?: string | null;
  /** Along rows, or along columns. */
  direction: Direction;
  /** Last clamp-to-clamp strain: 0.5 is 50 %. Give this or a force. */
  strain?: number | null;
  /** Last force on the clamps, in place of a strain. */
  force_n?: number | null;
  steps?: number;
  /** Ends gripped, or free to slide along the clamps. */
  clamps?: Clamps;
  model?: EnergyModel;
  /** C_xyxy in N/mm; that of the laws by default. */
  shear_modulus_n_per_mm?: number | null;
  /** Size course-wise; from the gauge by default. */
  width_mm?: number | null;
  /** Size wale-wise; from the gauge by default. */
  length_mm?: number | null;
}

/** The curve of a test, with fields at its stitches. */
export interface StretchResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  strain: number[];
  force_n: number[];
  force_interval_n: [number[], number[]];
  /** Force per width; its relative interval is that of the force. */
  stress_n_per_mm: number[];
  waist_strain: number[];
  waist_strain_interval: [number[], number[]];
  iterations: number[];
  converged: boolean;
  seconds: number;
  dofs: number;
  width_mm: number;
  length_mm: number;
  /** Whether C_xyxy is the paper's assumption rather than measured. */
  shear_modulus_assumed: boolean;
  nearest_lock_up: NearestLockUp | null;
  messages: string[];
  kind: "stretch";
  /** Name of this test, for the 3D view. */
  id: string;
  rows: number;
  columns: number;
  stitch_fields: StitchFields;
}

/** A state of a stretch test that was run before. */
export interface StretchStep {
  /** The id that the stretch test returned. */
  id: string;
  step: number;
}

/** Paint: new values of stitches, so that strokes of several people merge. */
export interface Strokes {
  /** Size of the chart that was painted on. */
  rows: number;
  columns: number;
  runs: Run[];
}

/** A measured swatch of the yarn. */
export interface SwatchInput {
  fabric: Fabric;
  /** Constants of its law, by name. */
  law: Record<string, number>;
  loop_length_mm: number;
  /** Needle or stitch setting. */
  setting?: string;
}

/** A repeat, its yarn and the stretch. */
export interface SweepRequest {
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Yarn per stitch; the material's by default. */
  loop_length_mm?: number | null;
  /** Instead of one length: a list for every row of the chart, the bottom row first, of one length for all its stitches or one for each. */
  loop_lengths_mm?: number[][] | null;
  /** Hold the stitches in one plane, as a fabric laid flat; not in the published branch. */
  flat?: boolean;
  branch?: Branch;
  convention?: Convention;
  /** Compute again, even if the result is stored. */
  fresh?: boolean;
  /** Coefficient of friction between yarns. Without it, and without the other options that need one, there is no friction. */
  friction?: number | null;
  /** Along rows, or along columns. */
  direction: Direction;
  /** Largest strain: 0.5 is 50 %. */
  max_strain: number;
  points?: number;
  /** Keep the yarn from sliding where it touches at rest. The published branch does so for seed along the course, as the paper did, and has no other setting. */
  slide_quenching?: boolean;
  /** Release the fabric again until it is free of force, with friction: that of the yarn unless a coefficient is given. */
  there_and_back?: boolean;
}

/** A stretch, free across; sizes and energies of one stitch. */
export interface SweepResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "sweep";
  direction: Direction;
  branch: Branch;
  strain: number[];
  /** 90 % interval for knitted cloth, at each stress. */
  strain_interval: [number[], number[]];
  transverse_strain: number[];
  stress_n_per_mm: number[];
  /** Of bending and contact, without losses to friction. */
  energy_n_mm: number[];
  bending_share: number[];
  contact_share: number[];
  /** Points at which the shape changes abruptly. */
  jumps: number[];
  /** Relaxed size of one stitch. */
  cell_course_mm: number;
  cell_wale_mm: number;
  /** Coefficient of friction that was used; null without friction. */
  friction: number | null;
  /** Index of the largest strain, where the fabric turns; null without the way back, as are the next three. */
  turn: number | null;
  /** Energy lost there and back per area of fabric, N·mm/mm². */
  lost_per_cycle_n_per_mm: number | null;
  /** The same as a share of the work of the pull. */
  lost_share: number | null;
  /** Strain that remains after the release. */
  left_strain: number | null;
  law: SweptLaw | null;
  converged: boolean;
  /** CPU time of the solves, when they were first run. */
  seconds: number;
  /** Whether the result was already stored. */
  known: boolean;
  yarn: YarnResult;
  notes: string[];
}

/** Law fitted to stretches along courses and along wales; stiffnesses and errors in N/mm. */
export interface SweptLaw {
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  /** Contraction wale-wise when pulled course-wise. */
  poisson_yx: number;
  /** Contraction course-wise when pulled wale-wise. */
  poisson_xy: number;
  stiffness_xxxx: number;
  stiffness_yyyy: number;
  stiffness_xxyy: number;
  stiffness_yyxx: number;
  alpha_xx: number;
  alpha_yy: number;
  beta_xx: number;
  beta_yy: number;
  /** Upper end of the fitted range of stress. */
  max_stress_n_per_mm: number;
  largest_strain_course: number;
  largest_strain_wale: number;
  rms_course_n_per_mm: number;
  rms_wale_n_per_mm: number;
}

/** One target property of a fabric. */
export interface TargetInput {
  quantity: Quantity;
  /** Stretch as a strain: 0.5 is 50 %. */
  value: number;
  /** Relative (0.1 is 10 %); a difference for Poisson's ratios. */
  tolerance?: number;
  weight?: number;
  /** Load of a target stretch, per width of cloth. */
  load_n_per_mm?: number;
  /** For a pressure. */
  limb?: LimbInput | null;
}

/** A load spread evenly along an edge, per length at rest. */
export interface TractionInput {
  kind: "traction";
  edge: string;
  x_n_per_mm?: number;
  y_n_per_mm?: number;
}

/** A square and how far it is sheared. */
export interface TrellisRequest {
  /** Of the library's yarns: refitted clamp to clamp (default), or as published. */
  laws?: Laws | null;
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Steps of the load. */
  steps?: number;
  /** C_xyxy; that of the laws by default. */
  shear_modulus_n_per_mm?: number | null;
  /** Length of an element's side; by default there are about 600 elements. */
  mesh_mm?: number | null;
  /** How far the frame's right angle closes at the last step. */
  angle_deg: number;
  /** Side of the square. */
  side_mm?: number;
  /** Angle from a bar of the frame to the rows. */
  grain_deg?: number;
}

/** A simulated trellis (picture frame) test. */
export interface TrellisResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  /** Energy stored in the cloth. */
  energy_n_mm: number[];
  converged: boolean;
  seconds: number;
  nodes: number;
  elements: number;
  /** Largest alpha * strain at the last step; 1 is the lock-up. */
  utilisation: number;
  messages: string[];
  kind: "trellis";
  angle_deg: number[];
  /** Force that pulls two opposite corners of the frame apart. */
  force_n: number[];
  force_interval_n: [number[], number[]];
  /** Moment about the hinges: work per radian of shear. */
  moment_n_mm: number[];
  /** Moment over the relaxed area. */
  shear_stress_n_per_mm: number[];
}

/** Circumferences at one place. */
export interface TubeGirth {
  /** Along the limb, from where the tube begins. */
  at_mm: number;
  /** Around the limb. */
  girth_mm: number;
  /** Around the unworn tube. Left out at all places, the whole chart is the tube. */
  rest_mm?: number | null;
}

/** A repeat, its yarn, and how many stitches go around. */
export interface TubeRequest {
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Yarn per stitch; the material's by default. */
  loop_length_mm?: number | null;
  /** Stitches around, a multiple of the repeat's columns. */
  wales: number;
  /** Whether the face is outside. */
  face_outside?: boolean;
}

/** A tube free of force, and the same repeat as a flat fabric. */
export interface TubeResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "tube";
  wales: number;
  face_outside: boolean;
  /** Of the surface at the mean height of the yarn. */
  diameter_mm: number;
  /** 90 % interval for knitted cloth. */
  diameter_interval_mm: [number, number];
  /** Width of a stitch, around on that surface. */
  cell_course_mm: number;
  cell_course_interval_mm: [number, number];
  /** Height of a stitch. */
  cell_wale_mm: number;
  cell_wale_interval_mm: [number, number];
  /** Of a stitch. */
  energy_n_mm: number;
  /** Width of a stitch of the flat fabric. */
  flat_course_mm: number;
  flat_wale_mm: number;
  flat_energy_n_mm: number;
  yarn: YarnResult;
  notes: string[];
}

/** A file's name and its content. */
export interface UploadedFile {
  name: string;
  /** The file, base64. */
  content: string;
}

/** How much of a limit is used. */
export interface Use {
  used: number;
  most: number;
}

/** A kept state with its document. */
export interface Version {
  /** From 1, oldest first. */
  number: number;
  name: string;
  /** Kept by the service before a restore replaced it. */
  automatic: boolean;
  revision: number;
  created_at: string;
  document: DesignDocument;
}

/** A name for the design's present state. */
export interface VersionRequest {
  name: string;
}

/** The program and its versions. */
export interface VersionResult {
  /** Version of the program, as `knitcore --version` prints it. */
  version: string;
  /** Version of the REST API, as in its addresses after /api/. */
  api: string;
}

/** A kept state of a design. */
export interface VersionSummary {
  /** From 1, oldest first. */
  number: number;
  name: string;
  /** Kept by the service before a restore replaced it. */
  automatic: boolean;
  revision: number;
  created_at: string;
}

/** All kept states of a design. */
export interface Versions {
  versions: VersionSummary[];
}

/** A design and how to show it. */
export interface ViewRequest {
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Lines of x (stitch) and . (no stitch), the top row first; all stitches if left out. */
  outline?: string | null;
  colour?: Colour;
  /** Values for the colour `field`. */
  field?: FieldColours | null;
  /** Of the design; coloured by `yarn` and `region`. */
  regions?: DesignRegion[];
  palette?: Palette;
  rectangles?: boolean;
  rectangle_groups?: RectangleGroups;
  /** Stitches on a side of a block. */
  rectangle_block?: number;
  stretch?: StretchStep | null;
  /** Show it as it lies, hangs or is worn; not while it is stretched. */
  curl?: Curled | null;
  /** Around it a chart is drawn as yarn that is too large to be drawn whole. */
  focus?: Focus | null;
}

/** The view of a design and its address. */
export interface ViewResult {
  /** Stitches drawn as yarn. */
  stitches: number;
  /** Where the shapes of the stitches come from. */
  source: string;
  /** Length of the line below the fabric. */
  scale_mm: number;
  /** For a browser; after the # the pass to watch this view. */
  url: string;
}

/** A chart, its yarn, and when to stop. */
export interface WholeRequest {
  chart: string | PureFabricChart;
  /** Identifier of a material of the library. */
  material: string;
  /** Yarn per stitch; the material's by default. */
  loop_length_mm?: number | null;
  /** Hold the stitches in one plane, as a fabric laid flat. */
  flat?: boolean;
  convention?: Convention;
  /** Stop when a round changes the energy by less than this part of it, and the sizes by less than ten times this part. */
  tolerance?: number;
  /** Most rounds on each of two grids. */
  rounds?: number;
  /** Return the centre lines of the yarn too. */
  centre_lines?: boolean;
}

/** The shape of a whole chart, free of force; sizes and energies of its mean stitch. */
export interface WholeResult {
  /** What the 90 % intervals rest on. */
  interval_source: string;
  kind: "whole";
  rows: number;
  columns: number;
  cell_course_mm: number;
  cell_wale_mm: number;
  /** 90 % interval for knitted cloth. */
  cell_course_interval_mm: [number, number];
  cell_wale_interval_mm: [number, number];
  energy_n_mm: number;
  bending_share: number;
  contact_share: number;
  min_distance_mm: number;
  /** Whether the last round met the tolerance. */
  converged: boolean;
  /** On both grids together. */
  rounds: number;
  /** Part of the energy that the last round took away. */
  energy_change: number;
  /** Larger relative change of width and height in the last round. */
  size_change: number;
  /** Part of the energy that further rounds may take away: the last change times all rounds. */
  may_fall: number;
  /** That is left on the yarn. */
  largest_force_n: number;
  /** CPU time since the job was last started. */
  seconds: number;
  yarn: YarnResult;
  notes: string[];
  /** Bottom course first; each runs once across the chart. */
  centre_lines_mm: [number, number, number][][] | null;
}

/** Stiffness wanted in one part of the chart. */
export interface WishInput {
  name?: string;
  /** Its stitches as runs [row, first column, length], with row 0 at the bottom. */
  runs: [number, number, number][];
  modulus_course_n_per_mm?: number | null;
  modulus_wale_n_per_mm?: number | null;
}

/** Pressure at one place along the limb. */
export interface WornResult {
  at_mm: number;
  part: string;
  rest_mm: number;
  worn_mm: number;
  ease: number;
  strain: number | null;
  mmhg: [number, number] | null;
  kpa: [number, number] | null;
  warnings: string[];
}

/** A brace, knitted sideways and grafted. */
export interface WristBrace {
  ease?: number;
  /** Target pressure; takes precedence over the ease. */
  target_mmhg?: number | null;
  template: "wrist-brace";
  wrist_mm: number;
  length_mm: number;
  edge_mm?: number;
}

/** The yarn of a material; every field is optional. */
export interface YarnDocument {
  fibre: string;
  product: string;
  bending_modulus_n_mm2: number | null;
  bending_modulus_sd_n_mm2: number | null;
  compression_stiffness_n_per_mm3: number | null;
  compression_exponent: number | null;
  diameter_mm: number | null;
  friction: number | null;
  friction_interval: [number, number] | null;
}

/** A yarn by its parameters. */
export interface YarnInput {
  /** Name of a yarn that is given by the five numbers below. */
  name: string;
  /** B of the yarn. */
  bending_modulus_n_mm2: number;
  /** k of its contact law. */
  contact_stiffness_n_per_mm3: number;
  /** p of its contact law. */
  contact_exponent: number;
  /** Outer radius. */
  radius_mm: number;
  /** Core radius. */
  core_radius_mm: number;
}

/** The yarn that was used, and the source of its numbers. */
export interface YarnResult {
  bending_modulus_n_mm2: number;
  contact_stiffness_n_per_mm3: number;
  contact_exponent: number;
  radius_mm: number;
  core_radius_mm: number;
  provenance: string;
  estimated: boolean;
}
