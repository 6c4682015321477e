/** The case from the side, to scale: box, nozzle, plate, bodies and their undisturbed paths. */

import { svg } from "../dom";
import { fixed, ticks } from "../format";
import type { Drawing } from "./api";

export function drawingView(drawing: Drawing): SVGElement {
  const points = [...(drawing.box ?? []), drawing.nozzle, drawing.plate, ...drawing.bodies.flatMap((b) => b.path)].filter((p) => p !== undefined);
  const xs = points.map((p) => p[0]), zs = points.map((p) => p[1]);
  const pad = 0.06 * Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...zs) - Math.min(...zs), 1e-3);
  const left = Math.min(...xs) - pad, right = Math.max(...xs) + pad, low = Math.min(...zs) - pad, high = Math.max(...zs) + pad;
  const width = 640, scale = width / (right - left), height = (high - low) * scale;
  const at = ([x, z]: [number, number]): [number, number] => [(x - left) * scale, (high - z) * scale];
  const view = svg("svg", { viewBox: `-46 -8 ${width + 54} ${height + 34}`, role: "img", class: "drawing",
    "aria-label": "The case from the side, to scale: box, nozzle, plate and paths" });
  for (const x of ticks(left * 1e3, right * 1e3, 6)) {
    const [px] = at([x / 1e3, 0]);
    view.append(svg("line", { x1: px, x2: px, y1: 0, y2: height, class: "grid" }), svg("text", { x: px, y: height + 16, class: "tick middle" }, fixed(x, 0)));
  }
  for (const z of ticks(low * 1e3, high * 1e3, 5)) {
    const [, py] = at([0, z / 1e3]);
    view.append(svg("line", { x1: 0, x2: width, y1: py, y2: py, class: "grid" }), svg("text", { x: -6, y: py + 4, class: "tick end" }, fixed(z, 0)));
  }
  view.append(svg("text", { x: width, y: height + 16, class: "tick end" }, "mm"));
  if (drawing.box) {
    const [a, b] = [at(drawing.box[0]), at(drawing.box[1])];
    view.append(svg("rect", { x: a[0], y: b[1], width: b[0] - a[0], height: a[1] - b[1], class: "box" }, svg("title", {}, "the computed box")));
  }
  if (drawing.nozzle) {
    const [x, y] = at(drawing.nozzle);
    view.append(svg("path", { d: `M${x - 5},${y + 14} L${x - 2},${y} L${x + 2},${y} L${x + 5},${y + 14} Z`, class: "nozzle" }, svg("title", {}, "the nozzle")));
  }
  for (const body of drawing.bodies) {
    const path = body.path.map(at);
    view.append(svg("polyline", { points: path.map((p) => p.join(",")).join(" "), class: "flight" }, svg("title", {}, `undisturbed path of ${body.name}`)));
    const start = path[0]!;
    const outline = body.outline.map(([x, z]) => [start[0] + x * scale, start[1] - z * scale].join(","));
    view.append(svg("polygon", { points: outline.join(" "), class: "body" }, svg("title", {}, body.name)));
  }
  if (drawing.plate) {
    const [x, y] = at(drawing.plate);
    view.append(svg("line", { x1: x, x2: x, y1: y, y2: height, class: "plate" }, svg("title", {}, "the dividing plate")));
  }
  return view;
}
