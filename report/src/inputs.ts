/** What the case sets, and by what several runs differ. */

import { type JsonObject, type Run } from "./data";
import { h } from "./dom";
import { table } from "./tables";

interface Input {
  what: string;
  value: string;
}

/** By the key of the case file; of a run that says which it has. */
function listed(run: Run, name: "inputs" | "assumptions"): Map<string, Input> {
  const list = run.result?.[name];
  if (!Array.isArray(list)) return new Map();
  return new Map((list as JsonObject[]).map((i) => [String(i["key"]), { what: String(i["what"]), value: String(i["value"]) }]));
}

/** The mesh and its sides are in the case file: of what they are made nobody asks who reads a verdict. */
const OF_THE_COMPUTATION = /^(grid|boundary|run|slice|line|probe|domain|contact)\b/;

/** "body.0.size" as one says it: "size of body 1". */
function named(key: string): string {
  const parts = key.split(".");
  const element = parts.findIndex((part) => /^\d+$/.test(part));
  if (element > 0) parts[element] = String(Number(parts[element]) + 1);
  return parts.join(" ").replace(/_/g, " ");
}

/** What a run was given: machine, valve, bodies. */
export function inputTable(run: Run): HTMLElement | null {
  const rows = [...listed(run, "inputs")].filter(([key]) => !OF_THE_COMPUTATION.test(key))
    .map(([key, { what, value }]) => [named(key), value, h("span", {}, what, " ", h("code", {}, key))]);
  return rows.length ? h("div", { class: "inputs" }, table(["Input", "Value", "Meaning"], rows)) : null;
}

/** Of several runs, one a line: what is not the same in all of them, and what came of it. */
export function differenceTable(runs: Run[]): HTMLElement | null {
  if (runs.length < 2) return null;
  const given = runs.map((run) => new Map([...listed(run, "assumptions"), ...listed(run, "inputs")]));
  const value = (r: number, key: string): string => given[r]!.get(key)?.value ?? "\u2013";
  const keys = [...new Set(given.flatMap((g) => [...g.keys()]))].filter((key) => runs.some((_, r) => value(r, key) !== value(0, key)));
  if (keys.length === 0) return null;
  return table(["Run", ...keys.map(named), "Outcome"], runs.map((run, r) =>
    [run.name, ...keys.map((key) => value(r, key)), String(run.result?.["outcome"] ?? "\u2013")]));
}
