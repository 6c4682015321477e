/** A sorter as `ejecta sort` writes it (docs/files.md). SI units. */

type Point = [number, number];

export interface SortFate {
  fate: string;
  product: string;
  number: number;
  mass_kg: number;
  classes: { [name: string]: { number: number; mass_kg: number } };
}

export interface SortParticle {
  kind: number;
  /** m, along the belt: it comes to a fixed line at x over the belt's speed. */
  x: number;
  y: number;
  fate: string;
  outline: Point[];
  path_from_s: number;
  /** m, from the jets, where air moved it; a point every `path_step_s`. */
  path: [number, number, number][];
}

export interface SortView {
  belt_speed_m_s: number;
  belt_width_m: number;
  camera_m: number;
  drop_m: number;
  stand_off_m: number;
  gravity_m_s2: number;
  valve_pitch_m: number;
  valves: number;
  /** m, from the jets: along and up. */
  plate_m: Point;
  path_step_s: number;
  length_m: number;
  particles: SortParticle[];
  /** x low, x high, y low, y high, whether it is read as to be ejected. */
  objects: [number, number, number, number, boolean][];
  /** valve, from, to. */
  pulses: [number, number, number][];
}

export interface SortResult {
  title: string;
  summary: string;
  particles: number;
  throughput_t_h: number;
  cover: number;
  standing_alone: number;
  air_Nm3: number;
  air_Nm3_per_t: number;
  air_Nm3_per_t_ejected: number;
  air_least_work_kWh_per_t: number;
  shots: number;
  valve_openings: number;
  dead_valves: number;
  tier: string;
  resolved_shots: number;
  wall_time_s: number;
  fates: SortFate[];
  classes: { name: string; belongs_in: string; particles: number; mass_kg: number; ejected: number; ejected_kg: number }[];
  assumptions: { what: string; value: string; reason: string; key: string }[];
  view: SortView;
}

/** The sorter of this page, if it is the page of one. */
export function readSort(): SortResult | null {
  const data = JSON.parse(document.getElementById("ejecta-data")!.textContent!) as { sort?: SortResult };
  return data.sort ?? null;
}
