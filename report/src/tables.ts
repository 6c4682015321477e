import { CROWD, bodiesOf, type Json, type JsonObject, type Run } from "./data";
import { h } from "./dom";
import { bytes, duration, fixed, short, labelOf, thousands, words } from "./format";

const isNumber = (v: Json | undefined): v is number => typeof v === "number";

/** Keys of result.json that have a place of their own on the page. */
const OWN_PLACE = new Set(["title", "outcome", "bodies", "ledger", "operators", "assumptions", "expectations", "plate"]);

interface Fact {
  label: string;
  text: string;
  unit: string;
  pointer: string;
}

/** Impulse that would have carried the body's centre just over the plate's edge, N s. */
function neededImpulse(body: JsonObject): number | undefined {
  const [impulse, margin, mass] = [body["impulse_z_N_s"], body["velocity_margin_z_m_s"], body["mass_kg"]];
  return isNumber(impulse) && isNumber(margin) && isNumber(mass) ? impulse - mass * margin : undefined;
}

/** By how much weaker or stronger the air would have to push for the other outcome; "" where it says nothing. */
function sureness(body: JsonObject): string {
  const [margin, gained] = [body["velocity_margin_z_m_s"], body["velocity_change_z_m_s"]];
  if (!isNumber(margin) || !isNumber(gained) || gained <= 0) return "";
  const share = `${fixed((100 * Math.abs(margin)) / gained, 0)} %`;
  return margin >= 0 ? `Ejected still if the air pushed ${margin > gained ? "not at all" : `${share} less`}.` : `Ejected if the air pushed ${share} more.`;
}

/** "right: ejected", "by-catch: ejected", "undecided: the time limit came first"; "" without a plate. */
function outcomeOf(body: JsonObject): string {
  const outcome = body["outcome"];
  if (typeof outcome !== "string") return "";
  if (outcome === "undecided") return "undecided: the time limit came first";
  return typeof body["judgement"] === "string" ? `${body["judgement"]}: ${outcome}` : outcome;
}

function factsOfBody(body: JsonObject, pointer: string): Fact[] {
  const facts: Fact[] = [];
  const add = (key: string, label: string, unit: string, text: (v: number) => string): void => {
    const value = body[key];
    if (isNumber(value)) facts.push({ label, unit, text: text(value), pointer: `${pointer}/${key}` });
  };
  const signed = (v: number, digits: number): string => (v > 0 ? "+" : "") + fixed(v, digits);
  const clearance = body["clearance_at_splitter_m"];
  add("clearance_at_splitter_m", isNumber(clearance) && clearance < 0 ? "below the plate's edge" : "above the plate's edge", "mm",
    (v) => fixed(Math.abs(v) * 1e3, 1));
  add("velocity_margin_z_m_s", "margin in vertical velocity", "m/s", (v) => signed(v, 2));
  add("velocity_change_z_m_s", "vertical velocity gained", "m/s", (v) => signed(v, 2));
  const needed = neededImpulse(body);
  add("impulse_z_N_s", needed === undefined ? "vertical impulse" : `vertical impulse of the air; ${fixed(needed * 1e3, 2)} just clears the edge`,
    "mN\u00b7s", (v) => fixed(v * 1e3, 2));
  add("drag_coefficient", "drag coefficient", "", (v) => fixed(v, 3));
  add("mass_kg", "mass", "g", (v) => fixed(v * 1e3, 2));
  return facts;
}

/** Every body's outcome and numbers, without columns that say the same nothing of all. */
function crowdTable(runs: Run[]): HTMLElement {
  const bodies = runs.flatMap((run, r) => bodiesOf(run).map((body, b) => ({ run, r, body, facts: factsOfBody(body, `/bodies/${b}`) })));
  const labels = [...new Set(bodies.flatMap(({ facts }) => facts.filter((f) => Number(f.text) !== 0).map((f) => f.label)))];
  const judged = bodies.some(({ body }) => typeof body["outcome"] === "string");
  const rows = bodies.map(({ run, r, body, facts }) => [
    String(body["name"]) + (runs.length > 1 ? `, ${run.name}` : ""),
    ...(judged ? [outcomeOf(body) || "\u2013"] : []),
    ...labels.map((label) => {
      const f = facts.find((fact) => fact.label === label);
      return h("span", f ? { "data-run": r, "data-pointer": f.pointer } : {}, f ? `${f.text} ${f.unit}` : "\u2013");
    }),
  ]);
  const heads = ["Body", ...(judged ? ["Outcome"] : []), ...labels];
  const from = heads.length - labels.length;
  return h("details", {}, h("summary", {}, `All ${bodies.length} bodies`), table(heads, rows, labels.map((_, n) => from + n)));
}

