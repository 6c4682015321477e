/** Bodies that are files: the unit of the file, and how they lie. It only changes keys of the case; the checker and the
 * drawing say what comes of it. */

import { h } from "../dom";
import { fixed } from "../format";
import type { BodyCheck, Key, SchemaSection, Value } from "./api";
import { renew } from "./renew";

type Quaternion = [w: number, x: number, y: number, z: number];
type Extent = [number, number, number];

/** A particle on a sorter's belt is about so large, m: of the units in which it would be, the first is guessed. */
const LIKELY: [number, number] = [0.5e-3, 0.5];
const GUESSES = ["mm", "m", "in", "cm", "um"];
const AXES = ["x", "y", "z"];

function times([aw, ax, ay, az]: Quaternion, [bw, bx, by, bz]: Quaternion): Quaternion {
  return [
    aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
  ];
}

function turn(axis: number[], angle: number): Quaternion {
  const length = Math.hypot(...axis) || 1;
  const s = Math.sin(angle / 2) / length;
  return [Math.cos(angle / 2), axis[0]! * s, axis[1]! * s, axis[2]! * s];
}

const rounded = (value: number, digits: number): number => Number(value.toFixed(digits)) + 0;

export class ShapePanel {
  readonly element = h("div", { class: "shapes" });
  private readonly lengths: Key;
  private readonly angles: Key;
  private readonly guessed = new Map<string, { extent: Extent; unit: string; filled?: number }>();
  private values: Record<string, Value> = {};
  private readonly panels = new Map<string, { element: HTMLElement; fill: (size: Extent | undefined) => void }>();

  constructor(schema: SchemaSection[], private readonly change: (path: string, value: string | null) => void) {
    const keys = schema.find((section) => section.name === "body")!.keys;
    this.lengths = keys.find((key) => key.name === "diameter")!;
    this.angles = keys.find((key) => key.name === "rotation_angle")!;
  }

  /** What makes a file the shape of the first body; dents that were filled were those of its former shape. */
  take(file: string, extent: Extent): [path: string, value: string | null][] {
    const size = Math.max(...extent);
    const likely = (unit: string): boolean => size * this.factor(unit) >= LIKELY[0] && size * this.factor(unit) <= LIKELY[1];
    const unit = GUESSES.find(likely) ?? "mm";
    this.guessed.set(file, { extent, unit });
    const filled: [string, null][] = this.values["body.0.fit_error"]?.given ? [["body.0.fit_error", null]] : [];
    return [["body.0.shape", '"mesh"'], ["body.0.file", JSON.stringify(file)], ["body.0.scale", String(this.factor(unit))], ...filled];
  }

  /** Dents of up to so many mm were filled, since the grid does not see them. */
  simplified(file: string, filled: number): void {
    const guess = this.guessed.get(file);
    if (guess) guess.filled = filled;
  }

  /** Of a length as the case has it, mm. */
  private millimetres(path: string): number | null {
    const [value, unit] = /^"\s*([-+0-9.eE]+)\s*([a-z]+)\s*"$/.exec(this.values[path]?.text ?? "")?.slice(1) ?? [];
    const known = unit !== undefined && this.lengths.units.includes(unit);
    return known ? Number((Number(value) * this.factor(unit) * 1e3).toPrecision(6)) : null;
  }

  private factor(unit: string): number {
    return this.lengths.factors[this.lengths.units.indexOf(unit)]!;
  }

  show(values: Record<string, Value>, bodies: BodyCheck[]): void {
    this.values = values;
    const there = new Set<string>();
    for (let n = 0; values[`body.${n}.shape`]; ++n) {
      const file = values[`body.${n}.file`];
      if (values[`body.${n}.shape`]!.text !== '"mesh"' || !file?.given || !file.text.startsWith('"')) continue;
      const name = JSON.parse(file.text) as string;
      const id = `${n} ${name}`;
      there.add(id);
      const panel = this.panels.get(id) ?? this.panel(n, name);
      this.panels.set(id, panel);
      panel.fill(bodies[n]?.size_m);
    }
    for (const [id] of this.panels) if (!there.has(id)) this.panels.delete(id);
    const shown = [...this.panels.values()].map((panel) => panel.element);
    if (shown.length !== this.element.childElementCount || shown.some((e, n) => this.element.children[n] !== e)) renew(this.element, ...shown);
  }

  private scaleOf(body: number): number {
    return Number(this.values[`body.${body}.scale`]?.text ?? 1);
  }

