import uPlot from "uplot";
import { chart, type Series } from "./charts";
import { bodyColour } from "./colour";
import type { Figure, Picture, Run } from "./data";
import { h } from "./dom";

/** Series with places of their own on one axis: what a series does not know is left open. */
function joined(figure: Figure): { x: ArrayLike<number>; values: ArrayLike<number>[] } {
  const [x, ...values] = uPlot.join(figure.series.map((s) => [s.x, s.y] as uPlot.AlignedData));
  return { x: x as number[], values: values as number[][] };
}

function figureChart(figure: Figure): HTMLElement {
  const { x, values } = joined(figure);
  const series = figure.series.map((s, n): Series => ({
    label: s.label, values: values[n]!, colour: (dark) => bodyColour(n, dark), dashed: s.dashed, points: s.points, joined: true,
  }));
  return chart({ title: figure.title, xLabel: figure.x_label, yLabel: figure.y_label, x, series }, 280);
}

function pictureView(picture: Picture): HTMLElement {
  const canvas = h("canvas", { class: "picture", role: "img", "aria-label": picture.title });
  canvas.width = picture.width;
  canvas.height = picture.height;
  const image = new ImageData(picture.width, picture.height);
  picture.pixels.forEach((grey, n) => image.data.set([grey, grey, grey, 255], 4 * n));
  canvas.getContext("2d")!.putImageData(image, 0, 0);
  return h("figure", { class: "chart-figure" }, h("figcaption", {}, picture.title), canvas);
}

/** Pictures over the whole width. */
export function pictureViews(runs: Run[]): HTMLElement[] {
  return runs.flatMap((run) => run.pictures.map(pictureView));
}

/** The diagrams a run brings along (figures.json). */
export function figureCharts(runs: Run[]): HTMLElement[] {
  return runs.flatMap((run) => run.figures.map((f) =>
    figureChart(runs.length > 1 ? { ...f, title: `${f.title}, ${run.name}` } : f)));
}
