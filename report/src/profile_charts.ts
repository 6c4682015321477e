import { chart, axisLabel, inReadableUnit, type Series } from "./charts";
import { bodyColour, viridis } from "./colour";
import { columnOf, type Run, type Table } from "./data";
import { fixed, words } from "./format";

const MOST_TIMES = 5;

interface Block {
  time: number;
  from: number;
  to: number;
}

/** Rows that share a time. */
function blocksOf(table: Table): Block[] {
  const times = table.values[0]!;
  const blocks: Block[] = [];
  for (let n = 0; n < times.length; ++n) {
    const last = blocks[blocks.length - 1];
    if (last && last.time === times[n]) last.to = n + 1;
    else blocks.push({ time: times[n]!, from: n, to: n + 1 });
  }
  return blocks;
}

function ofTime(colour: number, count: number): (dark: boolean) => string {
  return (dark) => {
    const low = dark ? 0.25 : 0;
    const high = dark ? 1 : 0.8;
    return `rgb(${viridis(low + ((high - low) * colour) / Math.max(count - 1, 1)).join(",")})`;
  };
}

/** Units of quantities as the probes' histories give them: result.json names quantities without. */
function unitIn(run: Run, quantity: string): string {
  for (const [name, table] of run.history)
    if (name.startsWith("probe-")) {
      const column = table.columns.find((c) => c.name === quantity);
      if (column) return column.unit;
    }
  return "1";
}

/** Lines of result.json: profiles at the end of the run, where no history shows more. */
function finalProfiles(runs: Run[]): HTMLElement[] {
  return runs.flatMap((run) => {
    const lines = (run.result?.["lines"] ?? {}) as { [line: string]: { [quantity: string]: number[] } };
    const once = Object.entries(lines).filter(([name]) => !run.history.has(`line-${name}`));
    return once.flatMap(([name, line]) => {
      const x = (line["position_m"] ?? []).map((v) => v * 1e3);
      return Object.entries(line).filter(([quantity]) => quantity !== "position_m").map(([quantity, values]) => {
        const shown = inReadableUnit([{ label: words(quantity), values, colour: (dark) => bodyColour(0, dark) }], unitIn(run, quantity));
        return chart({
          title: `Line ${name} at the end: ${words(quantity).toLowerCase()}${runs.length > 1 ? `, ${run.name}` : ""}`,
          xLabel: "position [mm]", yLabel: axisLabel(quantity.replace(/_/g, " "), shown.unit), x, series: shown.series,
        });
      });
    });
  });
}

/** Jet profiles: every quantity of each recorded line against the position along it, at a few times. */
export function profileCharts(runs: Run[]): HTMLElement[] {
  const charts: HTMLElement[] = finalProfiles(runs);
  for (const run of runs)
    for (const [name, table] of run.history) {
      if (!name.startsWith("line-")) continue;
      const blocks = blocksOf(table);
      const position = columnOf(table, "position");
      if (!position || blocks.length === 0) continue;
      const count = Math.min(MOST_TIMES, blocks.length);
      // The first moment is that of air at rest; when there are many, it is left out.
      const start = count < blocks.length ? 1 : 0;
      const chosen = Array.from({ length: count }, (_, n) =>
        blocks[start + Math.round((n * (blocks.length - 1 - start)) / Math.max(count - 1, 1))]!);
      const first = chosen[0]!;
      const x = Float64Array.from(position.subarray(first.from, first.to), (v) => v * 1e3);
      table.columns.forEach((column, c) => {
        if (c === 0 || column.name === "position") return;
        const series = chosen.map((block, n): Series => ({
          label: `${fixed(block.time * 1e3, 1)} ms`,
          values: table.values[c]!.subarray(block.from, block.to),
          colour: ofTime(n, count),
        }));
        const title = `Line ${name.slice(5)}: ${words(column.name).toLowerCase()}${runs.length > 1 ? `, ${run.name}` : ""}`;
        const shown = inReadableUnit(series, column.unit);
        charts.push(chart({
          title, xLabel: "position [mm]", yLabel: axisLabel(column.name.replace(/_/g, " "), shown.unit), x, series: shown.series,
        }));
      });
    }
  return charts;
}
