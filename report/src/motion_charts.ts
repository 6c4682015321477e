import { chart, axisLabel, inReadableUnit, type Series } from "./charts";
import { bodyColour, componentColour } from "./colour";
import { CROWD, columnOf, type Run, type Table } from "./data";
import { h } from "./dom";
import { words } from "./format";
import type { Player } from "./player";

const QUANTITIES: [prefix: string, title: string, unit: string][] = [
  ["velocity", "Velocity", "m/s"],
  ["force", "Force of the air", "N"],
  ["torque", "Torque of the air", "N m"],
  ["spin", "Spin", "rad/s"],
  ["contact_force", "Contact force", "N"],
];
const COMPONENTS = ["x", "y", "z"];

const milliseconds = (table: Table): Float64Array => Float64Array.from(table.values[0]!, (t) => t * 1e3);

/** The time in which air was computed, ms, where that is the lesser part of the run. */
function airTime(runs: Run[]): [number, number] | undefined {
  const last = (all: boolean): number => Math.max(0, ...runs.flatMap((run) =>
    run.replay?.frames.filter((f) => all || f.slices.size > 0).map((f) => f.time) ?? []));
  const until = last(false);
  return until > 0 && until < 0.6 * last(true) ? [0, until * 1e3] : undefined;
}

/** Values of `table` at the times of another one, straight lines between rows. */
function resampled(times: ArrayLike<number>, table: Table, values: Float32Array): (number | null)[] {
  const own = milliseconds(table);
  let n = 0;
  return Array.from(times, (t) => {
    if (t < own[0]! - 1e-9 || t > own[own.length - 1]! + 1e-9) return null;
    while (n + 2 < own.length && own[n + 1]! < t) ++n;
    const span = own[n + 1]! - own[n]!;
    const s = span > 0 ? (t - own[n]!) / span : 0;
    return values[n]! + s * (values[n + 1]! - values[n]!);
  });
}

/** Velocity, force, torque and spin of one body over time; further runs dashed. */
function chartsOfBody(name: string, runs: Run[], player: Player): HTMLElement {
  const found = runs.flatMap((run) => {
    const table = run.history.get(`body-${name}`);
    return table && table.values[0]!.length > 1 ? [{ run, table }] : [];
  });
  const grid = h("div", { class: "chart-grid" });
  const first = found[0];
  if (!first) return grid;
  const x = milliseconds(first.table);
  for (const [prefix, title, unit] of QUANTITIES) {
    const series: Series[] = found.flatMap(({ run, table }, r) =>
      COMPONENTS.flatMap((component, c) => {
        const values = columnOf(table, `${prefix}_${component}`);
        if (!values) return [];
        return [{
          label: runs.length > 1 ? `${component}, ${run.name}` : component,
          values: (r === 0 ? values : resampled(x, table, values)) as ArrayLike<number>,
          colour: (dark: boolean) => componentColour(c, dark),
          dashed: r > 0,
        }];
      }));
    const silent = series.every((s) => Array.prototype.every.call(s.values, (v) => !v));
    if (series.length === 0 || (silent && prefix === "contact_force")) continue;
    const shown = inReadableUnit(series, unit);
    const part = /^(force|torque)$/.test(prefix) ? airTime(found.map((f) => f.run)) : undefined;
    grid.append(chart({
      title: part ? `${title} while it is computed` : title, part, xLabel: "time [ms]", yLabel: axisLabel(prefix.replace("_", " "), shown.unit), x, series: shown.series, player,
    }));
  }
  return grid;
}