  private panel(body: number, file: string): { element: HTMLElement; fill: (size: Extent | undefined) => void } {
    const id = `shape-${body}`;
    const unit = h("select", { id: `${id}-unit` }, ...this.lengths.units.map((u) => h("option", { value: u }, u)), h("option", { value: "", disabled: true }, "none of these"));
    unit.addEventListener("change", () => this.change(`body.${body}.scale`, String(this.factor(unit.value))));
    const size = h("span", { class: "size" });
    const guess = h("p", { class: "note" });
    const longest = h("input", { id: `${id}-longest`, type: "number", min: 0, step: "any" });
    let now = 0; // its longest side, mm
    longest.addEventListener("change", () => {
      const wanted = Number(longest.value);
      if (wanted > 0 && now > 0) this.change(`body.${body}.scale`, String(Number(((this.scaleOf(body) * wanted) / now).toPrecision(6))));
    });
    const filled = h("input", { id: `${id}-filled`, type: "number", min: 0, step: "any", placeholder: "none" });
    filled.addEventListener("change", () => this.change(`body.${body}.fit_error`, Number(filled.value) > 0 ? `"${filled.value} mm"` : null));
    const angle = h("input", { id: `${id}-angle`, type: "number", value: 90, step: 5 });
    const turns = AXES.map((axis, d) => {
      const b = h("button", { type: "button", "aria-label": `Turn ${file} about ${axis}` }, axis);
      b.addEventListener("click", () => this.turn(body, d, (Number(angle.value) * Math.PI) / 180));
      return b;
    });
    const back = h("button", { type: "button" }, "as in the file");
    back.addEventListener("click", () => {
      this.change(`body.${body}.rotation_axis`, null);
      this.change(`body.${body}.rotation_angle`, null);
    });
    const element = h("fieldset", {}, h("legend", {}, file),
      h("div", { class: "row" }, h("label", { for: unit.id }, "The file is in"), unit, size),
      h("div", { class: "row" }, h("label", { for: longest.id }, "Longest side"), longest, "mm"),
      h("div", { class: "row" }, h("label", { for: filled.id }, "Dents filled up to"), filled, "mm"), guess,
      h("div", { class: "row" }, h("label", { for: angle.id }, "Turn by"), angle, "\u00b0 about", ...turns, back));
    const fill = (checked: Extent | undefined): void => {
      const scale = this.scaleOf(body);
      const known = this.lengths.units.find((u) => Math.abs(this.factor(u) / scale - 1) < 1e-9);
      if (document.activeElement !== unit) unit.value = known ?? "";
      const first = this.guessed.get(file);
      const m = checked ?? first?.extent.map((v) => v * scale);
      now = m ? Math.max(...m) * 1e3 : 0;
      longest.disabled = !m;
      if (document.activeElement !== longest) longest.value = m ? fixed(now, 1) : "";
      const gone = this.millimetres(`body.${body}.fit_error`);
      if (document.activeElement !== filled) filled.value = gone === null ? "" : String(gone);
      size.textContent = m ? `${m.map((v) => fixed(v * 1e3, 1)).join(" \u00d7 ")} mm` : "";
      guess.textContent = [
        first && known === first.unit ? `An STL file does not say its unit: ${first.unit} is guessed from its size. Is it that large?` : "",
        first?.filled && gone === first.filled ? `Dents of up to ${gone} mm are filled: the grid cannot see finer parts, and the air's force on them would be wrong.` : "",
      ].filter(Boolean).join(" ");
      const given = this.values[`body.${body}.rotation_angle`]?.given || this.values[`body.${body}.rotation_axis`]?.given;
      back.disabled = !given;
    };
    return { element, fill };
  }

  /** A turn about an axis of the world, after those that the case has. */
  private turn(body: number, axis: number, angle: number): void {
    const axisText = this.values[`body.${body}.rotation_axis`]?.text ?? "[0, 0, 1]";
    const [value, unit] = /^"?\s*([-+0-9.eE]+)\s*([a-z]*)\s*"?$/.exec(this.values[`body.${body}.rotation_angle`]?.text ?? '"0 rad"')?.slice(1) ?? ["0", "rad"];
    const factor = this.angles.factors[this.angles.units.indexOf(unit || "rad")] ?? 1;
    let axisNow: number[];
    try {
      axisNow = JSON.parse(axisText) as number[];
    } catch {
      return; // it is being typed; the checker says what is wrong
    }
    let [w, x, y, z] = times(turn([0, 1, 2].map((d) => Number(d === axis)), angle), turn(axisNow, Number(value) * factor));
    if (w < 0) [w, x, y, z] = [-w, -x, -y, -z];
    const sine = Math.hypot(x, y, z);
    if (sine < 1e-9) {
      this.change(`body.${body}.rotation_axis`, null);
      this.change(`body.${body}.rotation_angle`, null);
      return;
    }
    const degrees = (2 * Math.atan2(sine, w) * 180) / Math.PI;
    this.change(`body.${body}.rotation_axis`, `[${[x, y, z].map((v) => rounded(v / sine, 9)).join(", ")}]`);
    this.change(`body.${body}.rotation_angle`, `"${rounded(degrees, 6)} deg"`);
  }
}
