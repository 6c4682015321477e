/** What the page shows: the JSON written by `report_json` (docs/files.md), decoded. SI units. */

export type Vec3 = [number, number, number];
/** w, x, y, z; turns body axes into the world. */
export type Quat = [number, number, number, number];

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type JsonObject = { [key: string]: Json };

export interface Column {
  name: string;
  unit: string;
}

export interface Table {
  columns: Column[];
  values: Float32Array[];
}

export interface Raster {
  name: string;
  axis: number;
  position: number;
  lower: [number, number];
  upper: [number, number];
  pixels: [number, number];
}

export interface Surface {
  name: string;
  vertices: Float32Array;
  triangles: Uint32Array;
}

export interface Plate {
  name: string;
  edge: Vec3;
  along: Vec3;
  across: Vec3;
  length: number;
  width: number;
  thickness: number;
}

export interface Nozzle {
  position: Vec3;
  direction: Vec3;
  diameter: number;
}

export interface Pose {
  position: Vec3;
  orientation: Quat;
}

/** Speed = pixel / 255 * fullScale, m/s. */
export interface SliceFrame {
  fullScale: number;
  pixels: Uint8Array;
}

/** Grains among the bodies: every so-manieth is shown. */
export interface GrainCloud {
  count: number;
  shown: number;
  diameter: number;
}

export interface Frame {
  time: number;
  /** By body; undefined before it has come and after it has gone. */
  poses: (Pose | undefined)[];
  /** By raster; missing where no air is computed. */
  slices: Map<number, SliceFrame>;
  /** x y z of each grain shown, one after the other; NaN: not there. */
  grains?: Float32Array;
}

export interface Replay {
  domain: [Vec3, Vec3];
  rasters: Raster[];
  bodies: Surface[];
  plates: Plate[];
  nozzles: Nozzle[];
  grains?: GrainCloud;
  undisturbed: Vec3[][];
  valveOpen: [number, number][];
  /** Time, s, and how far the valve is open, 0 to 1. */
  valveOpening: [number, number][];
  frames: Frame[];
}

/** A diagram as the run made it; labels name quantity and unit. */
export interface Figure {
  title: string;
  x_label: string;
  y_label: string;
  series: { label: string; x: number[]; y: number[]; dashed: boolean; points: boolean }[];
}

/** Grey, rows from the top. */
export interface Picture {
  title: string;
  width: number;
  height: number;
  pixels: Uint8Array;
}

export interface Run {
  name: string;
  verdict: string;
  result: JsonObject | null;
  manifest: JsonObject | null;
  caseText: string;
  history: Map<string, Table>;
  replay: Replay | null;
  figures: Figure[];
  pictures: Picture[];
}

function bytesOf(base64: string): Uint8Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let n = 0; n < text.length; ++n) bytes[n] = text.charCodeAt(n);
  return bytes;
}

