/** What the service says about inverse design, as far as the page uses it. */

export interface AtlasTable {
  material: string;
  repeats: string[];
  modulus_course_n_per_mm: number[];
  modulus_course_low: number[];
  modulus_course_high: number[];
  modulus_wale_n_per_mm: number[];
  modulus_wale_low: number[];
  modulus_wale_high: number[];
  poisson_yx: number[];
  poisson_xy: number[];
  stretch_course: number[];
  stretch_wale: number[];
  relaxed_course_mm: (number | null)[];
  relaxed_wale_mm: (number | null)[];
  transfers_per_stitch: number[];
  crossings_per_stitch: number[];
  curl: number[];
  provenance: string[];
}

export interface Candidate {
  material: string;
  chart: string;
  values: Record<string, number | null>;
  intervals: Record<string, [number | null, number | null]>;
  deviations: Record<string, number | null>;
  misfit: number | null;
  reached: boolean;
  provenance: string;
  transfers_per_stitch: number;
  crossings_per_stitch: number;
  curl: number;
}

export interface Found {
  reached: boolean;
  message: string;
  searched: number;
  ranges: Record<string, [number, number]>;
  candidates: Candidate[];
  elsewhere: Candidate[];
}

export interface Filled {
  rows: number;
  columns: number;
  chart: string;
  off_share: number;
  patches: {
    repeat: string;
    stitches: number;
    row: number;
    column: number;
    deviation_course: number | null;
    deviation_wale: number | null;
    swatch_course: number | null;
    swatch_wale: number | null;
  }[];
  messages: string[];
}

export interface Shaped {
  rows: number;
  columns: number;
  chart: string;
  bands: { repeat: string; first: number; lines: number }[];
  width: number[];
  wanted: (number | null)[];
  rms: number;
  largest: number;
  force_n: number;
  pulls: number;
  messages: string[];
}

export interface Point {
  key: string;
  index: number;
  x: number;
  y: number;
}

export interface Wanted {
  quantity: string;
  value: number;
  tolerance: number;
  weight: number;
  load_n_per_mm?: number;
  limb?: { rest_mm: number; worn_mm: number };
}
