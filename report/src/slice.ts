import { AIR_COLOURS, bodyColour, paintAir } from "./colour";
import type { Raster, Run, SliceFrame } from "./data";
import { h } from "./dom";
import { fixed, short, ticks } from "./format";
import { frameIndex, placed, poseAt } from "./motion";
import type { Player } from "./player";

const AXES = ["x", "y", "z"];

/** Fastest air in any frame of any slice, m/s: the top of the colour scale. */
export function fastestAir(run: Run): number {
  return Math.max(1e-9, ...run.replay!.frames.flatMap((f) => [...f.slices.values()].map((s) => s.fullScale)));
}

/** A colour scale from rest to `top` m/s. */
export function speedBar(title: string, colours: Uint8ClampedArray, top: number): HTMLElement[] {
  const bar = h("canvas", { width: 256, height: 1, "aria-hidden": "true" });
  bar.getContext("2d")!.putImageData(new ImageData(new Uint8ClampedArray(colours), 256, 1), 0, 0);
  return [h("span", {}, `${title} 0`), bar, h("span", {}, `${top < 10 ? short(top, 2) : fixed(top, 0)} m/s`)];
}

/** A painted slice, ready to be drawn or used as a texture. */
export class AirImage {
  readonly canvas = document.createElement("canvas");
  private readonly image: ImageData;
  private shown = -1;

  constructor(
    private readonly run: Run,
    readonly raster: number,
    readonly top: number,
  ) {
    const [width, height] = run.replay!.rasters[raster]!.pixels;
    this.canvas.width = width;
    this.canvas.height = height;
    this.image = new ImageData(width, height);
  }

  /** Paints the air at `time`; false when it is painted already. */
  show(time: number): boolean {
    const frames = this.run.replay!.frames;
    const n = frameIndex(frames, time);
    if (n === this.shown) return false;
    this.shown = n;
    const slice = frames[n]!.slices.get(this.raster);
    if (slice) paintAir(slice.pixels, this.image.width, slice.fullScale / this.top, this.image.data, true);
    else this.image.data.fill(0);
    this.canvas.getContext("2d")!.putImageData(this.image, 0, 0);
    return true;
  }
}

interface Plane {
  raster: Raster;
  first: number;
  second: number;
}

function planeOf(raster: Raster): Plane {
  const [first, second] = [0, 1, 2].filter((d) => d !== raster.axis) as [number, number];
  return { raster, first, second };
}

/** Draws a body's shadow on the plane: its triangles, lit, the nearer over the farther. False when it is elsewhere. */
function drawBody(
  c: CanvasRenderingContext2D, run: Run, b: number, time: number, plane: Plane, colour: string,
  toX: (v: number) => number, toY: (v: number) => number,
): boolean {
  const surface = run.replay!.bodies[b]!;
  const pose = poseAt(run.replay!, b, time);
  if (!pose) return false;
  const v = placed(surface, pose);
  const { first, second, raster } = plane;
  const beyond = (d: number, side: 0 | 1): boolean => {
    let [low, high] = [Infinity, -Infinity];
    for (let n = d; n < v.length; n += 3) [low, high] = [Math.min(low, v[n]!), Math.max(high, v[n]!)];
    return high < raster.lower[side] || low > raster.upper[side];
  };
  if (beyond(first, 0) || beyond(second, 1)) return false;
  const towards = raster.axis === 1 ? -1 : 1; // the viewer of (x, z) stands at negative y
  const faces: { depth: number; light: number; points: [number, number][] }[] = [];
  const outline = new Map<number, [number, number]>(); // edges of one face only: those between front and back
  for (let t = 0; t < surface.triangles.length; t += 3) {
    const corner = [0, 1, 2].map((n) => 3 * surface.triangles[t + n]!);
    const at = (n: number, d: number): number => v[corner[n]! + d]!;
    const e1 = [0, 1, 2].map((d) => at(1, d) - at(0, d));
    const e2 = [0, 1, 2].map((d) => at(2, d) - at(0, d));
    const normal = [
      e1[1]! * e2[2]! - e1[2]! * e2[1]!, e1[2]! * e2[0]! - e1[0]! * e2[2]!, e1[0]! * e2[1]! - e1[1]! * e2[0]!,
    ];
    const size = Math.hypot(...normal) || 1;
    if (normal[raster.axis]! * towards <= 0) continue;
    for (let n = 0; n < 3; ++n) {
      const [a, e] = [corner[n]!, corner[(n + 1) % 3]!];
      const key = Math.min(a, e) * v.length + Math.max(a, e);
      if (!outline.delete(key)) outline.set(key, [a, e]);
    }
    faces.push({
      depth: towards * (at(0, raster.axis) + at(1, raster.axis) + at(2, raster.axis)),
      light: (0.35 * normal[first]! + 0.6 * normal[second]! + 0.7 * towards * normal[raster.axis]!) / size,
      points: [0, 1, 2].map((n) => [toX(at(n, first)), toY(at(n, second))]),
    });
  }
  faces.sort((a, f) => a.depth - f.depth);
  const trace = (points: [number, number][]): void => {
    points.forEach(([x, y], n) => (n ? c.lineTo(x, y) : c.moveTo(x, y)));
    c.closePath();
  };
  c.lineJoin = "round";
  c.lineWidth = 3.5;
  c.strokeStyle = colour;
  c.lineCap = "round";
  c.beginPath();
  for (const [a, e] of outline.values()) {
    c.moveTo(toX(v[a + first]!), toY(v[a + second]!));
    c.lineTo(toX(v[e + first]!), toY(v[e + second]!));
  }
  c.stroke();
  c.lineWidth = 0.6;
  for (const f of faces) {
    const grey = Math.round(120 + 100 * Math.max(0, f.light));
    c.fillStyle = c.strokeStyle = `rgb(${grey},${grey - 6},${grey - 14})`;
    c.beginPath();
    trace(f.points);
    c.fill();
    c.stroke();
  }
  return true;
}

