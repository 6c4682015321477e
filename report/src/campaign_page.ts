import type { Json, JsonObject, Run } from "./data";
import { h, section } from "./dom";
import { figureCharts, pictureViews } from "./figures";
import { fixed, unbroken, words } from "./format";
import type { MapResult } from "./map_data";
import { facts } from "./map_page";
import { mapView } from "./map_view";
import { motionCharts, seriesCharts } from "./motion_charts";
import { pathNote, pathView } from "./path";
import type { Player } from "./player";
import { profileCharts } from "./profile_charts";
import { replayView } from "./replay_view";
import type { SortResult } from "./sort_data";
import { facts as sortFacts } from "./sort_page";
import { studyCharts, type StudyResult } from "./study_page";

/** One command of a campaign as `ejecta campaign` writes it (docs/files.md). */
interface Part {
  kind: "run" | "jet" | "jet-sweep" | "map" | "study" | "sort";
  title: string;
  figures: string;
  directory: string;
  done: boolean;
  problem: string;
  summary?: string;
  /** Number among the runs of the page. */
  run?: number;
  result?: JsonObject;
}

export interface Campaign {
  title: string;
  parts: Part[];
}

/** The campaign of this page, if it is the page of one. */
export function readCampaign(): Campaign | null {
  const data = JSON.parse(document.getElementById("ejecta-data")!.textContent!) as { campaign?: Campaign };
  return data.campaign ?? null;
}

const grid = (charts: HTMLElement[]): HTMLElement | null => (charts.length > 0 ? h("div", { class: "chart-grid" }, ...charts) : null);

/** Rows of equal keys as a table, numbers in SI units as the keys say. */
function rowsTable(name: string, rows: JsonObject[]): HTMLElement {
  const columns = [...new Set(rows.flatMap((row) => Object.keys(row)))];
  const cell = (v: Json | undefined): string => (typeof v === "number" ? String(Number(v.toPrecision(4))) : v === undefined || v === null ? "\u2013" : String(v));
  return h("div", { class: "table-holder" }, h("table", {}, h("caption", {}, words(name)),
    h("thead", {}, h("tr", {}, ...columns.map((c) => h("th", { scope: "col", class: "number" }, c.replace(/_/g, " "))))),
    h("tbody", {}, ...rows.map((row) => h("tr", {}, ...columns.map((c) => h("td", { class: "number" }, cell(row[c]))))))));
}

function contentOf(part: Part, runs: Run[], players: (run: Run) => Player): (Node | null)[] {
  if (part.kind === "map") {
    const map = part.result as unknown as MapResult;
    return [facts(map), mapView(map)];
  }
  if (part.kind === "sort") return [sortFacts(part.result as unknown as SortResult)];
  if (part.kind === "study") return [grid(studyCharts(part.result as unknown as StudyResult))];
  if (part.kind === "jet-sweep")
    return Object.entries(part.result ?? {}).flatMap(([name, rows]) =>
      Array.isArray(rows) && typeof rows[0] === "object" ? [rowsTable(name, rows as JsonObject[])] : []);
  const run = runs[part.run!]!;
  const one = [run];
  const player = players(run);
  const charts = [...figureCharts(one), ...profileCharts(one), ...seriesCharts(one, player, (n) => n.startsWith("probe-"))];
  return [pathView(one, player), run.replay ? h("p", { class: "note" }, pathNote(one)) : null, replayView(one, player),
    motionCharts(one, player), ...pictureViews(one), grid(charts)];
}

function verdictTable(campaign: Campaign): HTMLElement {
  const state = (p: Part): string => (p.problem ? p.problem : p.done ? (p.summary ?? "done") : "not done yet");
  return h("div", { class: "table-holder" }, h("table", {},
    h("thead", {}, h("tr", {}, ...["Part", "Figures", "Result"].map((t) => h("th", { scope: "col" }, t)))),
    h("tbody", {}, ...campaign.parts.map((p, n) => h("tr", {},
      h("th", { scope: "row" }, h("a", { href: `#part-${n + 1}` }, p.title)), h("td", {}, p.figures), h("td", {}, state(p)))))));
}

export function campaignPage(campaign: Campaign, runs: Run[], players: (run: Run) => Player): HTMLElement {
  const done = campaign.parts.filter((p) => p.done).length;
  const main = h("main", { id: "content" }, h("header", { class: "verdict" },
    h("p", { class: "title" }, done < campaign.parts.length ? `${done} of ${campaign.parts.length} parts are done` : `${fixed(done, 0)} parts`),
    h("h1", { id: "verdict" }, unbroken(campaign.title)), verdictTable(campaign)));
  campaign.parts.forEach((part, n) => {
    if (!part.done) return;
    const link = h("p", {}, h("a", { href: `${part.directory}/report.html` }, "Its own report"));
    main.append(section(`part-${n + 1}`, part.figures ? `${part.figures}: ${part.title}` : part.title, part.summary ?? "",
      ...contentOf(part, runs, players).filter((node): node is Node => node !== null), part.kind === "jet-sweep" ? "" : link));
  });
  return h("div", {}, h("a", { class: "skip", href: "#content" }, "Skip to the results"),
    h("nav", { "aria-label": "Sections" }, h("span", { class: "brand" }, "Ejecta"),
      ...campaign.parts.flatMap((p, n) => (p.done ? [h("a", { href: `#part-${n + 1}` }, p.figures || p.title)] : []))), main,
    h("footer", {}, "Ejecta \u00b7 one file, works offline; the reports of the parts lie beside it"));
}
