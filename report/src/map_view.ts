import { h, svg } from "./dom";
import { fixed, ticks } from "./format";
import type { MapResult, MapRun, Point } from "./map_data";

const clearanceText = (run: MapRun): string =>
  run.clearance_m === null ? run.outcome
    : `${fixed(Math.abs(run.clearance_m) * 1e3, 1)} mm ${run.clearance_m > 0 ? "above" : "below"} the edge`;

export function runText(run: MapRun): string {
  return `x ${fixed(run.x_m * 1e3, 1)}, y ${fixed(run.y_m * 1e3, 1)} mm: ${clearanceText(run)} (${run.fine ? "fine" : "coarse"} run)`;
}

const box = (points: Point[]): [Point, Point] => points.reduce(
  ([low, high], p) => [[Math.min(low[0], p[0]), Math.min(low[1], p[1])], [Math.max(high[0], p[0]), Math.max(high[1], p[1])]] as [Point, Point],
  [[Infinity, Infinity], [-Infinity, -Infinity]] as [Point, Point]);

/** The map from above, to scale: belt moves to the right. */
export function mapView(map: MapResult): HTMLElement {
  const holder = h("div", { class: "map-view" });
  const [[wx0, wx1], [wy0, wy1]] = map.window_m;
  const foot = map.footprint_m.length > 0 ? box(map.footprint_m) : undefined;
  const footWidth = foot ? foot[1][0] - foot[0][0] : 0;
  const margin = { left: 46, right: 16, top: 30, bottom: 46 };

  const draw = (): void => {
    const width = Math.max(holder.clientWidth, 300);
    const scale = Math.min((width - margin.left - margin.right) / (wx1 - wx0), 620 / (wy1 - wy0));
    const [plotWidth, plotHeight] = [(wx1 - wx0) * scale, (wy1 - wy0) * scale];
    const left = margin.left + Math.max(0, (width - margin.left - margin.right - plotWidth) / 2);
    const height = plotHeight + margin.top + margin.bottom;
    const X = (x: number): number => left + (x - wx0) * scale;
    const Y = (y: number): number => margin.top + (wy1 - y) * scale;
    const path = (polygons: Point[][]): string => polygons.map((polygon) =>
      `${polygon.map((p, n) => `${n ? "L" : "M"}${X(p[0]).toFixed(1)} ${Y(p[1]).toFixed(1)}`).join("")}Z`).join("");

    const root = svg("svg", {
      width, height, viewBox: `0 0 ${width} ${height}`, role: "group",
      "aria-label": `Map seen from above, x along the belt to the right, y across it, in millimetres. ${map.summary}`,
    });
    for (const x of ticks(wx0 * 1e3, wx1 * 1e3, Math.max(4, plotWidth / 80)))
      root.append(svg("line", { x1: X(x / 1e3), x2: X(x / 1e3), y1: Y(wy1), y2: Y(wy0), class: "grid" }),
        svg("text", { x: X(x / 1e3), y: Y(wy0) + 18, "text-anchor": "middle" }, fixed(x, 0)));
    for (const y of ticks(wy0 * 1e3, wy1 * 1e3, Math.max(3, plotHeight / 60)))
      root.append(svg("line", { x1: X(wx0), x2: X(wx1), y1: Y(y / 1e3), y2: Y(y / 1e3), class: "grid" }),
        svg("text", { x: X(wx0) - 8, y: Y(y / 1e3) + 4, "text-anchor": "end" }, fixed(y, 0)));
    root.append(
      svg("text", { x: X(wx1), y: height - 8, "text-anchor": "end" }, "x along the belt at the shot [mm]"),
      svg("text", { x: 4, y: 14 }, "y across [mm]"));
    // Direction of travel.
    root.append(svg("path", { d: `M${X(wx1) - 96} 12h52m-7 -4l7 4l-7 4`, class: "travel" }),
      svg("text", { x: X(wx1), y: 16, "text-anchor": "end" }, "travel"));

    if (map.chance) { // cells of the raster, darker the likelier, and lines of equal chance
      const { x_m: xs, y_m: ys, chance, contours } = map.chance;
      const [dx, dy] = [xs[1]! - xs[0]!, ys[1]! - ys[0]!];
      chance.forEach((row, j) => row.forEach((p, i) => {
        if (p < 0.01) return;
        const [x0, x1] = [Math.max(xs[i]! - dx / 2, wx0), Math.min(xs[i]! + dx / 2, wx1)];
        const [y0, y1] = [Math.max(ys[j]! - dy / 2, wy0), Math.min(ys[j]! + dy / 2, wy1)];
        root.append(svg("rect", { x: X(x0), y: Y(y1), width: X(x1) - X(x0) + 0.3, height: Y(y0) - Y(y1) + 0.3, class: "chance", "fill-opacity": (0.5 * p).toFixed(3) }));
      }));
      for (const c of contours) root.append(svg("path", { d: path(c.outlines_m), class: c.chance === 0.5 ? "outline" : "chance-line" }));
    } else root.append(svg("path", { d: path(map.possible_m) + path(map.sure_m), class: "edge-band", "fill-rule": "evenodd" }),
      svg("path", { d: path(map.sure_m), class: "sure", "fill-rule": "evenodd" }));
    for (const plate of map.plates) root.append(svg("path", { d: path(plate.outlines_m), class: "plate-variant" }));
    if (map.measured) root.append(svg("path", { d: path([map.measured.outline_m]), class: "measured" }));
    if (!map.chance) root.append(svg("path", { d: path(map.outlines_m), class: "outline" }));

    root.append(svg("circle", { cx: X(0), cy: Y(0), r: map.jet_half_radius_m * scale, class: "jet" }),
      svg("path", { d: `M${X(0) - 6} ${Y(0)}h12M${X(0)} ${Y(0) - 6}v12`, class: "jet-axis" }));
    if (foot) {
      const at: Point = [wx0 - foot[0][0] + 0.04 * (wx1 - wx0), wy0 - foot[0][1] + 0.04 * (wy1 - wy0)];
      root.append(svg("path", { d: path([map.footprint_m.map((p): Point => [p[0] + at[0], p[1] + at[1]])]), class: "particle" }),
        svg("text", { x: X(wx0 + footWidth + 0.04 * (wx1 - wx0)) + 8, y: Y(wy0 + 0.04 * (wy1 - wy0)) - 2 }, map.body));
    }

    for (const run of map.runs) {
      const kind = run.clearance_m === null ? "failed" : run.clearance_m > 0 ? "ejected" : "kept";
      const link = svg("a", { href: `${run.directory}/report.html`, "aria-label": runText(run) });
      const [cx, cy] = [X(run.x_m), Y(run.y_m)];
      link.append(svg("title", {}, runText(run)));
      if (kind === "failed") link.append(svg("path", { d: `M${cx - 4} ${cy - 4}l8 8m0 -8l-8 8`, class: "run failed" }));
      else if (kind === "kept") link.append(svg("rect", { x: cx - 4, y: cy - 4, width: 8, height: 8, class: `run kept${run.fine ? "" : " coarse"}` }));
      else link.append(svg("circle", { cx, cy, r: 4.5, class: `run ejected${run.fine ? "" : " coarse"}` }));
      root.append(link);
      if (map.symmetric && run.y_m > 0)
        root.append(kind === "kept"
          ? svg("rect", { x: cx - 2, y: Y(-run.y_m) - 2, width: 4, height: 4, class: "mirror kept" })
          : svg("circle", { cx, cy: Y(-run.y_m), r: 2, class: "mirror ejected" }));
    }
    for (const c of map.contradictions)
      root.append(svg("circle", { cx: X(c.x_m), cy: Y(c.y_m), r: 10, class: "contradiction" }));
    holder.replaceChildren(root);
  };
  new ResizeObserver(draw).observe(holder);

  const entry = (kind: string, text: string): HTMLElement => h("li", {}, h("span", { class: `map-key ${kind}` }), text);
  const key = h("ul", { class: "key" },
    entry("ejected", "ejected"), entry("kept", "not ejected"), map.runs_coarse > 0 && entry("coarse", "hollow: coarse run"),
    map.chance ? entry("chance", "chance of ejection: line 50 %, dashed 10 and 90 %") : entry("edge-band", "edge, 95 %"), map.plates.length > 0 && entry("plate-variant", "plate moved by its error"),
    map.measured && entry("measured", `measured (${map.measured.file})`), entry("jet", "jet, half its speed"),
    map.symmetric && h("li", {}, "small marks: mirror images, not run"));
  return h("figure", {}, holder, h("figcaption", {}, key));
}
