/** A form of the keys of a case, made from the schema; the text stays what counts. */

import { h } from "../dom";
import type { Key, Problem, SchemaSection, Value } from "./api";
import { renew } from "./renew";

export interface FormEvents {
  /** `value` stands as TOML; null: back to the default. */
  set(path: string, value: string | null): void;
}

const quoted = (text: string): string => JSON.stringify(text);

/** "8 ms" -> ["8", "ms"] */
function split(text: string, units: string[]): [string, string] | null {
  const found = /^"\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(.+?)\s*"$/.exec(text);
  return found && units.includes(found[2]!) ? [found[1]!, found[2]!] : null;
}

/** A default that no number or text says: "no limit". */
const IN_WORDS = /^[a-z]/;

/** What the first sections of a sorter are; the rest follows in the order of the schema. */
const FIRST = ["run", "body", "material", "valve", "launch", "splitter", "jet"];

export class Form {
  readonly element = h("div", { class: "form" });
  private readonly fields = new Map<string, { field: HTMLElement; key: Key }>();
  private shape = "";

  constructor(private readonly schema: SchemaSection[], private readonly events: FormEvents) {}

  show(values: Record<string, Value>, problems: Problem[]): void {
    const counts = this.counts(values);
    const shape = JSON.stringify(counts);
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(counts);
    }
    for (const [path, { field, key }] of this.fields) this.fill(field, key, values[path]);
    this.mark(problems);
  }

  /** Elements of each list of sections. */
  private counts(values: Record<string, Value>): Record<string, number> {
    const counts: Record<string, number> = {};
    for (const section of this.schema) {
      if (!section.repeated) continue;
      let count = 0;
      while (section.keys.some((key) => `${section.name}.${count}.${key.name}` in values)) ++count;
      counts[section.name] = count;
    }
    return counts;
  }

  private build(counts: Record<string, number>): void {
    const open = this.element.childElementCount === 0 ? ["run", "body.0", "valve", "launch", "splitter"] : [];
    this.fields.clear();
    const rank = (s: SchemaSection): number => (FIRST.includes(s.name) ? FIRST.indexOf(s.name) : FIRST.length);
    const ordered = [...this.schema].sort((a, b) => rank(a) - rank(b));
    renew(this.element, ...ordered.flatMap((section) => {
      const places = section.repeated ? [...Array(counts[section.name] ?? 0).keys()].map((n) => `${section.name}.${n}`) : [section.name];
      return places.map((place) => this.section(section, place, open.includes(place)));
    }));
  }

  private section(section: SchemaSection, place: string, open: boolean): HTMLElement {
    return h("details", { id: `section-${place}`, open },
      h("summary", {}, h("span", { class: "section-name" }, section.repeated ? `[[${section.name}]] ${Number(place.split(".").at(-1)) + 1}` : `[${section.name}]`),
        " ", h("span", { class: "section-help" }, section.help)),
      ...section.keys.map((key) => this.field(key, `${place}.${key.name}`)));
  }

  private field(key: Key, path: string): HTMLElement {
    const id = `key-${path}`;
    const reset = h("button", { type: "button", class: "reset", title: "Back to the default", "aria-label": `${path} back to the default` }, "\u00d7");
    reset.addEventListener("click", () => this.events.set(path, null));
    const field = h("div", { class: "field" },
      h("label", { for: id }, ...key.name.split(/(?<=_)/).flatMap((part, n) => (n ? [h("wbr"), part] : [part]))), h("div", { class: "control" }, ...this.controls(key, path, id), reset),
      h("p", { class: "help", id: `${id}-help` }, `${key.help}. Takes ${key.takes}. Default: ${key.default}.`),
      h("p", { class: "fault", hidden: true }));
    this.fields.set(path, { field, key });
    return field;
  }

  private controls(key: Key, path: string, id: string): HTMLElement[] {
    const about = { id, "aria-describedby": `${id}-help` };
    const words = key.yes_or_no ? { true: "yes", false: "no" } : key.words;
    if (words) {
      const select = h("select", about, ...Object.entries(words).map(([word, help]) =>
        h("option", { value: word, title: help }, key.yes_or_no ? help : word)));
      select.addEventListener("change", () => this.events.set(path, key.yes_or_no ? select.value : quoted(select.value)));
      return [select];
    }
    const input = h("input", { ...about, type: "text", autocomplete: "off", spellcheck: "false" });
    if (key.units.length === 0 || key.takes.startsWith("a list")) {
      const text = key.takes.startsWith("a text");
      input.addEventListener("change", () => {
        if (input.value.trim()) this.events.set(path, text ? quoted(input.value) : input.value);
      });
      return [input];
    }
    const unit = h("select", { class: "unit", "aria-label": `Unit of ${path}` }, ...key.units.map((u) => h("option", { value: u }, u)));
    const send = (): void => {
      if (!input.value.trim()) return;
      const bare = /^\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?\s*$/.test(input.value);
      this.events.set(path, quoted(bare ? `${input.value.trim()} ${unit.value}` : input.value.trim()));
    };
    input.addEventListener("change", send);
    unit.addEventListener("change", send);
    return [input, unit];
  }

  private fill(field: HTMLElement, key: Key, value: Value | undefined): void {
    field.classList.toggle("given", value?.given ?? false);
    field.querySelector<HTMLButtonElement>(".reset")!.hidden = !value?.given;
    const text = value?.text ?? "";
    const control = field.querySelector<HTMLInputElement | HTMLSelectElement>("input, select:not(.unit)")!;
    if (control === document.activeElement && control instanceof HTMLInputElement) return; // somebody types there
    const unit = field.querySelector<HTMLSelectElement>(".unit");
    const parts = unit ? split(text, [...unit.options].map((o) => o.value)) : null;
    let plain = text;
    if (parts) [plain, unit!.value] = parts;
    else if (/^".*"$/.test(text)) plain = JSON.parse(text) as string;
    if (control instanceof HTMLSelectElement) control.value = plain;
    else {
      control.value = value?.given ? plain : "";
      control.placeholder = IN_WORDS.test(key.default) ? key.default : plain;
    }
  }

  private mark(problems: Problem[]): void {
    for (const [path, { field, key }] of this.fields) {
      const mine = problems.find((p) => p.key === path);
      const fault = field.querySelector<HTMLElement>(".fault")!;
      fault.hidden = !mine;
      fault.textContent = mine ? `${mine.what}${mine.expected ? `; expected: ${mine.expected}` : ""}` : "";
      // What only another choice needs, another shape of the body, is out of the way.
      field.hidden = key.default.startsWith("needed for") && !mine && !field.classList.contains("given");
      fault.className = `fault ${mine?.severity ?? ""}`;
      field.querySelector("input, select")!.setAttribute("aria-invalid", String(mine?.severity === "error"));
    }
  }
}
