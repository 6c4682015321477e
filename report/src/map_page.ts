import { chart } from "./charts";
import { bodyColour } from "./colour";
import { h, section } from "./dom";
import { duration, fixed, unbroken } from "./format";
import type { MapResult } from "./map_data";
import { mapView } from "./map_view";

const WATCHED_EVERY = 15; // s, while the map grows

function fact(value: number, error: number | undefined, factor: number, digits: number, unit: string, label: string): HTMLElement {
  const text = fixed(value * factor, digits) + (error === undefined ? "" : ` \u00b1 ${fixed(error * factor, digits)}`);
  return h("div", {}, h("dd", {}, text, h("span", { class: "unit" }, ` ${unit}`)), h("dt", {}, label));
}

export function facts(map: MapResult): HTMLElement {
  const list = h("dl", {},
    fact(map.area_m2, map.area_error_m2, 1e6, 0, "mm\u00b2", `${map.chance ? "chance of ejection, integrated" : "area"}; error: 95 % of what the runs allow`),
    fact(map.half_width_across_m, map.half_width_across_error_m, 1e3, 1, "mm", "to either side of the jet"),
    fact(map.length_before_m, map.length_before_error_m, 1e3, 1, "mm", "before the jet: shot early"),
    fact(map.length_behind_m, map.length_behind_error_m, 1e3, 1, "mm", "behind it: shot late"),
    fact(map.widest_gap_m, undefined, 1e3, 0, "mm", "widest circle without a run"));
  if (map.measured) list.append(fact(map.measured.area_ratio, undefined, 100, 0, "%", "of the measured area"));
  return h("div", { class: "cards" }, h("article", { class: "card" }, list));
}

function table(head: string[], rows: (string | Node)[][]): HTMLElement {
  return h("div", { class: "table-holder" }, h("table", {},
    h("thead", {}, h("tr", {}, ...head.map((text, n) => h("th", { scope: "col", class: n > 0 && "number" }, text)))),
    h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row.map((cell, n) =>
      n === 0 ? h("th", { scope: "row" }, cell) : h("td", { class: "number" }, cell)))))));
}

function runsTable(map: MapResult): HTMLElement {
  return h("details", {}, h("summary", {}, `All ${map.runs.length} runs`),
    table(["Run", "x [mm]", "y [mm]", "clearance [mm]", "grid", "time"], map.runs.map((run, n) => [
      h("a", { href: `${run.directory}/report.html` }, `${n + 1}: ${run.outcome}`),
      fixed(run.x_m * 1e3, 1), fixed(run.y_m * 1e3, 1), run.clearance_m === null ? "\u2013" : fixed(run.clearance_m * 1e3, 1),
      run.fine ? "fine" : `\u00d7 ${run.refinement}`, duration(run.wall_time_s),
    ])));
}

function plates(map: MapResult): HTMLElement | null {
  if (map.plates.length === 0) return null;
  const moved = (mm: number, direction: string): string => `${mm > 0 ? "+" : "\u2212"}${fixed(Math.abs(mm), 1)} mm ${direction}`;
  return table(["Plate", "area [mm\u00b2]", "error [mm\u00b2]"], [
    ["as given", fixed(map.area_of_plate_as_given_m2 * 1e6, 0), fixed(map.area_error_m2 * 1e6, 0)],
    ...map.plates.map((p) => [
      p.edge_moved_m[0] !== 0 ? moved(p.edge_moved_m[0] * 1e3, "along the belt") : moved(p.edge_moved_m[1] * 1e3, "up"),
      fixed(p.area_m2 * 1e6, 0), fixed(p.area_error_m2 * 1e6, 0)])]);
}

