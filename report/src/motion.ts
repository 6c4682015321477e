import type { Frame, Pose, Quat, Replay, Surface, Vec3 } from "./data";

/** Index of the last frame that is not later than `time`. */
export function frameIndex(frames: Frame[], time: number): number {
  let low = 0;
  let high = frames.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (frames[middle]!.time <= time + 1e-12) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Pose of body `b`, between frames: straight in position, the short arc in orientation. */
export function poseAt(replay: Replay, b: number, time: number): Pose | undefined {
  const n = frameIndex(replay.frames, time);
  const from = replay.frames[n];
  const to = replay.frames[n + 1];
  const p = from?.poses[b];
  const q = to?.poses[b];
  if (!from || !to || !p || !q) return p;
  const s = Math.min(Math.max((time - from.time) / (to.time - from.time), 0), 1);
  const near = p.orientation.reduce((sum, v, d) => sum + v * q.orientation[d]!, 0) < 0 ? -1 : 1;
  const mixed = p.orientation.map((v, d) => (1 - s) * v + s * near * q.orientation[d]!);
  const length = Math.hypot(...mixed);
  return {
    position: p.position.map((v, d) => (1 - s) * v + s * q.position[d]!) as Vec3,
    orientation: mixed.map((v) => v / length) as Quat,
  };
}

/** Places of the grains shown, between frames, into `out`; far away where one is not there. */
export function grainsAt(replay: Replay, time: number, out: Float32Array): void {
  const n = frameIndex(replay.frames, time);
  const from = replay.frames[n];
  const to = replay.frames[n + 1] ?? from;
  if (!from?.grains || !to?.grains) return void out.fill(1e6);
  const s = to === from ? 0 : Math.min(Math.max((time - from.time) / (to.time - from.time), 0), 1);
  for (let k = 0; k < out.length; ++k) {
    const [p, q] = [from.grains[k]!, to.grains[k]!];
    const at = Number.isNaN(q) ? p : (1 - s) * p + s * q;
    out[k] = Number.isNaN(at) ? 1e6 : at;
  }
}

/** Speed of body `b` between the frames around `time`, m/s; undefined where it is not there. */
export function speedAt(replay: Replay, b: number, time: number): number | undefined {
  const n = Math.min(frameIndex(replay.frames, time), replay.frames.length - 2);
  const from = replay.frames[n];
  const to = replay.frames[n + 1];
  const p = from?.poses[b];
  const q = to?.poses[b];
  if (!from || !to || !p || !q) return undefined;
  return Math.hypot(...p.position.map((v, d) => q.position[d]! - v)) / (to.time - from.time);
}

/** Highest speed of any body between two frames, m/s. */
export function fastestBody(replay: Replay): number {
  let fastest = 0;
  for (const { time } of replay.frames)
    for (let b = 0; b < replay.bodies.length; ++b) fastest = Math.max(fastest, speedAt(replay, b, time) ?? 0);
  return fastest;
}

/** Rotation matrix, row by row. */
export function matrixOf([w, x, y, z]: Quat): number[] {
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}

/** Vertices in the world, xyz after xyz. */
export function placed(surface: Surface, pose: Pose): Float64Array {
  const m = matrixOf(pose.orientation);
  const v = surface.vertices;
  const out = new Float64Array(v.length);
  for (let n = 0; n < v.length; n += 3)
    for (let d = 0; d < 3; ++d)
      out[n + d] =
        pose.position[d]! + m[3 * d]! * v[n]! + m[3 * d + 1]! * v[n + 1]! + m[3 * d + 2]! * v[n + 2]!;
  return out;
}

/** Largest distance of a vertex from the centre, m. */
export function radius(surface: Surface): number {
  let largest = 0;
  for (let n = 0; n < surface.vertices.length; n += 3)
    largest = Math.max(largest, Math.hypot(...surface.vertices.subarray(n, n + 3)));
  return largest;
}

/** Convex outline of points in a plane (Andrew's monotone chain). */
export function hull(points: [number, number][]): [number, number][] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list: [number, number][]): [number, number][] => {
    const chain: [number, number][] = [];
    for (const p of list) {
      while (chain.length > 1) {
        const [a, b] = [chain[chain.length - 2]!, chain[chain.length - 1]!];
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    chain.pop();
    return chain;
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
