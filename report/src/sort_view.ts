import { bodyColour, isDark } from "./colour";
import { h } from "./dom";
import { fixed } from "./format";
import { Player } from "./player";
import type { SortParticle, SortResult } from "./sort_data";

const BEHIND_PLATE = 0.1; // m that are shown behind the edge
const BEFORE_CAMERA = 0.06; // m

/** Where a particle is at a time, from the jets: along, across, up; nothing where it is out of the picture. */
function place(p: SortParticle, time: number, sort: SortResult): [number, number, number] | null {
  const v = sort.view;
  if (p.path.length > 1 && time >= p.path_from_s) {
    const at = (time - p.path_from_s) / v.path_step_s;
    const n = Math.floor(at);
    const a = p.path[n];
    const b = p.path[n + 1];
    if (!a || !b) return null;
    return [0, 1, 2].map((d) => a[d]! + (at - n) * (b[d]! - a[d]!)) as [number, number, number];
  }
  const x = v.belt_speed_m_s * time - p.x;
  const top = v.stand_off_m - 0.5 * v.gravity_m_s2 * (v.drop_m / v.belt_speed_m_s) ** 2;
  const flown = Math.max(0, x + v.drop_m) / v.belt_speed_m_s;
  return [x, p.y, top + 0.5 * v.gravity_m_s2 * flown * flown];
}

/** Classes to be ejected in warm colours, those to be kept in cold ones: numbers of `bodyColour`. */
function classColours(sort: SortResult): number[] {
  const warm = [1, 3, 4];
  const cold = [0, 2, 5];
  const next = { ejected: 0, kept: 0 };
  return sort.classes.map((c) =>
    c.belongs_in === "ejected" ? warm[next.ejected++ % 3]! : cold[next.kept++ % 3]!);
}

