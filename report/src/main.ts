import "./style.css";
import { paintSwatches } from "./colour";
import { campaignPage, readCampaign } from "./campaign_page";
import { readRuns, strongest, type JsonObject, type Run } from "./data";
import { h, section } from "./dom";
import { figureCharts, pictureViews } from "./figures";
import { fixed, unbroken } from "./format";
import { differenceTable, inputTable } from "./inputs";
import { readMap } from "./map_data";
import { mapPage } from "./map_page";
import { motionCharts, seriesCharts, valveChart } from "./motion_charts";
import { pathNote, pathView } from "./path";
import { Player } from "./player";
import { profileCharts } from "./profile_charts";
import { replayView } from "./replay_view";
import { readSort } from "./sort_data";
import { sortPage } from "./sort_page";
import { readStudy, studyPage } from "./study_page";
import {
  assumptionList, bodyCards, costTable, expectationTable, ledgerTable, operatorTable, provenanceTable, resultTable,
} from "./tables";

/** Light or dark as the system asks; paper is always light. */
function followTheme(): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const set = (theme: string): void => {
    if (document.documentElement.dataset["theme"] === theme) return;
    document.documentElement.dataset["theme"] = theme;
    paintSwatches();
    document.dispatchEvent(new Event("themechange"));
  };
  const follow = (): void => set(dark.matches ? "dark" : "light");
  dark.addEventListener("change", follow);
  addEventListener("beforeprint", () => set("light"));
  addEventListener("afterprint", follow);
  follow();
}

/** From the first to the last moment of any run; starts where the air pushes hardest on a body, or blows fastest, or
 * without air at the end. */
function makePlayer(runs: Run[]): Player {
  const times = runs.flatMap((run) => [
    ...(run.replay?.frames.map((f) => f.time) ?? []), ...[...run.history.values()].flatMap((t) => [t.values[0]![0] ?? 0, t.values[0]!.at(-1) ?? 0])]);
  const player = new Player(times.length ? Math.min(...times) : 0, times.length ? Math.max(...times) : 1);
  player.time = player.end;
  let fastest = 0;
  for (const frame of runs[0]?.replay?.frames ?? [])
    for (const slice of frame.slices.values())
      if (slice.fullScale > fastest) {
        fastest = slice.fullScale;
        player.time = frame.time;
      }
  let hardest = 0;
  for (const [name, table] of runs[0]?.history ?? []) {
    if (!name.startsWith("body-")) continue;
    const push = strongest(table.columns.flatMap((c, n) => (/^force_[xyz]$/.test(c.name) ? [table.values[n]!] : [])));
    if (push.size <= hardest) continue;
    hardest = push.size;
    player.time = table.values[0]![push.at]!;
  }
  return player;
}

function titleOf(runs: Run[]): string {
  return runs.map((run) => String(run.result?.["title"] || run.name)).filter((t, n, all) => all.indexOf(t) === n).join(" \u00b7 ");
}

/** What `--set` changed in the case of a run. */
function changes(run: Run): HTMLElement | null {
  const set = run.manifest?.["set"];
  if (!Array.isArray(set) || set.length === 0) return null;
  return h("p", { class: "changes" }, "changed: ", ...set.flatMap((one, n) => [n > 0 ? ", " : "", h("code", {}, String(one))]));
}

/** Where the dividing plate is, and by what it was given. */
function plateNote(run: Run): HTMLElement | null {
  const plate = run.result?.["plate"] as JsonObject | undefined;
  const edge = plate?.["edge_from_nozzle_m"];
  if (!Array.isArray(edge)) return null;
  const [x, z] = edge.map((v) => fixed(Number(v) * 1e3, 1));
  const height = plate!["height_above_path_m"];
  const how = typeof height === "number"
    ? `${fixed(height * 1e3, 1)} mm above the undisturbed path there, with which it moves`
    : String(plate!["given_as"]);
  return h("p", { class: "plate" }, `Plate: edge at x, z = ${x}, ${z} mm from the nozzle, ${how}.`);
}

/** What the run itself doubts. */
function warnings(run: Run): HTMLElement | null {
  const list = run.result?.["warnings"];
  if (!Array.isArray(list) || list.length === 0) return null;
  return h("ul", { class: "warnings", "aria-label": `Warnings of ${run.name}` },
    ...list.map((one) => h("li", {}, h("strong", {}, "Warning: "), unbroken(String(one)))));
}

