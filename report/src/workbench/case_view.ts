/** A case: its form and its text, both ways, checked while typing. */

import { h } from "../dom";
import { duration, fixed, thousands } from "../format";
import { api, fileName, type Judgement, type Kind, type Problem, type SchemaSection, type Value } from "./api";
import { drawingView } from "./drawing";
import { Form } from "./form";
import { renew } from "./renew";
import { ShapePanel } from "./shape_panel";

const PAUSE = 120; // ms without a key until the text is checked

const START: Record<Kind, string> = { run: "Start", study: "Start study", map: "Start map", sort: "Start sorter", campaign: "Start campaign" };

export class CaseView {
  readonly element: HTMLElement;
  private readonly head: HTMLElement;
  private readonly form: Form;
  private readonly text = h("textarea", { id: "text", spellcheck: "false", autocomplete: "off", wrap: "off", "aria-label": "The case as text (TOML)" });
  private readonly lines = h("div", { class: "lines", "aria-hidden": "true" });
  private readonly problems = h("ul", { class: "problems", "aria-live": "polite" });
  private readonly summary = h("div", { class: "summary" });
  private readonly status = h("span", { class: "status", role: "status" });
  private readonly saveButton = h("button", { type: "button", id: "save" }, "Save");
  private readonly copyButton = h("button", { type: "button", id: "copy" }, "Copy");
  private readonly shapeFile = h("input", { type: "file", id: "shape-file", accept: ".stl", class: "unseen", tabindex: -1, "aria-hidden": "true" });
  private readonly shapeButton = h("button", { type: "button", id: "shape" }, "Shape from a file");
  private readonly starts = h("span", { class: "starts" });
  private readonly shapes: ShapePanel;
  private digest = "";
  private saved = "";
  private timer = 0;
  private checking: AbortController | null = null;
  private errors = 0;
  private starting = false;
  private judgement: Judgement | null = null;
  /** Changes of the form, one after the other: each works on the text that the last one left. */
  private edits: Promise<void> = Promise.resolve();

  constructor(readonly name: string, schema: SchemaSection[], private readonly started: (job: string) => void, copied: (name: string) => void) {
    this.shapes = new ShapePanel(schema, (path, value) => this.change(path, value));
    this.form = new Form(schema, { set: (path, value) => this.change(path, value) });
    this.text.addEventListener("input", () => this.typed());
    this.text.addEventListener("scroll", () => (this.lines.scrollTop = this.text.scrollTop));
    this.saveButton.addEventListener("click", () => void (this.changed && this.save()));
    this.copyButton.addEventListener("click", () => {
      const copy = prompt("Name of the copy", name.split("/").at(-1)!.replace(/(-(\d+))?\.toml$/, (_all, _dash, n: string | undefined) => `-${Number(n ?? 1) + 1}.toml`));
      if (copy) this.save().then(() => api.copy(name, fileName(copy, ".toml"))).then((made) => copied(made.name), (error: Error) => this.say(error.message));
    });
    this.shapeButton.addEventListener("click", () => this.shapeFile.click());
    this.shapeFile.addEventListener("change", () => {
      const file = this.shapeFile.files?.[0];
      if (file) void this.useShape(file);
      this.shapeFile.value = "";
    });
    this.element = h("section", { class: "case", "aria-labelledby": "case-name" },
      this.head = h("div", { class: "head" },
        h("header", { class: "bar" }, h("h1", { id: "case-name" }, name), this.status, this.shapeButton, this.shapeFile, this.copyButton, this.saveButton, this.starts), this.problems),
      h("div", { class: "sides" }, this.form.element,
        h("div", { class: "text-side" }, h("div", { class: "editor" }, this.lines, this.text), this.shapes.element, this.summary)));
    // What stays in sight beside the form begins below the head, which grows with the faults.
    new ResizeObserver(() => this.element.style.setProperty("--head", `${this.head.offsetHeight}px`)).observe(this.head);
    addEventListener("beforeunload", (event) => {
      if (this.element.isConnected && this.changed) event.preventDefault();
    });
  }

  get changed(): boolean {
    return this.text.value !== this.saved;
  }

  async open(): Promise<void> {
    const { text, digest } = await api.open(this.name);
    this.text.value = this.saved = text;
    this.digest = digest;
    await this.check();
  }

