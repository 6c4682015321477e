import { bodyColour, isDark } from "./colour";
import { CROWD, columnOf, bodiesOf, hasBox, type Run } from "./data";
import { h, svg } from "./dom";
import { fixed, ticks } from "./format";
import { hull, placed, poseAt, radius } from "./motion";
import type { Player } from "./player";

type Point = [number, number];

interface Track {
  label: string;
  name: string;
  run: Run;
  body: number;
  colour: number;
  dashed: boolean;
  points: Point[];
  undisturbed: Point[];
  clearance: number | undefined;
}

function tracksOf(runs: Run[]): Track[] {
  const tracks: Track[] = [];
  runs.forEach((run, r) => {
    const names = run.replay?.bodies.map((b) => b.name) ?? [];
    names.forEach((name, body) => {
      const table = run.history.get(`body-${name}`);
      const x = table && columnOf(table, "x");
      const z = table && columnOf(table, "z");
      const points: Point[] = x && z
        ? Array.from(x, (value, n): Point => [value, z[n]!])
        : run.replay!.frames.flatMap((f): Point[] => {
            const p = f.poses[body]?.position;
            return p ? [[p[0], p[2]]] : [];
          });
      if (points.length < 2) return;
      const clearance = bodiesOf(run).find((b) => b["name"] === name)?.["clearance_at_splitter_m"];
      tracks.push({
        label: runs.length > 1 ? `${name} (${run.name})` : name,
        name, run, body, points,
        colour: body,
        dashed: r > 0,
        undisturbed: (run.replay?.undisturbed[body] ?? []).map((p): Point => [p[0], p[2]]),
        clearance: typeof clearance === "number" ? clearance : undefined,
      });
    });
  });
  return tracks;
}

const millimetres = (metres: number): string => `${metres > 0 ? "+" : ""}${fixed(metres * 1e3, 1)} mm`;

/** Height of a track where it passes `x`, on its way out. */
function heightAt(points: Point[], x: number): number | undefined {
  for (let n = points.length - 1; n > 0; --n) {
    const [a, b] = [points[n - 1]!, points[n]!];
    if (a[0] <= x && b[0] >= x && b[0] > a[0]) return a[1] + ((x - a[0]) / (b[0] - a[0])) * (b[1] - a[1]);
  }
  return undefined;
}

/** How the side view is to be read. */
export function pathNote(runs: Run[]): string {
  const crowd = tracksOf(runs).length > CROWD;
  return crowd ? "Side view to scale." : "Side view to scale. Faint outlines are equally far apart in time.";
}

