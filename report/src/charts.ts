import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { isDark } from "./colour";
import { h } from "./dom";
import { alike, fixed, short, unitText } from "./format";
import type { Player } from "./player";

export interface Series {
  label: string;
  values: ArrayLike<number>;
  colour: (dark: boolean) => string;
  dashed?: boolean;
  /** Marks instead of a line. */
  points?: boolean;
  /** Places without a value are passed over. */
  joined?: boolean;
}

export interface ChartSpec {
  title: string;
  xLabel: string;
  yLabel: string;
  x: ArrayLike<number>;
  series: Series[];
  /** Charts over time (ms) share a cursor, show the player's time and set it when clicked. */
  player?: Player;
  /** The part of the x axis shown at first; a double click shows all. */
  part?: [number, number];
}

const FONT = "12px ui-sans-serif, system-ui, sans-serif";

/** The largest size in a series and where: what a screen reader hears instead of the lines. */
function summary(spec: ChartSpec): string {
  return spec.series.map((s) => {
    let at = -1;
    for (let n = 0; n < s.values.length; ++n)
      if (Number.isFinite(s.values[n]) && (at < 0 || Math.abs(s.values[n]!) > Math.abs(s.values[at]!))) at = n;
    return at < 0 ? `${s.label}: no values` : `${s.label}: largest ${short(s.values[at]!)} at ${short(spec.x[at]!)}`;
  }).join("; ");
}

/** Ticks with as many decimals as their spacing needs. */
function tickTexts(_plot: uPlot, list: number[], _axis: number, _space: number, step: number): string[] {
  if (step < 1e-4) return list.map((v) => short(v, 2));
  let decimals = 0;
  while (decimals < 9 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) ++decimals;
  return list.map((v) => (Math.abs(v) >= 1e5 ? short(v) : fixed(v, decimals)));
}

/** A prefix that makes the largest value readable: newton metres become micronewton metres. */
function prefixFor(largest: number, unit: string): { factor: number; unit: string } {
  const plain = { factor: 1, unit };
  if (!/^(N|Pa|J|W)\b/.test(unit) || !(largest > 0) || (largest >= 0.1 && largest < 1e4)) return plain;
  const power = Math.min(2, Math.max(-3, Math.floor(Math.log10(largest) / 3)));
  const prefix = ["n", "\u00b5", "m", "", "k", "M"][power + 3]!;
  return { factor: 10 ** (-3 * power), unit: prefix + unit };
}

/** Series and the unit they are shown in. */
export function inReadableUnit(series: Series[], unit: string): { series: Series[]; unit: string } {
  let largest = 0;
  for (const s of series) for (let n = 0; n < s.values.length; ++n) largest = Math.max(largest, Math.abs(s.values[n] ?? 0));
  const scale = prefixFor(largest, unit);
  if (scale.factor === 1) return { series, unit };
  const scaled = (v: number | null): number | null => (v == null ? null : v * scale.factor);
  return {
    unit: scale.unit,
    series: series.map((s) => ({ ...s, values: Array.from(s.values as ArrayLike<number | null>, scaled) as number[] })),
  };
}

export function chart(spec: ChartSpec, height = 210): HTMLElement {
  return growingChart(spec, height).figure;
}

/** A chart whose values come while it is looked at: `grown` says that those of its spec are others now. */
export function growingChart(spec: ChartSpec, height = 210): { figure: HTMLElement; grown: () => void } {
  const holder = h("div", { class: "chart", role: "img" });
  const figure = h("figure", { class: "chart-figure" }, h("figcaption", {}, spec.title), holder);
  const data = (): uPlot.AlignedData => [spec.x, ...spec.series.map((s) => s.values)] as unknown as uPlot.AlignedData;
  let text = alike(0);
  const describe = (): void => {
    let largest = 0;
    for (const s of spec.series) for (let n = 0; n < s.values.length; ++n) largest = Math.max(largest, Math.abs(s.values[n]!) || 0);
    text = alike(largest);
    holder.setAttribute("aria-label", `${spec.title}, ${spec.yLabel} over ${spec.xLabel}. ${summary(spec)}.`);
  };
  describe();
  let plot: uPlot | undefined;
  const marker = h("div", { class: "now-line", "aria-hidden": "true" });

  /** The legend reads the values at the player's time unless the mouse points elsewhere. */
  const showNow = (u: uPlot): void => {
    if (spec.player) u.setLegend({ idx: u.valToIdx(spec.player.time * 1e3) }, false);
  };
  const moveMarker = (): void => {
    if (!plot || !spec.player) return;
    const x = plot.valToPos(spec.player.time * 1e3, "x");
    marker.style.display = x >= 0 && x <= plot.over.clientWidth ? "block" : "none";
    marker.style.transform = `translateX(${x}px)`;
    if ((plot.cursor.left ?? -1) < 0) showNow(plot);
  };

  const build = (): void => {
    const width = holder.clientWidth;
    if (width === 0) return;
    plot?.destroy();
    const dark = isDark();
    const ink = dark ? "#a9b6c6" : "#55606e";
    const grid = { stroke: dark ? "rgba(255,255,255,0.08)" : "rgba(20,30,45,0.09)", width: 1 };
    const axis = { stroke: ink, grid, ticks: { ...grid, size: 4 }, font: FONT, labelFont: FONT, values: tickTexts };
    plot = new uPlot({
      width, height,
      scales: { x: { time: false } },
      legend: { live: true },
      hooks: { draw: [moveMarker], setLegend: [(u) => u.legend.idx == null && showNow(u)] },
      cursor: { sync: spec.player ? { key: "time" } : undefined, drag: { x: true, y: false }, points: { size: 6 } },
      axes: [
        { ...axis, label: spec.xLabel, labelSize: 18, size: 30 },
        {
          ...axis, label: spec.yLabel, labelSize: 20,
          size: (_u, texts) => 16 + 7 * Math.max(2, ...(texts ?? []).map((text) => text.length)),
        },
      ],
      series: [
        { label: spec.xLabel, value: (_u, v) => (v == null ? "" : short(v, 4)) },
        ...spec.series.map((s): uPlot.Series => ({
          label: s.label, stroke: s.colour(dark), width: s.points ? 0 : 1.6, dash: s.dashed ? [6, 4] : undefined,
          points: { show: s.points === true, size: 7 }, spanGaps: s.joined, pxAlign: 0,
          value: (_u, v) => (v == null ? "" : text(v)),
        })),
      ],
    }, data(), holder);
    if (spec.part) plot.setScale("x", { min: spec.part[0], max: spec.part[1] });
    if (spec.player) {
      plot.over.append(marker);
      plot.over.addEventListener("click", (event) => {
        const box = plot!.over.getBoundingClientRect();
        spec.player!.seek(plot!.posToVal(event.clientX - box.left, "x") / 1e3);
      });
    }
  };

  new ResizeObserver(() => {
    if (!plot) build();
    else if (Math.abs(plot.width - holder.clientWidth) > 1) plot.setSize({ width: holder.clientWidth, height });
  }).observe(holder);
  document.addEventListener("themechange", build);
  spec.player?.onChange(moveMarker);
  const grown = (): void => {
    describe();
    plot?.setData(data());
  };
  return { figure, grown };
}

export function axisLabel(name: string, unit: string): string {
  const text = unitText(unit);
  return text ? `${name} [${text}]` : name;
}
