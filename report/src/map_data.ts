/** A map as `ejecta map` writes it (docs/files.md). SI units. */

export type Point = [number, number];

export interface MapRun {
  x_m: number;
  y_m: number;
  refinement: number;
  fine: boolean;
  clearance_m: number | null;
  outcome: string;
  directory: string;
  reason?: string;
  wall_time_s: number;
}

export interface MapPlate {
  edge_moved_m: Point;
  area_m2: number;
  area_error_m2: number;
  outlines_m: Point[][];
}

export interface MapResult {
  title: string;
  summary: string;
  state: string;
  body: string;
  area_m2: number;
  area_error_m2: number;
  half_width_across_m: number;
  half_width_across_error_m: number;
  length_before_m: number;
  length_before_error_m: number;
  length_behind_m: number;
  length_behind_error_m: number;
  area_of_plate_as_given_m2: number;
  widest_gap_m: number;
  outlines_m: Point[][];
  sure_m: Point[][];
  possible_m: Point[][];
  symmetric: boolean;
  window_m: [Point, Point];
  footprint_m: Point[];
  jet_half_radius_m: number;
  plates: MapPlate[];
  measured?: { file: string; area_m2: number; area_ratio: number; outline_m: Point[] };
  chance?: { x_m: number[]; y_m: number[]; chance: number[][]; contours: { chance: number; outlines_m: Point[][] }[] };
  paper_resolution: { x_m: number; y_low_m: number; y_high_m: number }[];
  runs_fine: number;
  runs_coarse: number;
  runs: MapRun[];
  contradictions: { x_m: number; y_m: number; clearance_m: number; fine: boolean; chance: number }[];
  mirror_check?: { x_m: number; y_m: number; clearance_m: number; clearance_mirrored_m: number; contradicts: boolean };
  history: { runs: number; area_m2: number; area_error_m2: number }[];
  runs_wall_time_s: number;
  wall_time_s: number;
}

/** The map of this page, if it is the page of one. */
export function readMap(): MapResult | null {
  const data = JSON.parse(document.getElementById("ejecta-data")!.textContent!) as { map?: MapResult };
  return data.map ?? null;
}