/** Side view (x, z) of the bodies' paths, with the plate, the nozzle and the paths without air. */
export function pathView(runs: Run[], player: Player): HTMLElement | null {
  const tracks = tracksOf(runs);
  if (tracks.length === 0) return null;
  const replay = runs.find((run) => run.replay)?.replay;

  const all: Point[] = tracks.flatMap((t) => [...t.points, ...t.undisturbed]);
  for (const p of replay?.plates ?? []) {
    all.push([p.edge[0], p.edge[2]]);
    all.push([p.edge[0] + p.along[0] * p.length, p.edge[2] + p.along[2] * p.length]);
  }
  for (const n of replay?.nozzles ?? []) all.push([n.position[0], n.position[2] - 0.006]);
  if (replay && hasBox(replay)) for (const corner of replay.domain) all.push([corner[0], corner[2]]);
  const largest = Math.max(0, ...tracks.map((t) => t.run.replay ? radius(t.run.replay.bodies[t.body]!) : 0));
  const finite = all.filter((p) => p.every(Number.isFinite));
  const range = (d: 0 | 1): Point => {
    const [low, high] = finite.reduce((r, p) => [Math.min(r[0], p[d]), Math.max(r[1], p[d])], [Infinity, -Infinity] as Point);
    const pad = Math.max(0.02 * (high - low), largest);
    return [low - pad, high + pad];
  };
  const [[x0, x1], [z0, z1]] = [range(0), range(1)];

  const holder = h("div", { class: "path-view" });
  const margin = { left: 54, right: 18, top: 14, bottom: 46 };
  let update = (_time: number): void => {};

  const draw = (): void => {
    const dark = isDark();
    const width = Math.max(holder.clientWidth, 320);
    const scale = Math.min((width - margin.left - margin.right) / (x1 - x0), 560 / (z1 - z0));
    const height = (z1 - z0) * scale + margin.top + margin.bottom;
    const X = (x: number): number => margin.left + (x - x0) * scale;
    const Z = (z: number): number => margin.top + (z1 - z) * scale;
    const line = (points: Point[]): string =>
      points.map((p, n) => `${n ? "L" : "M"}${X(p[0]).toFixed(1)} ${Z(p[1]).toFixed(1)}`).join("");
    const outline = (t: Track, time: number): string => {
      const pose = poseAt(t.run.replay!, t.body, time);
      if (!pose) return "";
      const v = placed(t.run.replay!.bodies[t.body]!, pose);
      const points: Point[] = [];
      for (let n = 0; n < v.length; n += 3) points.push([v[n]!, v[n + 2]!]);
      return `${line(hull(points))}Z`;
    };

    const root = svg("svg", {
      width, height, viewBox: `0 0 ${width} ${height}`, role: "img",
      "aria-label": `Side view of the paths of ${tracks.map((t) => t.label).join(", ")}; x along the belt, z up, in millimetres.`,
    });
    const axes = svg("g", { class: "axes" });
    for (const x of ticks(x0 * 1e3, x1 * 1e3, Math.max(4, width / 90)))
      axes.append(
        svg("line", { x1: X(x / 1e3), x2: X(x / 1e3), y1: margin.top, y2: Z(z0), class: "grid" }),
        svg("text", { x: X(x / 1e3), y: Z(z0) + 18, "text-anchor": "middle" }, fixed(x, 0)));
    for (const z of ticks(z0 * 1e3, z1 * 1e3, Math.max(3, height / 70)))
      axes.append(
        svg("line", { x1: margin.left, x2: X(x1), y1: Z(z / 1e3), y2: Z(z / 1e3), class: "grid" }),
        svg("text", { x: margin.left - 8, y: Z(z / 1e3) + 4, "text-anchor": "end" }, fixed(z, 0)));
    axes.append(
      svg("text", { x: X(x1), y: height - 8, "text-anchor": "end", class: "axis-name" }, "x along the belt [mm]"),
      svg("text", { x: 4, y: 11, class: "axis-name" }, "z up [mm]"));
    root.append(axes);

    if (replay) {
      const [a, b] = replay.domain;
      if (hasBox(replay)) root.append(svg("rect", {
        x: X(a[0]), y: Z(b[2]), width: (b[0] - a[0]) * scale, height: (b[2] - a[2]) * scale, class: "domain",
      }), svg("text", { x: X(a[0]) + 6, y: Z(b[2]) + 15, class: "note" }, "air computed here"));
      for (const n of replay.nozzles) {
        const [cx, cz] = [X(n.position[0]), Z(n.position[2])];
        root.append(svg("path", { d: `M${cx - 3} ${cz}h6l4 14h-14Z`, class: "nozzle" }),
          svg("text", { x: cx + 12, y: cz + 11, class: "note" }, "nozzle"));
      }
      for (const p of replay.plates) {
        const w = Math.max((p.thickness * scale) / 2, 1.5);
        const [ex, ez] = [X(p.edge[0]), Z(p.edge[2])];
        const end = `${X(p.edge[0] + p.along[0] * p.length)} ${Z(p.edge[2] + p.along[2] * p.length)}`;
        root.append(svg("path", { d: `M${ex} ${ez}L${end}`, class: "plate", "stroke-width": 2 * w }),
          svg("circle", { cx: ex, cy: ez, r: w + 1, class: "plate-edge" }),
          svg("text", { x: ex + 8, y: ez + 18, class: "note" }, p.name));
      }
    }

    for (const t of tracks) {
      const stroke = bodyColour(t.colour, dark);
      if (t.undisturbed.length > 1)
        root.append(svg("path", { d: line(t.undisturbed), class: "undisturbed", stroke }));
      root.append(svg("path", { d: line(t.points), class: tracks.length > CROWD ? "track faint" : "track", stroke, "stroke-dasharray": t.dashed && "8 4" }));
      if (t.run.replay && !t.dashed && tracks.length <= CROWD)
        for (let n = 0; n <= 14; ++n)
          root.append(svg("path", {
            d: outline(t, player.start + (n / 14) * (player.end - player.start)), class: "strobe", fill: stroke, stroke,
          }));
    }
    const edge = replay?.plates[0]?.edge;
    if (edge)
      tracks.forEach((t, n) => {
        const z = heightAt(t.points, edge[0]);
        if (z === undefined || t.clearance === undefined) return;
        const x = X(edge[0]) - 10 - 12 * n;
        const stroke = bodyColour(t.colour, dark);
        root.append(svg("path", {
          d: `M${x - 4} ${Z(z)}h8M${x} ${Z(z)}V${Z(edge[2])}m-4 0h8`, class: "dimension", stroke,
          "stroke-dasharray": t.dashed && "3 2",
        }));
        if (tracks.length === 1)
          root.append(svg("text", {
            x: x - 10, y: (Z(z) + Z(edge[2])) / 2 + 4, "text-anchor": "end", class: "dimension-text", style: `fill:${stroke}`,
          }, millimetres(t.clearance)));
      });

    const now = tracks.map((t) => svg("path", {
      class: t.dashed ? "now ghost" : "now", fill: bodyColour(t.colour, dark), stroke: t.dashed && bodyColour(t.colour, dark),
    }));
    root.append(...now);
    update = (time) => tracks.forEach((t, n) => t.run.replay && now[n]!.setAttribute("d", outline(t, time)));
    update(player.time);
    holder.replaceChildren(root);
  };

  player.onChange((time) => update(time));
  new ResizeObserver(draw).observe(holder);
  document.addEventListener("themechange", draw);

  const key = h("ul", { class: "key" });
  for (const t of tracks.length > CROWD ? [] : tracks)
    key.append(h("li", {}, h("span", { class: t.dashed ? "swatch dashed" : "swatch", "data-body": t.colour }), t.label,
      t.clearance === undefined ? null : h("strong", {}, ` ${millimetres(t.clearance)}`), t.clearance === undefined ? null : " from the edge"));
  if (tracks.some((t) => t.undisturbed.length > 1))
    key.append(h("li", {}, h("span", { class: "swatch dotted" }), "without air"));
  return h("figure", {}, holder, h("figcaption", {}, key));
}