/** One card a body, or one table of a crowd: its outcome and the numbers behind it. */
export function bodyCards(runs: Run[]): HTMLElement | null {
  if (runs.reduce((count, run) => count + bodiesOf(run).length, 0) > CROWD) return crowdTable(runs);
  const cards = h("div", { class: "cards" });
  runs.forEach((run, r) => bodiesOf(run).forEach((body, b) => {
    const outcome = outcomeOf(body);
    const ejected = body["outcome"] === "ejected";
    const good = body["judgement"] === undefined ? ejected : body["judgement"] === "right";
    const sign = ejected ? "\u2197 " : body["outcome"] === "not ejected" ? "\u2192 " : "";
    const list = h("dl", {});
    for (const f of factsOfBody(body, `/bodies/${b}`))
      list.append(h("div", {},
        h("dd", { "data-run": r, "data-pointer": f.pointer }, f.text, f.unit ? h("span", { class: "unit" }, ` ${f.unit}`) : null),
        h("dt", {}, f.label)));
    const sure = sureness(body);
    cards.append(h("article", { class: "card" },
      h("header", {},
        h("h3", {}, h("span", { class: r > 0 ? "swatch dashed" : "swatch", "data-body": b }), String(body["name"] ?? `body ${b}`),
          runs.length > 1 ? h("span", { class: "of-run" }, ` ${run.name}`) : null),
        outcome !== ""
          ? h("p", { class: good ? "outcome ejected" : "outcome kept" }, h("span", { "aria-hidden": "true" }, sign), outcome)
          : null),
      list, sure ? h("p", { class: "sure" }, sure) : null));
  }));
  return cards.children.length > 0 ? cards : null;
}

export function table(head: string[], rows: (string | Node)[][], numeric: number[] = []): HTMLElement {
  const kind = (n: number): string | undefined => (numeric.includes(n) ? "number" : undefined);
  return h("div", { class: "table-holder" }, h("table", {},
    h("thead", {}, h("tr", {}, ...head.map((text, n) => h("th", { scope: "col", class: kind(n) }, text)))),
    h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row.map((cell, n) =>
      n === 0 ? h("th", { scope: "row" }, cell) : h("td", { class: kind(n) }, cell)))))));
}

/** Key figures of the computation. */
export function costTable(runs: Run[]): HTMLElement | null {
  const figures: [key: string, label: string, text: (v: number) => string][] = [
    ["cells", "Cells", thousands],
    ["steps", "Steps", thousands],
    ["simulated_time_s", "Simulated time", (v) => `${short(v * 1e3, 4)} ms`],
    ["wall_time_s", "Wall time", duration],
    ["threads", "Threads", String],
    ["cell_steps_per_s", "Cell-steps a second", (v) => `${short(v / 1e6, 3)} million`],
    ["max_courant", "Largest Courant number", (v) => fixed(v, 2)],
  ];
  const known = new Set(figures.map(([key]) => key));
  const others = [...new Set(runs.flatMap((run) => Object.entries(run.result ?? {})
    .filter(([key, v]) => !OWN_PLACE.has(key) && !known.has(key) && (isNumber(v) || typeof v === "string")).map(([key]) => key)))];
  const rows = [
    ...figures,
    ...others.map((key): [string, string, (v: number) => string] => [key, labelOf(key), (v) => (isNumber(v) ? short(v, 4) : String(v))]),
  ].filter(([key]) => runs.some((run) => run.result?.[key] !== undefined && (run.result["cells"] !== 0 || run.result[key] !== 0)))
    .map(([key, label, text]) => [label, ...runs.map((run, r) => {
      const value = run.result?.[key];
      return h("span", { "data-run": r, "data-pointer": `/${key}` }, value === undefined || value === null ? "\u2013" : text(value as number));
    })]);
  if (rows.length === 0) return null;
  return table(["Run", ...runs.map((run) => run.name)], rows, runs.map((_, n) => n + 1));
}

/** A number, or the components of a vector. */
function numbersText(value: Json | undefined): string {
  if (isNumber(value)) return short(value, 2);
  if (Array.isArray(value) && value.every(isNumber)) return `(${value.map((v) => short(v, 2)).join(", ")})`;
  return "\u2013";
}

/** Keys of the ledger that do not speak for themselves. */
const LEDGER_LABELS: { [key: string]: string } = {
  momentum_of_displaced_fluid_N_s: "Momentum of displaced fluid [N s]",
  bodies_energy_J: "Bodies: energy less the work done on them [J]",
  bodies_energy_scale_J: "Bodies: greatest energy turned over [J]",
  dissipated_J: "Bodies: dissipated [J]",
  kinetic_over_dissipated: "Bodies: kinetic energy over dissipated",
};