function verdict(runs: Run[]): HTMLElement {
  const head = h("header", { class: "verdict" }, h("p", { class: "title" }, titleOf(runs)));
  if (runs.length === 1) head.append(h("h1", { id: "verdict" }, unbroken(runs[0]!.verdict)));
  else head.append(h("h1", {}, `${runs.length} runs compared`),
    h("ul", { class: "verdicts" }, ...runs.map((run, r) => h("li", {},
      h("span", { class: r > 0 ? "swatch dashed ink" : "swatch ink" }), h("strong", {}, `${run.name}: `), unbroken(run.verdict), changes(run), warnings(run)))));
  if (runs.length === 1) for (const note of [warnings(runs[0]!), changes(runs[0]!), plateNote(runs[0]!)]) if (note) head.append(note);
  for (const part of [differenceTable(runs), bodyCards(runs)]) if (part) head.append(part);
  return head;
}

function caseFile(run: Run): HTMLElement {
  const copy = h("button", { type: "button", class: "copy" }, "Copy");
  copy.addEventListener("click", () => {
    void navigator.clipboard.writeText(run.caseText).then(() => (copy.textContent = "Copied"));
  });
  return h("details", {}, h("summary", {}, `Case file of ${run.name}, as resolved`), copy,
    h("pre", { tabindex: 0, "aria-label": `Case file of ${run.name}` }, h("code", {}, run.caseText)));
}

function page(runs: Run[]): HTMLElement {
  const player = makePlayer(runs);
  const main = h("main", { id: "content" }, verdict(runs));
  const add = (id: string, title: string, note: string, ...content: (Node | null)[]): void => {
    if (content.some(Boolean)) main.append(section(id, title, note, ...content));
  };
  const grid = (charts: HTMLElement[]): HTMLElement | null =>
    charts.length > 0 ? h("div", { class: "chart-grid" }, ...charts) : null;

  add("path", "Path", pathNote(runs), pathView(runs, player));
  add("replay", "Replay", "", replayView(runs, player));
  add("inputs", "Inputs", "What the case sets; the rest is under Assumptions and in the case file.", grid([valveChart(runs, player)].filter((c) => c !== null)),
    ...(runs.length === 1 ? runs.map(inputTable) : []));
  add("motion", "Motion", "x along the belt, y across it, z up and along the jet.", motionCharts(runs, player));
  add("jet", "Jet", "", ...pictureViews(runs), grid([...figureCharts(runs), ...profileCharts(runs), ...seriesCharts(runs, player, (n) => n.startsWith("probe-"))]));
  add("expected", "Expected values", "", ...runs.map(expectationTable));
  add("books", "Books and cost", "What goes in minus what comes out, relative to what went through; and where the time went.",
    runs.some((run) => run.result) ? h("div", { class: runs.length > 1 ? "" : "columns" }, costTable(runs), ledgerTable(runs)) : null, ...runs.map(operatorTable),
    grid(seriesCharts(runs, player, (n) => !/^(body|line|probe)-/.test(n))));
  add("assumptions", "Assumptions", "Taken for granted by this run; each can be changed in the case file.", ...runs.map(assumptionList));
  add("provenance", "Provenance", "", provenanceTable(runs), ...runs.filter((run) => run.caseText).map(caseFile),
    ...runs.map((run, r) => run.result && h("details", {}, h("summary", {}, `All of result.json of ${run.name}`), resultTable(run, r))));

  const links = [...main.querySelectorAll("section")].map((s) =>
    h("a", { href: `#${s.id}` }, s.querySelector("h2")!.textContent));
  return h("div", {},
    h("a", { class: "skip", href: "#content" }, "Skip to the verdict"),
    h("nav", { "aria-label": "Sections" }, h("span", { class: "brand" }, "Ejecta"), ...links),
    main,
    h("footer", {}, `Ejecta ${String(runs[0]?.manifest?.["version"] ?? "")} \u00b7 one file, works offline`));
}

async function content(): Promise<[title: string, page: HTMLElement]> {
  const map = readMap();
  if (map) return [map.title, mapPage(map)];
  const sort = readSort();
  if (sort) return [sort.title, sortPage(sort)];
  const study = readStudy();
  if (study) return [study.title, studyPage(study)];
  const runs = await readRuns();
  const campaign = readCampaign();
  if (campaign) return [campaign.title, campaignPage(campaign, runs, (run) => makePlayer([run]))];
  return [titleOf(runs), page(runs)];
}

content().then(([title, shown]) => {
  document.title = `${title} \u2013 Ejecta report`;
  document.getElementById("app")!.replaceChildren(shown);
  followTheme();
  document.documentElement.dataset["ready"] = "true";
}).catch((error: unknown) => {
  document.getElementById("app")!.replaceChildren(
    h("main", {}, h("h1", {}, "This report cannot be shown"), h("p", {}, String(error))));
  throw error;
});