/** How far the valve is open over time; further runs dashed. */
export function valveChart(runs: Run[], player: Player): HTMLElement | null {
  const lines = runs.flatMap((run) => (run.replay?.valveOpening.length ? [{ run, line: run.replay.valveOpening }] : []));
  if (lines.length === 0) return null;
  const times = [...new Set(lines.flatMap(({ line }) => line.map(([t]) => t)))].sort((a, b) => a - b);
  const opening = (line: [number, number][]): number[] => {
    let n = 0;
    return times.map((t) => {
      while (n + 2 < line.length && line[n + 1]![0] < t) ++n;
      const [[t0, v0], [t1, v1]] = [line[n]!, line[n + 1] ?? line[n]!];
      return t > line.at(-1)![0] ? 0 : t1 > t0 ? v0 + ((t - t0) / (t1 - t0)) * (v1 - v0) : v0;
    });
  };
  return chart({
    title: "Opening of the valve", xLabel: "time [ms]", yLabel: "open [%]", x: times.map((t) => t * 1e3), player,
    series: lines.map(({ run, line }, r) => ({
      label: runs.length > 1 ? run.name : "open", values: opening(line).map((v) => 100 * v), colour: (dark) => bodyColour(r, dark), dashed: r > 0,
    })),
  });
}

/** One tab a body; a list to choose from where they are a crowd. */
export function motionCharts(runs: Run[], player: Player): HTMLElement | null {
  const names = [...new Set(runs.flatMap((run) =>
    [...run.history.keys()].filter((k) => k.startsWith("body-")).map((k) => k.slice(5))))];
  if (names.length === 0) return null;
  if (names.length === 1) return chartsOfBody(names[0]!, runs, player);
  const holder = h("div", {});
  const made = new Map<string, HTMLElement>();
  if (names.length > CROWD) {
    const chooser = h("select", {}, ...names.map((name) => h("option", { value: name }, name)));
    const show = (): void => holder.replaceChildren(chartsOfBody(chooser.value, runs, player));
    chooser.addEventListener("change", show);
    show();
    return h("div", {}, h("label", { class: "field body-chooser" }, h("span", {}, "Body"), chooser), holder);
  }
  const tabs = h("div", { class: "tabs", role: "group", "aria-label": "Body" });
  const show = (name: string): void => {
    if (!made.has(name)) made.set(name, chartsOfBody(name, runs, player));
    holder.replaceChildren(made.get(name)!);
    for (const tab of tabs.children) tab.setAttribute("aria-pressed", String(tab.textContent === name));
  };
  for (const name of names) {
    const tab = h("button", { type: "button" }, name);
    tab.addEventListener("click", () => show(name));
    tabs.append(tab);
  }
  show(names[0]!);
  return h("div", {}, tabs, holder);
}

/** Probes, the ledger and other plain series, one chart a unit of each file. */
export function seriesCharts(runs: Run[], player: Player, wanted: (name: string) => boolean): HTMLElement[] {
  const names = [...new Set(runs.flatMap((run) => [...run.history.keys()].filter(wanted)))];
  return names.flatMap((name) => {
    const found = runs.flatMap((run) => (run.history.has(name) ? [{ run, table: run.history.get(name)! }] : []));
    const first = found[0]!.table;
    if (first.values[0]!.length < 2) return [];
    const x = milliseconds(first);
    const units = [...new Set(first.columns.slice(1).map((c) => c.unit))];
    return units.map((unit) => {
      const columns = first.columns.filter((c, n) => n > 0 && c.unit === unit);
      const series = found.flatMap(({ run, table }, r) => columns.flatMap((column, c): Series[] => {
        const values = columnOf(table, column.name);
        if (!values) return [];
        const label = words(column.name);
        return [{
          label: runs.length > 1 ? `${label}, ${run.name}` : label,
          values: (r === 0 ? values : resampled(x, table, values)) as ArrayLike<number>,
          colour: (dark) => bodyColour(c, dark),
          dashed: r > 0,
        }];
      }));
      const shown = inReadableUnit(series, unit);
      const quantity = columns.length === 1 ? columns[0]!.name.replace(/_/g, " ") : "value";
      return chart({
        title: `${words(name.replace(/^probe-/, "probe "))}${columns.length === 1 ? `: ${quantity}` : ""}`, xLabel: "time [ms]",
        yLabel: axisLabel(quantity, shown.unit), x, series: shown.series, player,
      });
    });
  });
}