/** Conservation: how well the books close. */
export function ledgerTable(runs: Run[]): HTMLElement | null {
  const keys = [...new Set(runs.flatMap((run) => Object.keys((run.result?.["ledger"] ?? {}) as JsonObject)))];
  if (keys.length === 0) return null;
  const rows = keys.map((key) => [LEDGER_LABELS[key] ?? labelOf(key.replace(/_relative_residual$/, ", relative residual")), ...runs.map((run, r) => {
    const value = ((run.result?.["ledger"] ?? {}) as JsonObject)[key];
    return h("span", { "data-run": r, "data-pointer": `/ledger/${key}` }, numbersText(value));
  })]);
  return table(["Ledger", ...runs.map((run) => run.name)], rows, runs.map((_, n) => n + 1));
}

/** Operator times with bars. */
export function operatorTable(run: Run): HTMLElement | null {
  const operators = run.result?.["operators"];
  if (!Array.isArray(operators) || operators.length === 0) return null;
  const list = operators as JsonObject[];
  const total = list.reduce((sum, o) => sum + Number(o["seconds"]), 0) || 1;
  const rows = list.map((o) => {
    const share = Number(o["seconds"]) / total;
    return [
      h("span", {}, String(o["name"]), h("small", {}, String(o["equation"] ?? ""))),
      h("span", { class: "bar", style: `--share:${share.toFixed(4)}` }, `${fixed(share * 100, 1)} %`),
      `${fixed(Number(o["seconds"]), 2)} s`,
      thousands(Number(o["calls"])),
    ];
  });
  return table(["Operator", "Share", "Time", "Calls"], rows, [2, 3]);
}

export function expectationTable(run: Run): HTMLElement | null {
  const list = run.result?.["expectations"];
  if (!Array.isArray(list) || list.length === 0) return null;
  const cell = (v: Json | undefined): string => (isNumber(v) ? short(v, 4) : String(v ?? "\u2013"));
  return table(["Quantity", "Computed", "Reference", "Error", "Met", "Source"], (list as JsonObject[]).map((e) => [
    h("code", {}, String(e["quantity"])), cell(e["computed"]), cell(e["reference"]), cell(e["error"]),
    h("span", { class: e["pass"] ? "met" : "missed" }, e["pass"] ? "\u2713 yes" : "\u2717 no"), String(e["source"] ?? ""),
  ]), [1, 2, 3]);
}

/** What the run takes for granted. */
export function assumptionList(run: Run): HTMLElement | null {
  const list = run.result?.["assumptions"];
  if (!Array.isArray(list) || list.length === 0) return null;
  return h("ul", { class: "assumptions" }, ...(list as JsonObject[]).map((a) => h("li", {},
    h("p", { class: "what" }, `${a["what"]}: `, h("strong", {}, String(a["value"]))),
    a["reason"] ? h("p", {}, String(a["reason"])) : null,
    a["key"] ? h("p", { class: "key-name" }, "Change it with ", h("code", {}, String(a["key"]))) : null)));
}

/** Values by JSON pointer; a list of plain values is one entry. */
function leaves(value: Json, path: string): [path: string, value: Json][] {
  if (value === null || typeof value !== "object") return [[path, value]];
  if (Array.isArray(value) && value.every((v) => v === null || typeof v !== "object"))
    return [[path, value.length <= 6 ? value.join(", ") : `${value.length} values`]];
  return Object.entries(value).flatMap(([key, child]) => leaves(child as Json, `${path}/${key}`));
}

function provenanceText(key: string, value: Json | undefined): string {
  if (isNumber(value) && key.endsWith("_bytes")) return bytes(value);
  return String(value ?? "\u2013").replace(/^(\d{4}-\d\d-\d\d)T([\d:]+)Z$/, "$1 $2 UTC");
}

/** Where the run comes from. */
export function provenanceTable(runs: Run[]): HTMLElement {
  const all = runs.map((run) => new Map(leaves(run.manifest as Json, "")));
  const keys = [...new Set(all.flatMap((m) => [...m.keys()]))];
  return table(["Provenance", ...runs.map((run) => run.name)], keys.map((key) =>
    [words(key.slice(1).replace(/\//g, ", ").replace(/_bytes$/, "")), ...all.map((m) => h("span", { class: "long" }, provenanceText(key, m.get(key))))]));
}

/** Every number of result.json, in full. */
export function resultTable(run: Run, r: number): HTMLElement {
  return table(["Key of result.json", "Value"], leaves(run.result as Json, "").map(([path, value]) =>
    [h("code", {}, path), h("span", { class: "long", "data-exact": path, "data-run": r }, String(value))]));
}