  private change(path: string, value: string | null): void {
    this.changeAll([[path, value]]);
  }

  /** All that belongs together, checked once. */
  private changeAll(values: [path: string, value: string | null][]): void {
    this.edits = this.edits.then(async () => {
      try {
        for (const [path, value] of values) {
          const { text } = value === null ? await api.unset(this.text.value, path) : await api.set(this.text.value, path, value);
          this.text.value = text;
        }
        await this.check();
      } catch (error) {
        this.say((error as Error).message);
      }
    });
  }

  private typed(): void {
    this.tellChanged();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.check(), PAUSE);
  }

  private tellChanged(): void {
    this.say(this.changed ? "not saved" : "");
    this.saveButton.ariaDisabled = this.changed ? null : "true"; // one that is disabled would lose the focus
  }

  private say(words: string): void {
    this.status.textContent = words;
  }

  private async check(): Promise<void> {
    this.checking?.abort();
    const mine = (this.checking = new AbortController());
    try {
      const judgement = await api.check(this.name, this.text.value, mine.signal);
      if (this.checking === mine) this.show(judgement);
    } catch (error) {
      if (!mine.signal.aborted) this.say((error as Error).message);
    }
  }

  private show(judgement: Judgement): void {
    this.judgement = judgement;
    this.errors = judgement.problems.filter((p) => p.severity === "error").length;
    this.tellChanged();
    this.offer(judgement.commands ?? []);
    for (const b of this.starts.querySelectorAll("button")) b.disabled = this.errors > 0;
    renew(this.problems, ...judgement.problems.slice(0, 20).map((p) => this.problem(p)));
    const faulty = new Map(judgement.problems.map((p) => [p.line, p.severity]));
    const count = this.text.value.split("\n").length;
    this.lines.replaceChildren(...[...Array(count).keys()].map((n) => h("span", { class: faulty.get(n + 1) ?? "" }, String(n + 1))));
    if (judgement.values) {
      this.form.show(judgement.values, judgement.problems);
      this.shapes.show(judgement.values, judgement.check?.bodies ?? []);
    }
    this.summary.classList.toggle("stale", !judgement.check); // until the faults are mended: what it was before
    if (judgement.check) renew(this.summary, ...(judgement.drawing ? [drawingView(judgement.drawing)] : []), ...this.facts(judgement));
  }

  private problem(p: Problem): HTMLElement {
    const go = h("button", { type: "button", class: "where" }, p.line ? `line ${p.line}` : p.key || "case");
    go.addEventListener("click", () => p.line && this.goTo(p.line));
    return h("li", { class: p.severity }, go, " ", p.key ? h("code", {}, p.key) : null, p.key ? ": " : null, p.what,
      p.expected ? h("span", { class: "more" }, `expected: ${p.expected}`) : null,
      p.nearest ? h("span", { class: "more" }, `nearest: ${p.nearest}`) : null,
      p.example ? h("span", { class: "more" }, "example: ", h("code", {}, p.example)) : null);
  }

  private goTo(line: number): void {
    const lines = this.text.value.split("\n");
    const begin = lines.slice(0, line - 1).reduce((sum, l) => sum + l.length + 1, 0);
    this.text.focus();
    this.text.setSelectionRange(begin, begin + (lines[line - 1]?.length ?? 0));
    this.text.scrollTop = (line - 4) * parseFloat(getComputedStyle(this.text).lineHeight);
  }

  private facts({ check }: Judgement): HTMLElement[] {
    if (!check) return [];
    const rows: [string, string][] = [];
    if (check.cells) rows.push(["cells", thousands(check.cells)]);
    if (check.expected_wall_time_s !== undefined) rows.push(["time", `about ${duration(Math.max(1, Math.round(check.expected_wall_time_s)))}`]);
    for (const b of check.bodies) {
      const size = b.size_m.map((v) => fixed(v * 1e3, 1)).join(" \u00d7 ");
      rows.push([b.name, `${size} mm, ${fixed(b.mass_kg * 1e3, 2)} g${b.cells_across ? `, ${fixed(b.cells_across, 1)} cells across` : ""}`]);
      if (b.over_jet_s) rows.push(["", `over the jet from ${fixed(b.over_jet_s[0] * 1e3, 1)} to ${fixed(b.over_jet_s[1] * 1e3, 1)} ms`]);
    }
    const list = h("dl", { class: "facts" }, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
    const assumptions = h("details", { class: "assumed" }, h("summary", {}, `${check.assumptions.length} assumptions, since the case does not say`),
      h("ul", {}, ...check.assumptions.map((a) => h("li", {}, h("code", {}, `${a.key} = ${a.value}`), ` ${a.what} (${a.reason})`))));
    return check.assumptions.length ? [list, assumptions] : [list];
  }

  async save(): Promise<boolean> {
    try {
      await this.edits; // what was chosen in the form is in the text when its answer is here
      const text = this.text.value;
      this.digest = (await api.save(this.name, text, this.digest)).digest;
      this.saved = text;
      this.tellChanged();
      return true;
    } catch (error) {
      this.say((error as Error).message);
      return false;
    }
  }

  /** A button for each command that the case has what it takes for. */
  private offer(commands: Kind[]): void {
    if (this.starts.dataset["of"] === commands.join()) return;
    this.starts.dataset["of"] = commands.join();
    renew(this.starts, ...commands.map((kind, n) => {
      const b = h("button", { type: "button", class: n === 0 && "primary", "data-start": kind }, START[kind]);
      b.addEventListener("click", () => void this.start(kind));
      return b;
    }));
  }


  private async start(kind: Kind): Promise<void> {
    if (this.starting) return; // one click, one run
    this.starting = true;
    try {
      await this.edits;
      if (this.changed && !(await this.save())) return;
      this.started((await api.start(this.name, kind)).job);
    } catch (error) {
      this.say((error as Error).message);
    } finally {
      this.starting = false;
    }
  }

  private get values(): Record<string, Value> {
    return this.judgement?.values ?? {};
  }

  /** What was the 10 mm cube of a template is one no more. A name that something else in the case goes by stays. */
  private rename(name: string): void {
    const [body, title] = ["body.0.name", "run.title"].map((key) => this.values[key]);
    if (!body?.given) return;
    const old = JSON.parse(body.text) as string;
    const said = this.text.value.replace(/#.*$/gm, "");
    const own = title?.text === body.text ? 2 : 1; // the title and the name itself
    if (said.split(body.text).length - 1 > own || said.includes(`body.${old}.`)) return;
    const called = JSON.stringify(name);
    this.changeAll([["body.0.name", called], ...(title?.given && title.text.includes(old) ? [["run.title", called] as [string, string]] : [])]);
  }

  /** Dents that the grid cannot see are filled, no larger ones than it takes; `size`: of the body, in the unit of its file. */
  private async simplify(file: string, size: number): Promise<void> {
    await this.edits;
    const tooFine = (p: Problem): boolean => p.key === "body.0.fit_error" || (p.key === "body.0" && p.what.includes("cells across"));
    const unseen = (): boolean => (this.judgement?.problems ?? []).some((p) => p.severity === "error" && tooFine(p));
    const scale = Number(this.values["body.0.scale"]?.text ?? 1);
    for (const share of [0.01, 0.02, 0.04, 0.06, 0.08, 0.1]) {
      if (!unseen()) return;
      const filled = Number((share * size * scale * 1e3).toPrecision(2));
      this.shapes.simplified(file, filled);
      this.change("body.0.fit_error", `"${filled} mm"`);
      await this.edits;
    }
    if (unseen()) this.change("body.0.fit_error", null);
    await this.edits;
  }

  /** A file becomes the shape of the first body. What the checker then finds out of place was of its former shape. */
  async useShape(file: File): Promise<void> {
    try {
      const { name, extent } = await api.upload(file, this.name);
      this.changeAll(this.shapes.take(name, extent));
      await this.edits;
      const left = (this.judgement?.problems ?? []).filter((p) => p.severity === "error" && p.key.startsWith("body.0.") && p.key !== "body.0.fit_error" && this.judgement?.values?.[p.key]?.given);
      if (left.length) this.changeAll(left.map(({ key }) => [key, null]));
      await this.edits;
      this.rename(name.replace(/\.stl$/i, ""));
      await this.simplify(name, Math.max(...extent));
    } catch (error) {
      this.say((error as Error).message);
    }
  }
}
