import { chart } from "./charts";
import { bodyColour } from "./colour";
import { h, section } from "./dom";
import { short } from "./format";

/** A study as `ejecta study` writes it (docs/files.md): SI units. */
export interface StudyResult {
  title: string;
  keys: { key: string; unit: string }[];
  quantities: string[];
  runs: ({ task: number; state: string; directory?: string; reason?: string } & { [column: string]: unknown })[];
}

/** The study of this page, if it is the page of one. */
export function readStudy(): StudyResult | null {
  const data = JSON.parse(document.getElementById("ejecta-data")!.textContent!) as { study?: StudyResult };
  return data.study ?? null;
}

type Run = StudyResult["runs"][number];
const isNumber = (v: unknown): v is number => typeof v === "number";
const BINS = 6;

/** Means of a quantity over each value of a key, or over equal parts of its range where it has many. */
function means(runs: Run[], key: string, quantity: string): { x: number[]; y: number[] } {
  const points = runs.filter((r) => isNumber(r[key]) && isNumber(r[quantity])).map((r) => [r[key], r[quantity]] as [number, number]);
  const values = [...new Set(points.map(([x]) => x))].sort((a, b) => a - b);
  const [low, high] = [values[0] ?? 0, values.at(-1) ?? 0];
  const few = values.length <= 2 * BINS;
  const bin = (x: number): number => (few ? values.indexOf(x) : Math.min(BINS - 1, Math.floor(((x - low) / (high - low)) * BINS)));
  const sums: { x: number; y: number; n: number }[] = [];
  for (const [x, y] of points) {
    const s = (sums[bin(x)] ??= { x: 0, y: 0, n: 0 });
    s.x += x, s.y += y, ++s.n;
  }
  const filled = sums.filter(Boolean);
  return { x: filled.map((s) => s.x / s.n), y: filled.map((s) => s.y / s.n) };
}

const label = (key: { key: string; unit: string }): string => (key.unit && key.unit !== "1" ? `${key.key} [${key.unit}]` : key.key);

function scatter(study: StudyResult, key: StudyResult["keys"][number], quantity: string): HTMLElement | null {
  const points = study.runs.filter((r) => isNumber(r[key.key]) && isNumber(r[quantity]))
    .map((r) => [r[key.key], r[quantity]] as [number, number]);
  const mean = means(study.runs, key.key, quantity);
  if (points.length < 2 || mean.x.length < 2) return null;
  // One axis for both: what a series does not know is left open.
  const [low, high] = [Math.min(...points.map(([x]) => x)), Math.max(...points.map(([x]) => x))];
  const pad = 0.04 * (high - low); // marks at the very ends of an axis are not all drawn
  const rows = [[low - pad, null, null], [high + pad, null, null], ...points.map(([x, y]) => [x, y, null]), ...mean.x.map((x, n) => [x, null, mean.y[n]!])]
    .sort((a, b) => a[0]! - b[0]!);
  const column = (n: number): number[] => rows.map((row) => row[n] as number);
  return chart({
    title: `${quantity} against ${key.key}`, xLabel: label(key), yLabel: quantity, x: column(0),
    series: [
      { label: "runs", values: column(1), colour: (dark) => bodyColour(0, dark), points: true },
      { label: "mean", values: column(2), colour: (dark) => bodyColour(1, dark), joined: true },
    ],
  }, 240);
}

function effects(study: StudyResult): HTMLElement | null {
  const numeric = study.quantities.filter((q) => study.runs.some((r) => isNumber(r[q])));
  const keys = study.keys.filter((k) => new Set(study.runs.map((r) => r[k.key]).filter(isNumber)).size > 1);
  if (numeric.length === 0 || keys.length === 0) return null;
  const cell = (q: string, key: string): string => {
    const y = means(study.runs, key, q).y;
    return y.length < 2 ? "\u2013" : short(y.at(-1)! - y[0]!);
  };
  return h("div", { class: "table-holder" }, h("table", {},
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Change from the least to the greatest value of"),
      ...keys.map((k) => h("th", { scope: "col", class: "number" }, k.key)))),
    h("tbody", {}, ...numeric.map((q) => h("tr", {}, h("th", { scope: "row" }, h("code", {}, q)),
      ...keys.map((k) => h("td", { class: "number" }, cell(q, k.key))))))));
}