async function inflate(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The shapes below are those of docs/files.md, before decoding.

export interface RawHeader extends Omit<Replay, "bodies" | "valveOpen" | "valveOpening" | "frames"> {
  bodies: { name: string; vertices: string; triangles: string }[];
  valve_open: [number, number][];
  valve_opening?: [number, number][];
}

export interface RawFrame {
  time: number;
  bodies: (number[] | null)[];
  slices: { raster: number; full_scale: number; data: string }[];
  grains?: { lower: Vec3; upper: Vec3; at: string };
}

interface RawRun extends Omit<Run, "caseText" | "history" | "replay" | "figures" | "pictures"> {
  figures: { charts: Figure[]; pictures: (Omit<Picture, "pixels"> & { data: string })[] } | null;
  case: string;
  history: { [name: string]: { columns: Column[]; data: string[] } };
  replay: [] | [RawHeader, ...RawFrame[]];
}

function readGrains({ lower, upper, at }: NonNullable<RawFrame["grains"]>): Float32Array {
  const parts = new Uint16Array(bytesOf(at).buffer);
  return Float32Array.from(parts, (part, n) =>
    part === 65535 ? NaN : lower[n % 3]! + (part / 65534) * (upper[n % 3]! - lower[n % 3]!));
}

/** A line of replay.jsonl but the first. */
export async function readFrame(line: RawFrame): Promise<Frame> {
  const slices = new Map<number, SliceFrame>();
  for (const s of line.slices)
    slices.set(s.raster, { fullScale: s.full_scale, pixels: await inflate(bytesOf(s.data)) });
  const poses = line.bodies.map((b): Pose | undefined => b
    ? { position: b.slice(0, 3) as Vec3, orientation: b.slice(3, 7) as Quat }
    : undefined);
  return { time: line.time, poses, slices, ...(line.grains ? { grains: readGrains(line.grains) } : {}) };
}

/** The first line of replay.jsonl; frames come later. */
export function readHeader(h: RawHeader): Replay {
  return {
    domain: h.domain,
    rasters: h.rasters,
    bodies: h.bodies.map((b) => ({
      name: b.name,
      vertices: new Float32Array(bytesOf(b.vertices).buffer),
      triangles: new Uint32Array(bytesOf(b.triangles).buffer),
    })),
    plates: h.plates,
    nozzles: h.nozzles,
    ...(h.grains ? { grains: h.grains } : {}),
    undisturbed: h.undisturbed,
    valveOpen: h.valve_open,
    valveOpening: h.valve_opening ?? [],
    frames: [],
  };
}

async function readReplay(lines: RawRun["replay"]): Promise<Replay | null> {
  const [h, ...frames] = lines;
  if (!h || frames.length === 0) return null;
  return { ...readHeader(h), frames: await Promise.all(frames.map(readFrame)) };
}

function readTable(t: RawRun["history"][string]): Table {
  return { columns: t.columns, values: t.data.map((d) => new Float32Array(bytesOf(d).buffer)) };
}

async function readRun(r: RawRun): Promise<Run> {
  return {
    name: r.name,
    verdict: r.verdict,
    result: r.result,
    manifest: r.manifest,
    caseText: r.case,
    history: new Map(Object.entries(r.history).map(([name, table]) => [name, readTable(table)])),
    replay: await readReplay(r.replay),
    figures: r.figures?.charts ?? [],
    pictures: await Promise.all((r.figures?.pictures ?? []).map(async ({ data, ...picture }) => ({
      ...picture, pixels: await inflate(bytesOf(data)),
    }))),
  };
}

export async function readRuns(): Promise<Run[]> {
  const data = JSON.parse(document.getElementById("ejecta-data")!.textContent!) as { runs: RawRun[] };
  return Promise.all(data.runs.map(readRun));
}

/** Values of a column, or nothing. */
export function columnOf(table: Table, name: string): Float32Array | undefined {
  const n = table.columns.findIndex((c) => c.name === name);
  return n < 0 ? undefined : table.values[n];
}

/** The box of the air; a run of bodies alone has none. */
export function hasBox(replay: Replay): boolean {
  return replay.domain[1][0] > replay.domain[0][0];
}

/** More bodies than this are shown as a crowd, not one by one. */
export const CROWD = 12;

export function bodiesOf(run: Run): JsonObject[] {
  const bodies = run.result?.["bodies"];
  return Array.isArray(bodies) ? (bodies as JsonObject[]) : [];
}

/** The greatest length of a vector that is given by the histories of its components, and where in them it stands; of what
 * never was anything: 0, at -1. */
export function strongest(components: ArrayLike<number>[]): { size: number; at: number } {
  let most = { size: 0, at: -1 };
  for (let n = 0; n < (components[0]?.length ?? 0); ++n) {
    const size = Math.hypot(...components.map((values) => values[n]!));
    if (size > most.size) most = { size, at: n };
  }
  return most;
}
