import type { Run } from "./data";
import { h } from "./dom";
import { fixed } from "./format";
import { Player } from "./player";
import { SceneView, hasWebGl, type Paint, type View } from "./scene";
import { SliceView } from "./slice";

const STEP = 1 / 400; // of the whole time, for a press of an arrow key

function select(label: string, options: [value: string, text: string][], value: string, change: (value: string) => void): HTMLElement {
  const field = h("select", {});
  for (const [v, text] of options) field.append(h("option", { value: v, selected: v === value }, text));
  field.addEventListener("change", () => change(field.value));
  return h("label", { class: "field" }, h("span", {}, label), field);
}

/** Play, pause, scrub: one strip for both views. */
function controls(runs: Run[], player: Player): HTMLElement {
  const button = h("button", { type: "button", class: "play", id: "play" }, "Play");
  const range = h("input", {
    type: "range", id: "scrub", min: 0, max: 1000, step: 1, "aria-label": "Time of the replay",
  });
  const clock = h("output", { class: "clock", id: "clock", for: "scrub" });
  const length = player.end - player.start || 1; // a run of a single moment
  button.addEventListener("click", () => player.toggle());
  range.addEventListener("input", () =>
    player.seek(player.start + (Number(range.value) / 1000) * length));

  const bands = h("div", { class: "bands", "aria-hidden": "true" });
  const place = (from: number, to: number, kind: string, title: string): void => {
    const share = (t: number): number => Math.min(Math.max((t - player.start) / length, 0), 1) * 100;
    bands.append(h("div", { class: `band ${kind}`, style: `left:${share(from)}%;width:${share(to) - share(from)}%`, title }));
  };
  const replay = runs.find((run) => run.replay)!.replay!;
  const withAir = replay.frames.filter((f) => f.slices.size > 0);
  if (withAir.length > 0) place(withAir[0]!.time, withAir[withAir.length - 1]!.time, "air", "air is computed");
  for (const [from, to] of replay.valveOpen) place(from, to, "valve", "valve commanded open");

  const show = (time: number): void => {
    const label = player.playing ? "Pause" : "Play";
    if (button.textContent !== label) button.textContent = label;
    button.classList.toggle("playing", player.playing);
    range.value = String(Math.round((1000 * (time - player.start)) / length));
    range.setAttribute("aria-valuetext", `${fixed(time * 1e3, 1)} milliseconds`);
    clock.textContent = `${fixed(time * 1e3, 2)} ms`;
  };
  player.onChange(show);
  show(player.time);

  const speeds = Player.slowdowns.map((s): [string, string] => [String(s), s === 1 ? "real time" : `1/${s}`]);
  return h("div", { class: "controls" },
    button, clock, h("div", { class: "timeline" }, range, bands),
    select("Speed", speeds, String(player.slowdown), (s) => (player.slowdown = Number(s))));
}

/** The slice and the same in 3D, side by side, under one clock. */
export function replayView(runs: Run[], player: Player): HTMLElement | null {
  const shown = runs.filter((run) => run.replay && run.replay.frames.length > 0);
  const first = shown[0];
  if (!first) return null;
  const replay = first.replay!;
  const panels = h("div", { class: "panels" });
  const air = shown.find((run) => run.replay!.rasters.length > 0);
  let slice: SliceView | undefined;
  let scene: SceneView | undefined;

  if (air) {
    slice = new SliceView(shown, player);
    slice.select(air, 0);
    const options = shown.flatMap((run, r) => run.replay!.rasters.map((raster, n): [string, string] =>
      [`${r} ${n}`, shown.length > 1 ? `${raster.name}, ${run.name}` : raster.name]));
    const chooser = select("Plane", options, `${shown.indexOf(air)} 0`, (value) => {
      const [r, n] = value.split(" ").map(Number) as [number, number];
      slice!.select(shown[r]!, n);
      scene?.select(shown[r]!);
    });
    panels.append(h("div", { class: "panel" },
      h("div", { class: "panel-head" }, h("h3", {}, "Slice"), options.length > 1 ? chooser : null, slice.legend), slice.canvas));
  }
  if (replay.bodies.length > 0 || air) {
    const head = h("div", { class: "panel-head" }, h("h3", {}, "In space"));
    const panel = h("div", { class: "panel" }, head);
    if (hasWebGl()) {
      scene = new SceneView(shown, player);
      if (air) scene.select(air);
      const views = h("div", { class: "tabs", role: "group", "aria-label": "Look from" });
      const wanted: View[] = [...(air ? ["jet" as const] : []), ...(replay.bodies.length > 0 ? ["flight" as const] : []), "side", "above",
        ...(replay.bodies.length > 0 ? ["follow" as const] : [])];
      for (const view of wanted) {
        const tab = h("button", { type: "button" }, view.charAt(0).toUpperCase() + view.slice(1));
        tab.addEventListener("click", () => scene!.look(view));
        views.append(tab);
      }
      head.append(views);
      if (replay.bodies.length > 0) {
        const paint: Paint = air ? "body" : "speed";  // where there is no air, the bodies are the subject
        scene.colourBy(paint);
        head.append(select("Colour", [["body", "by body"], ["speed", "by speed"]], paint, (p) => scene!.colourBy(p as Paint)), scene.legend);
      }
      panel.append(scene.canvas);
    } else {
      panel.append(h("p", { class: "missing" }, "The view in space needs WebGL, which this browser does not offer."));
    }
    panels.append(panel);
  }

  const view = h("div", { class: "replay", tabindex: 0, role: "group", "aria-label": "Replay" }, panels, controls(shown, player),
    h("p", { class: "hint" },
      shown.some((run) => run.replay!.valveOpen.length > 0) ? h("span", { class: "key-band valve" }, "valve commanded open") : null,
      air ? h("span", { class: "key-band air" }, "air computed") : null,
      "Space plays and pauses, arrow keys step. Drag in space to turn, scroll to zoom. In a chart below, a click goes to that " +
      "moment, dragging zooms, a double click shows all."));
  view.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (["SELECT", "BUTTON"].includes(target.tagName)) return;
    const step = (player.end - player.start) * STEP;
    if (event.key === " ") player.toggle();
    else if (event.key === "ArrowRight") player.seek(player.time + step);
    else if (event.key === "ArrowLeft") player.seek(player.time - step);
    else return;
    event.preventDefault();
  });
  return view;
}