/** The air in one plane with the bodies in it. */
export class SliceView {
  readonly canvas = h("canvas", { class: "stage", role: "img" });
  readonly legend = h("div", { class: "legend" });
  private readonly ghosts = document.createElement("canvas");
  private image!: AirImage;
  private plane!: Plane;
  private run!: Run;

  constructor(
    private readonly runs: Run[],
    private readonly player: Player,
  ) {
    player.onChange(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  select(run: Run, raster: number): void {
    this.run = run;
    this.image = new AirImage(run, raster, fastestAir(run));
    this.plane = planeOf(run.replay!.rasters[raster]!);
    this.canvas.style.aspectRatio = String(this.aspect());
    this.legend.replaceChildren(...speedBar("Air speed", AIR_COLOURS, this.image.top));
    this.draw();
  }

  private aspect(): number {
    const { lower, upper } = this.plane.raster;
    return Math.min(Math.max((upper[0] - lower[0]) / (upper[1] - lower[1]), 0.75), 2.4);
  }

  draw(): void {
    const { canvas, player } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!this.image || width === 0 || height === 0) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const c = canvas.getContext("2d")!;
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);

    const { lower, upper, axis } = this.plane.raster;
    const margin = { left: 46, right: 12, top: 12, bottom: 34 };
    const scale = Math.min(
      (width - margin.left - margin.right) / (upper[0] - lower[0]),
      (height - margin.top - margin.bottom) / (upper[1] - lower[1]));
    const w = (upper[0] - lower[0]) * scale;
    const ht = (upper[1] - lower[1]) * scale;
    const left = margin.left + (width - margin.left - margin.right - w) / 2;
    const top = margin.top + (height - margin.top - margin.bottom - ht) / 2;
    const toX = (v: number): number => left + (v - lower[0]) * scale;
    const toY = (v: number): number => top + ht - (v - lower[1]) * scale;

    c.strokeStyle = "rgba(255,255,255,0.10)";
    c.fillStyle = "rgba(226,234,245,0.75)";
    c.font = "11px ui-sans-serif, system-ui, sans-serif";
    c.lineWidth = 1;
    c.textAlign = "center";
    for (const t of ticks(lower[0] * 1e3, upper[0] * 1e3, w / 70)) {
      c.beginPath();
      c.moveTo(toX(t / 1e3), top);
      c.lineTo(toX(t / 1e3), top + ht);
      c.stroke();
      c.fillText(fixed(t, 0), toX(t / 1e3), top + ht + 15);
    }
    c.textAlign = "right";
    for (const t of ticks(lower[1] * 1e3, upper[1] * 1e3, ht / 55)) {
      c.beginPath();
      c.moveTo(left, toY(t / 1e3));
      c.lineTo(left + w, toY(t / 1e3));
      c.stroke();
      c.fillText(fixed(t, 0), left - 6, toY(t / 1e3) + 4);
    }
    c.fillText(`${AXES[this.plane.first]} [mm]`, left + w, top + ht + 29);
    c.textAlign = "left";
    c.fillText(`${AXES[this.plane.second]} [mm]`, left + 6, top + 14);

    this.image.show(player.time);
    c.imageSmoothingQuality = "high";
    c.drawImage(this.image.canvas, left, top, w, ht);
    c.save();
    c.beginPath();
    c.rect(left, top, w, ht);
    c.clip();
    let inView = 0;
    for (const run of this.runs) {
      const layer = run === this.run ? c : this.ghostLayer(ratio);
      run.replay?.bodies.forEach((_, b) => {
        if (drawBody(layer, run, b, player.time, this.plane, bodyColour(b, true), toX, toY)) ++inView;
      });
      if (layer === c) continue;
      c.globalAlpha = 0.5;
      c.drawImage(this.ghosts, 0, 0, width, height);
      c.globalAlpha = 1;
    }
    c.restore();
    c.strokeStyle = "rgba(255,255,255,0.25)";
    c.strokeRect(left, top, w, ht);
    const notes = [
      this.sliceNow() ? "" : "air no longer computed",
      inView > 0 || this.run.replay!.bodies.length === 0 ? "" : "no body in this view",
    ].filter(Boolean);
    c.fillStyle = "rgba(226,234,245,0.75)";
    c.textAlign = "left";
    c.fillText(notes.join(", "), left + 6, top + ht - 8);
    if (!player.playing)
      canvas.setAttribute("aria-label", `Air speed in the plane ${AXES[axis]} = ` +
        `${fixed(this.plane.raster.position * 1e3, 1)} mm at ${fixed(player.time * 1e3, 2)} ms, up to ` +
        `${fixed(this.sliceNow()?.fullScale ?? 0, 1)} m/s, with the bodies drawn to scale.`);
  }

  /** Bodies of the other run are drawn apart and laid over as a whole, so that their faces do not shine through. */
  private ghostLayer(ratio: number): CanvasRenderingContext2D {
    this.ghosts.width = this.canvas.width;
    this.ghosts.height = this.canvas.height;
    const layer = this.ghosts.getContext("2d")!;
    layer.setTransform(ratio, 0, 0, ratio, 0, 0);
    return layer;
  }

  private sliceNow(): SliceFrame | undefined {
    const frames = this.run.replay!.frames;
    return frames[frameIndex(frames, this.player.time)]!.slices.get(this.image.raster);
  }
}