const name = (run: Run): HTMLElement => run.directory && run.state === "done"
  ? h("a", { href: `${run.directory}/report.html` }, `run ${run.task + 1}`) : h("span", {}, `run ${run.task + 1}`);

function extremes(study: StudyResult): HTMLElement | null {
  const items = study.quantities.flatMap((q) => {
    const known = study.runs.filter((r) => isNumber(r[q])).sort((a, b) => (a[q] as number) - (b[q] as number));
    if (known.length < 2) return [];
    if (known[0]![q] === known.at(-1)![q])
      return [h("li", {}, h("p", { class: "what" }, h("code", {}, q)), h("p", {}, `the same in every run: ${short(known[0]![q] as number)}`))];
    return [h("li", {}, h("p", { class: "what" }, h("code", {}, q)),
      h("p", {}, `greatest ${short(known.at(-1)![q] as number)}: `, name(known.at(-1)!), `, least ${short(known[0]![q] as number)}: `, name(known[0]!)))];
  });
  return items.length > 0 ? h("ul", { class: "assumptions extremes" }, ...items) : null;
}

function allRuns(study: StudyResult): HTMLElement {
  const text = (v: unknown): string => (v === null || v === undefined ? "\u2013" : isNumber(v) ? short(v, 4) : Array.isArray(v) ? v.map(text).join(", ") : String(v));
  return h("div", { class: "table-holder" }, h("table", {},
    h("thead", {}, h("tr", {}, ...["Run", "state", ...study.keys.map(label), ...study.quantities].map((t) => h("th", { scope: "col" }, t)))),
    h("tbody", {}, ...study.runs.slice(0, 500).map((run) => h("tr", {}, h("th", { scope: "row" }, name(run)),
      h("td", {}, run.reason ? `${run.state}: ${run.reason}` : run.state),
      ...[...study.keys.map((k) => k.key), ...study.quantities].map((c) => h("td", {}, text(run[c]))))))));
}

/** Every quantity against every key. */
export function studyCharts(study: StudyResult): HTMLElement[] {
  return study.quantities.flatMap((q) => study.keys.map((k) => scatter(study, k, q)).filter((c): c is HTMLElement => c !== null));
}

export function studyPage(study: StudyResult): HTMLElement {
  const done = study.runs.filter((r) => r.state === "done").length;
  const failed = study.runs.filter((r) => ["diverged", "refused", "crashed"].includes(r.state)).length;
  const main = h("main", { id: "content" }, h("header", { class: "verdict" }, h("p", { class: "title" }, study.title),
    h("h1", { id: "verdict" }, `${done} of ${study.runs.length} runs done${failed > 0 ? `, ${failed} failed` : ""}.`)));
  const add = (id: string, title: string, note: string, ...content: (Node | null)[]): void => {
    if (content.some(Boolean)) main.append(section(id, title, note, ...content));
  };
  add("extremes", "Best and worst", "", extremes(study));
  add("effects", "Main effects", "Means over all other keys; the ends of ranges with many values are means over a sixth of the range.", effects(study));
  const charts = studyCharts(study);
  add("charts", "Results against keys", "", charts.length > 0 ? h("div", { class: "chart-grid" }, ...charts) : null);
  add("runs", "Runs", study.runs.length > 500 ? "The first 500; all of them are in runs.csv." : "Also in runs.csv.", allRuns(study));
  const links = [...main.querySelectorAll("section")].map((s) => h("a", { href: `#${s.id}` }, s.querySelector("h2")!.textContent));
  return h("div", {}, h("a", { class: "skip", href: "#content" }, "Skip to the results"),
    h("nav", { "aria-label": "Sections" }, h("span", { class: "brand" }, "Ejecta"), ...links), main,
    h("footer", {}, "Ejecta \u00b7 one file, works offline; runs are linked where they lie beside it"));
}