/** The machine from above and from the side, moving. */
export function sortView(sort: SortResult): HTMLElement {
  const v = sort.view;
  const from = -v.camera_m - BEFORE_CAMERA;
  const to = v.plate_m[0] + BEHIND_PLATE;
  const above = h("canvas", { class: "sort-stage", role: "img", "aria-label": "The sorter from above" });
  const side = h("canvas", { class: "sort-stage", role: "img", "aria-label": "The sorter from the side" });
  const player = new Player(0, v.length_m / v.belt_speed_m_s + 0.15);
  player.time = Math.min(player.end, (v.camera_m + 0.1) / v.belt_speed_m_s + 0.1);
  const colours = classColours(sort);
  const box = { low: -0.02, high: v.stand_off_m + 0.2 };

  const draw = (): void => {
    const dark = isDark();
    const css = getComputedStyle(document.documentElement);
    const [ink, muted, line, surface] = ["--ink", "--muted", "--line", "--surface"].map((n) => css.getPropertyValue(n));
    const colour = (p: SortParticle): string => bodyColour(colours[p.kind]!, dark);
    const start = (canvas: HTMLCanvasElement, heightOfWidth: number): [CanvasRenderingContext2D, number] => {
      const width = canvas.clientWidth || 1100;
      const ratio = devicePixelRatio || 1;
      canvas.width = width * ratio;
      canvas.height = width * heightOfWidth * ratio;
      const g = canvas.getContext("2d")!;
      g.scale(ratio, ratio);
      g.fillStyle = surface!;
      g.fillRect(0, 0, width, width * heightOfWidth);
      g.font = "12px sans-serif";
      return [g, width / (to - from)];
    };
    const label = (g: CanvasRenderingContext2D, text: string, x: number, y: number): void => {
      g.fillStyle = muted!;
      g.fillText(text, x, y);
    };

    { // from above
      const [g, k] = start(above, (v.belt_width_m + 0.03) / (to - from));
      const X = (x: number): number => (x - from) * k;
      const Y = (y: number): number => (0.5 * v.belt_width_m + 0.015 - y) * k;
      g.fillStyle = line!;
      g.fillRect(0, Y(0.5 * v.belt_width_m), X(-v.drop_m), v.belt_width_m * k);
      g.strokeStyle = muted!;
      g.setLineDash([4, 4]);
      g.beginPath();
      g.moveTo(X(-v.camera_m), 0);
      g.lineTo(X(-v.camera_m), above.height);
      g.stroke();
      g.setLineDash([]);
      g.fillStyle = muted!;
      g.fillRect(X(v.plate_m[0]), Y(0.5 * v.belt_width_m), 3, v.belt_width_m * k);
      label(g, "camera", X(-v.camera_m) + 4, 12);
      label(g, "jets", X(0) + 6, 12);
      label(g, "plate", X(v.plate_m[0]) + 6, 12);
      for (let valve = 0; valve < v.valves; ++valve) {
        const y = (valve + 0.5 - 0.5 * v.valves) * v.valve_pitch_m;
        const open = v.pulses.some(([n, a, b]) => n === valve && player.time >= a && player.time < b);
        g.fillStyle = open ? bodyColour(4, dark) : muted!;
        g.beginPath();
        g.arc(X(0), Y(y), open ? 4 : 1.2, 0, 7);
        g.fill();
      }
      for (const p of v.particles) {
        const at = place(p, player.time, sort);
        if (!at || at[0] > to || at[0] < from - 0.05) continue;
        g.fillStyle = colour(p);
        g.globalAlpha = at[0] > v.plate_m[0] && at[2] < v.plate_m[1] ? 0.45 : 1;
        g.beginPath();
        for (const [dx, dy] of p.outline) g.lineTo(X(at[0] - dx), Y(at[1] + dy));
        g.closePath();
        g.fill();
        g.globalAlpha = 1;
      }
      g.lineWidth = 1.5;
      for (const [low, high, left, right, eject] of v.objects) {
        const a = v.belt_speed_m_s * player.time - high;
        const b = v.belt_speed_m_s * player.time - low;
        if (!eject || a < -v.camera_m || a > 0.02) continue;
        g.strokeStyle = ink!;
        g.strokeRect(X(a), Y(right), (b - a) * k, (right - left) * k);
      }
    }
    { // from the side
      const [g, k] = start(side, (box.high - box.low) / (to - from));
      const X = (x: number): number => (x - from) * k;
      const Z = (z: number): number => (box.high - z) * k;
      const top = v.stand_off_m - 0.5 * v.gravity_m_s2 * (v.drop_m / v.belt_speed_m_s) ** 2;
      g.fillStyle = line!;
      g.fillRect(0, Z(top - 0.006), X(-v.drop_m), 5);
      g.fillStyle = muted!;
      g.fillRect(X(v.plate_m[0]), Z(v.plate_m[1]), X(to) - X(v.plate_m[0]), 3);
      g.fillRect(X(0) - 5, Z(0), 10, 0.02 * k);
      label(g, "belt", 6, Z(top) - 14);
      label(g, "valves", X(0) + 10, Z(0) + 12);
      label(g, "ejected", X(v.plate_m[0]) + 6, Z(v.plate_m[1]) - 8);
      label(g, "kept", X(v.plate_m[0]) + 6, Z(v.plate_m[1]) + 18);
      const open = v.pulses.filter(([, a, b]) => player.time >= a && player.time < b).length;
      if (open > 0) {
        g.fillStyle = bodyColour(4, dark);
        g.globalAlpha = Math.min(0.6, 0.15 + 0.03 * open);
        g.beginPath();
        g.moveTo(X(0) - 2, Z(0));
        g.lineTo(X(-0.02), Z(0.17));
        g.lineTo(X(0.02), Z(0.17));
        g.lineTo(X(0) + 2, Z(0));
        g.fill();
        g.globalAlpha = 1;
      }
      for (const p of v.particles) {
        const at = place(p, player.time, sort);
        if (!at || at[0] > to || at[0] < from - 0.05) continue;
        const half = Math.max(...p.outline.map(([dx]) => Math.abs(dx)));
        g.fillStyle = colour(p);
        g.beginPath();
        g.arc(X(at[0]), Z(at[2]), Math.max(2, half * k * 0.8), 0, 7);
        g.fill();
      }
    }
  };
  const slider = h("input", { type: "range", min: 0, max: 1000, step: 1, "aria-label": "Time" });
  const clock = h("output", {});
  const play = h("button", { type: "button" }, "Play");
  const follow = (): void => {
    slider.value = String(Math.round((1000 * player.time) / player.end));
    clock.textContent = `${fixed(player.time * 1e3, 0)} ms`;
    play.textContent = player.playing ? "Pause" : "Play";
    draw();
  };
  player.slowdown = 10;
  player.onChange(follow);
  slider.addEventListener("input", () => player.seek((Number(slider.value) / 1000) * player.end));
  play.addEventListener("click", () => {
    player.toggle();
    follow();
  });
  document.addEventListener("themechange", draw);
  new ResizeObserver(follow).observe(above);
  const key = h("p", { class: "sort-key" }, ...sort.classes.map((c, n) =>
    h("span", {}, h("span", { class: "swatch", "data-body": colours[n]! }), ` ${c.name} `)));
  return h("figure", { class: "sort-view" }, h("div", { class: "sort-controls" }, play, slider, clock), key, above, side,
    h("figcaption", {}, "Ten times slower than it is. Frames: objects that the controller shoots at; discs at the jets: open valves."));
}
