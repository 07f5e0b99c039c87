/** What the service sends and takes; the same names as its OpenAPI document. */

export type Direction = "course" | "wale";
export type FabricName = "stockinette" | "garter" | "rib" | "seed";
export type Interval = [number, number];

export interface FabricSummary {
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  stitch_course_mm: number | null;
  stitch_wale_mm: number | null;
  loop_length_mm: number | null;
}

export interface MaterialSummary {
  id: string;
  name: string;
  description: string;
  fabrics: Partial<Record<FabricName, FabricSummary>>;
}

/** One of the 16 kinds of stitch. */
export interface StitchKind {
  code: number;
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  extensibility_course_mm_per_n: number;
  extensibility_wale_mm_per_n: number;
  modulus_course_interval?: Interval | null;
  modulus_wale_interval?: Interval | null;
  fractions: Partial<Record<FabricName, number>>;
}

export interface Curve {
  strain: number[];
  stress_n_per_mm: number[];
}

export interface Material extends MaterialSummary {
  notes?: string[];
  stitch_table: { codes: StitchKind[] };
  curves: Partial<Record<FabricName, Partial<Record<Direction, Curve>>>>;
  /** Of stretch tests, where they are kept with the material. */
  measured?: Partial<Record<FabricName, Partial<Record<Direction, Curve & { pulls: number }>>>>;
}

export interface Pattern {
  id: string;
  name: string;
  chart: string;
  note?: string;
}

export interface ParsedChart {
  rows: number;
  columns: number;
  text: string;
}

export interface SegmentCounts {
  even: number;
  odd: number;
}

export interface Prediction {
  rows: number;
  columns: number;
  segments: Record<Direction, SegmentCounts>;
  modulus_course_n_per_mm: number;
  modulus_wale_n_per_mm: number;
  poisson_yx: number;
  poisson_xy: number;
  extensibility_course_mm_per_n: number;
  extensibility_wale_mm_per_n: number;
  modulus_course_interval_n_per_mm?: Interval | null;
  modulus_wale_interval_n_per_mm?: Interval | null;
  poisson_yx_interval?: Interval | null;
  poisson_xy_interval?: Interval | null;
  provenance: string;
  notes?: string[];
}

export interface StretchRequest {
  chart: string;
  material: string;
  outline?: string | null;
  direction: Direction;
  strain: number;
  steps: number;
  clamps?: "clamped" | "sliding";
  model?: "published" | "full";
  shear_modulus_n_per_mm?: number | null;
}

/** A computation in the background. */
export interface JobStatus {
  id: string;
  kind: string;
  state: "waiting" | "running" | "done" | "failed" | "cancelled" | "interrupted";
  progress: number;
  problem: Problem | null;
}

export interface CurveRequest {
  chart: string;
  material: string;
  direction: Direction;
  stress_n_per_mm?: number[];
}

/** Strain at each stress, with the ends of its 90 % interval. */
export interface ChartCurve {
  stress_n_per_mm: number[];
  strain: number[];
  strain_low: number[];
  strain_high: number[];
  provenance: string;
}

export interface Stretch {
  id: string;
  strain: number[];
  force_n: number[];
  stress_n_per_mm: number[];
  /** Ends of its 90 % interval, as all that follow here; the service had none of them once. */
  force_low_n?: number[];
  force_high_n?: number[];
  waist_strain: number[];
  waist_margin?: number[];
  iterations: number[];
  converged: boolean;
  seconds: number;
  dofs: number;
  rows: number;
  columns: number;
  messages?: string[];
  /** Values of every stitch, rows bottom first, one list for each step. */
  stitch_fields: Record<string, number[][]>;
  notes?: string[];
}

export interface ViewRequest {
  chart: string;
  material: string;
  /** Lines of x and dots, the top row first; null for a whole rectangle. */
  outline?: string | null;
  colour: string;
  palette?: Partial<Record<FabricName | "yarn", string>>;
  regions?: DesignRegion[];
  rectangles: boolean;
  rectangle_groups?: "stitch" | "block" | "region";
  rectangle_block?: number;
  stretch: { id: string; step: number } | null;
  /** Where a chart is drawn as yarn that is too large to be drawn whole. */
  focus?: { row: number; column: number } | null;
}

export interface View {
  stitches: number;
  /** Where the shapes of the stitches come from. */
  source: string;
  url: string;
}

export type Side = "face" | "back" | "edge" | "angle";

/** A part of the chart with a fill or a yarn of its own; later regions lie on top. */
export interface DesignRegion {
  id: string;
  name: string;
  colour: string;
  yarn: string | null;
  fill: string | null;
  /** [row, column, length] of stitches beside each other; row 0 is the bottom. */
  runs: [number, number, number][];
  locked: boolean;
  hidden: boolean;
}

/** A motif whose placements all follow it. */
export interface DesignRepeat {
  id: string;
  name: string;
  motif: string;
  edge_columns: number;
  edge_rows: number;
  placements: { row: number; column: number; rows: number; columns: number }[];
}

/** What a design holds beside its chart and its names. */
export interface DesignLayout {
  outline: string | null;
  regions: DesignRegion[];
  repeats: DesignRepeat[];
  shelf: { name: string; motif: string }[];
}

/** A design as the project file holds it. */
export interface DesignDocument extends DesignLayout {
  format: "knitcore-design";
  version: 2;
  name: string;
  material: string;
  /** K/P lines, top row first. */
  chart: string;
  note: string;
}

/** Problem details (RFC 9457). */
export interface Problem {
  type: string;
  title: string;
  status: number;
  detail: string;
  field?: string | null;
  remedy?: string | null;
  /** The largest number that the field accepts, where that is known. */
  most?: number | null;
}
