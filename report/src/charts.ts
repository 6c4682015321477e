import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { isDark } from "./colour";
import { h } from "./dom";
import { short, unitText } from "./format";
import type { Player } from "./player";

export interface Series {
  label: string;
  values: ArrayLike<number>;
  colour: (dark: boolean) => string;
  dashed?: boolean;
}

export interface ChartSpec {
  title: string;
  xLabel: string;
  yLabel: string;
  x: ArrayLike<number>;
  series: Series[];
  /** Charts over time (ms) share a cursor, show the player's time and set it when clicked. */
  player?: Player;
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

export function chart(spec: ChartSpec, height = 210): HTMLElement {
  const holder = h("div", { class: "chart", role: "img", "aria-label": `${spec.title}, ${spec.yLabel} over ${spec.xLabel}. ${summary(spec)}.` });
  const figure = h("figure", { class: "chart-figure" }, h("figcaption", {}, spec.title), holder);
  let plot: uPlot | undefined;
  const marker = h("div", { class: "now-line", "aria-hidden": "true" });

  const moveMarker = (): void => {
    if (!plot || !spec.player) return;
    const x = plot.valToPos(spec.player.time * 1e3, "x");
    marker.style.display = x >= 0 && x <= plot.over.clientWidth ? "block" : "none";
    marker.style.transform = `translateX(${x}px)`;
  };

  const build = (): void => {
    const width = holder.clientWidth;
    if (width === 0) return;
    plot?.destroy();
    const dark = isDark();
    const ink = dark ? "#a9b6c6" : "#55606e";
    const grid = { stroke: dark ? "rgba(255,255,255,0.08)" : "rgba(20,30,45,0.09)", width: 1 };
    const axis = { stroke: ink, grid, ticks: { ...grid, size: 4 }, font: FONT, labelFont: FONT };
    plot = new uPlot({
      width, height,
      scales: { x: { time: false } },
      legend: { live: true },
      cursor: { sync: spec.player ? { key: "time" } : undefined, drag: { x: true, y: false }, points: { size: 6 } },
      axes: [
        { ...axis, label: spec.xLabel, labelSize: 18, size: 30 },
        { ...axis, label: spec.yLabel, labelSize: 18, size: 54, values: (_u, list) => list.map((v) => short(v, 3)) },
      ],
      series: [
        { label: spec.xLabel, value: (_u, v) => (v == null ? "\u2013" : short(v, 4)) },
        ...spec.series.map((s): uPlot.Series => ({
          label: s.label, stroke: s.colour(dark), width: 1.6, dash: s.dashed ? [6, 4] : undefined, points: { show: false },
          value: (_u, v) => (v == null ? "\u2013" : short(v, 4)),
        })),
      ],
    }, [spec.x, ...spec.series.map((s) => s.values)] as unknown as uPlot.AlignedData, holder);
    if (spec.player) {
      plot.over.append(marker);
      plot.over.addEventListener("click", (event) => {
        const box = plot!.over.getBoundingClientRect();
        spec.player!.seek(plot!.posToVal(event.clientX - box.left, "x") / 1e3);
      });
      moveMarker();
    }
  };

  new ResizeObserver(() => {
    if (!plot) build();
    else if (Math.abs(plot.width - holder.clientWidth) > 1) {
      plot.setSize({ width: holder.clientWidth, height });
      moveMarker();
    }
  }).observe(holder);
  document.addEventListener("themechange", build);
  spec.player?.onChange(moveMarker);
  return figure;
}

export function axisLabel(name: string, unit: string): string {
  const text = unitText(unit);
  return text ? `${name} [${text}]` : name;
}
