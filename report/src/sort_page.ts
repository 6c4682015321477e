import { h, section } from "./dom";
import { duration, fixed, short, thousands, unbroken } from "./format";
import type { SortFate, SortResult } from "./sort_data";
import { sortView } from "./sort_view";

const REASONS: { [fate: string]: string } = {
  ejected: "ejected, as it should be",
  kept: "kept, as it should be",
  missed_not_seen: "missed: the camera did not see it",
  missed_misread: "missed: read as to be kept",
  missed_agglomerated: "missed: one object with others",
  missed_dead_valve: "missed: its valve is dead",
  missed_late: "missed: it did not come where and when it was seen to come",
  missed_pushed: "missed: others near it in the air pushed it, or took its air",
  missed_struck_plate: "missed: it struck the plate",
  missed_too_weak: "missed: the shot was too weak",
  taken_pushed: "taken along: pushed over the plate by another",
  taken_in_window: "taken along by a shot at another",
  taken_misread: "taken along: read as to be ejected",
  taken_agglomerated: "taken along: one object with others",
};

type Shares = { [name: string]: number | null };

function shareFact(sort: SortResult, name: string, label: string): HTMLElement {
  const of = (key: string): number | null => (sort as unknown as Shares)[key] ?? null;
  const value = of(name);
  const text = value === null ? "\u2013" : fixed(100 * value, 1);
  const range = value === null ? "" : ` (${fixed(100 * of(`${name}_low`)!, 1)} to ${fixed(100 * of(`${name}_high`)!, 1)})`;
  return h("div", {}, h("dd", {}, text, h("span", { class: "unit" }, ` %${range}`)), h("dt", {}, label));
}

function fact(text: string, unit: string, label: string): HTMLElement {
  return h("div", {}, h("dd", {}, text, h("span", { class: "unit" }, ` ${unit}`)), h("dt", {}, label));
}

export function facts(sort: SortResult): HTMLElement {
  return h("div", { class: "cards" }, h("article", { class: "card" }, h("dl", {},
    shareFact(sort, "recovery_mass", "recovery by mass; in brackets 95 %"),
    shareFact(sort, "purity_mass", "purity of the ejected product by mass"),
    shareFact(sort, "loss_mass", "of what should be kept is lost, by mass"),
    fact(fixed(sort.throughput_t_h, 2), "t/h", "throughput"),
    fact(fixed(100 * sort.cover, 1), "%", "of the belt covered"),
    fact(fixed(100 * sort.standing_alone, 1), "%", "of the particles stand alone"),
    fact(short(sort.air_Nm3_per_t), "Nm\u00b3/t", "air per tonne of feed"),
    fact(short(sort.air_Nm3_per_t_ejected), "Nm\u00b3/t", "air per tonne ejected"))));
}

function table(head: string[], rows: (string | Node)[][]): HTMLElement {
  return h("div", { class: "table-holder" }, h("table", {},
    h("thead", {}, h("tr", {}, ...head.map((text, n) => h("th", { scope: "col", class: n > 0 && "number" }, text)))),
    h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row.map((cell, n) =>
      n === 0 ? h("th", { scope: "row" }, cell) : h("td", { class: "number" }, cell)))))));
}

/** The tree of losses: what should be ejected and what should be kept, each by what became of it. */
function tree(sort: SortResult): HTMLElement {
  const branch = (title: string, belongs: string): HTMLElement | null => {
    const names = sort.classes.filter((c) => c.belongs_in === belongs).map((c) => c.name);
    const mass = (f: SortFate): number => names.reduce((sum, name) => sum + f.classes[name]!.mass_kg, 0);
    const number = (f: SortFate): number => names.reduce((sum, name) => sum + f.classes[name]!.number, 0);
    const all = sort.fates.reduce((sum, f) => sum + mass(f), 0);
    if (all === 0) return null;
    return h("div", {}, h("h3", {}, `${title}: ${names.join(", ")}`), table(["Fate", "Share of the mass", "Particles", "Mass [kg]"],
      sort.fates.filter((f) => number(f) > 0).map((f) => [
        REASONS[f.fate] ?? f.fate,
        h("span", { class: "bar", style: `--share:${(mass(f) / all).toFixed(4)}` }, `${fixed((100 * mass(f)) / all, 2)} %`),
        thousands(number(f)), short(mass(f), 4)])));
  };
  return h("div", {}, branch("To be ejected", "ejected"), branch("To be kept", "kept"));
}

export function sortPage(sort: SortResult): HTMLElement {
  const main = h("main", { id: "content" }, h("header", { class: "verdict" }, h("p", { class: "title" }, sort.title),
    h("h1", { id: "verdict" }, unbroken(sort.summary)), facts(sort)));
  const add = (id: string, title: string, note: string, ...content: (Node | null)[]): void => {
    if (content.some(Boolean)) main.append(section(id, title, note, ...content));
  };
  add("machine", "Machine", "The first particles of the feed, from above and from the side.", sortView(sort));
  add("losses", "Losses", "What became of each particle, and why. Also in fates.csv.", tree(sort));
  add("classes", "Classes", "", table(["Class", "belongs in", "particles", "mass [kg]", "ejected", "ejected [kg]"],
    sort.classes.map((c) => [c.name, c.belongs_in, thousands(c.particles), short(c.mass_kg, 4), thousands(c.ejected), short(c.ejected_kg, 4)])));
  add("cost", "Air and cost", "", table(["Quantity", "Value"], [
    ["Shots", thousands(sort.shots)], ["Valve openings", thousands(sort.valve_openings)], ["Dead valves", thousands(sort.dead_valves)],
    ["Air [Nm\u00b3]", short(sort.air_Nm3, 4)], ["Least work to compress it [kWh per tonne of feed]", short(sort.air_least_work_kWh_per_t, 3)],
    ["Tier", sort.tier], ["Resolved shots", thousands(sort.resolved_shots)], ["Wall time", duration(sort.wall_time_s)]]));
  add("assumptions", "Assumptions", "Taken for granted; each can be changed in the case file.",
    h("ul", { class: "assumptions" }, ...sort.assumptions.map((a) => h("li", {},
      h("p", { class: "what" }, `${a.what}: `, h("strong", {}, a.value)), a.reason ? h("p", {}, a.reason) : null,
      h("p", { class: "key-name" }, "Change it with ", h("code", {}, a.key))))));
  const links = [...main.querySelectorAll("section")].map((s) => h("a", { href: `#${s.id}` }, s.querySelector("h2")!.textContent));
  return h("div", {}, h("a", { class: "skip", href: "#content" }, "Skip to the result"),
    h("nav", { "aria-label": "Sections" }, h("span", { class: "brand" }, "Ejecta"), ...links), main,
    h("footer", {}, "Ejecta \u00b7 one file, works offline"));
}