function historyChart(map: MapResult): HTMLElement | null {
  if (map.history.length < 2) return null;
  const mm2 = (of: (h: MapResult["history"][number]) => number): number[] => map.history.map((one) => of(one) * 1e6);
  const colour = (dark: boolean): string => bodyColour(0, dark);
  return chart({
    title: "How the area moved as runs were added", xLabel: "runs", yLabel: "area [mm\u00b2]",
    x: map.history.map((one) => one.runs),
    series: [
      { label: "area", values: mm2((one) => one.area_m2), colour },
      { label: "95 %, upper", values: mm2((one) => one.area_m2 + one.area_error_m2), colour, dashed: true },
      { label: "95 %, lower", values: mm2((one) => Math.max(0, one.area_m2 - one.area_error_m2)), colour, dashed: true },
    ],
  }, 260);
}

function paperRows(map: MapResult): HTMLElement | null {
  if (map.paper_resolution.length === 0) return null;
  return h("details", {}, h("summary", {}, "At the resolution of measured maps: 3 mm along, 0.5 mm across"),
    table(["x [mm]", "ejected from y [mm]", "to y [mm]"],
      map.paper_resolution.map((row) => [fixed(row.x_m * 1e3, 0), fixed(row.y_low_m * 1e3, 1), fixed(row.y_high_m * 1e3, 1)])));
}

function contradictions(map: MapResult): HTMLElement | null {
  const mirror = map.mirror_check;
  if (map.contradictions.length === 0 && !mirror) return null;
  return h("ul", { class: "assumptions" }, mirror && h("li", {},
    h("p", { class: "what" }, mirror.contradicts ? "The mirror image is not what the case claims." : "The claimed symmetry holds where it was tried."),
    h("p", {}, `At x ${fixed(mirror.x_m * 1e3, 1)}, y \u00b1${fixed(mirror.y_m * 1e3, 1)} mm the clearances are ${fixed(mirror.clearance_m * 1e3, 1)} and ${fixed(mirror.clearance_mirrored_m * 1e3, 1)} mm.`)),
  ...map.contradictions.map((c) => h("li", {},
    h("p", { class: "what" }, `The run at x ${fixed(c.x_m * 1e3, 1)}, y ${fixed(c.y_m * 1e3, 1)} mm contradicts the map.`),
    h("p", {}, `Its clearance is ${fixed(c.clearance_m * 1e3, 1)} mm; the others give its verdict a chance of ${(100 * c.chance).toPrecision(2)} %.`))));
}

export function mapPage(map: MapResult): HTMLElement {
  if (map.state === "running") setTimeout(() => location.reload(), WATCHED_EVERY * 1e3);
  const main = h("main", { id: "content" }, h("header", { class: "verdict" },
    h("p", { class: "title" }, map.title + (map.state === "running" ? " \u00b7 still growing" : "")),
    h("h1", { id: "verdict" }, unbroken(map.summary)), facts(map)));
  const add = (id: string, title: string, note: string, ...content: (Node | null)[]): void => {
    if (content.some(Boolean)) main.append(section(id, title, note, ...content));
  };
  add("map", "Map", "Where the particle would be when the shot is timed for x = 0, seen from above, to scale. Each mark opens its run.", mapView(map));
  add("contradictions", "Contradictions", "Runs whose verdict the others make unlikely.", contradictions(map));
  add("growth", "Runs", `${map.runs_fine} fine, ${map.runs_coarse} coarse; ${duration(map.runs_wall_time_s)} of runs in ${duration(map.wall_time_s)}.`,
    historyChart(map), runsTable(map), paperRows(map));
  add("plates", "Plate", "From the same runs: where the edge is not known better than this.", plates(map));
  const links = [...main.querySelectorAll("section")].map((s) => h("a", { href: `#${s.id}` }, s.querySelector("h2")!.textContent));
  return h("div", {}, h("a", { class: "skip", href: "#content" }, "Skip to the map"),
    h("nav", { "aria-label": "Sections" }, h("span", { class: "brand" }, "Ejecta"), ...links), main,
    h("footer", {}, "Ejecta \u00b7 one file, works offline; marks link to the runs beside it"));
}
