/** One run, study, map, sorter or campaign, as far as it is. */

import { paintSwatches } from "../colour";
import { h } from "../dom";
import { unbroken } from "../format";
import type { MapResult } from "../map_data";
import { facts as mapFacts } from "../map_page";
import { mapView } from "../map_view";
import type { SortResult, SortView } from "../sort_data";
import { facts as sortFacts } from "../sort_page";
import { sortView } from "../sort_view";
import { studyCharts, type StudyResult } from "../study_page";
import { api, fileOf, type Job } from "./api";
import { JobActions, progressOf } from "./job_parts";
import { LiveRun } from "./live_run";
import { renew } from "./renew";

/** Shows what there is of a job now; called again whenever it has changed. */
type Look = (job: Job) => Promise<void>;

const GONE = "It is no longer there.";

export class JobView {
  private readonly note = h("p", { class: "note", role: "status" });
  private readonly state = h("span", { class: "state" });
  private readonly progress = h("div", { class: "progress" });
  private readonly verdict = h("p", { class: "verdict-line" });
  private readonly said = h("pre", { hidden: true, tabindex: 0, "aria-label": "What it said" });
  private readonly buttons = h("div", { class: "actions" });
  private readonly content = h("div", { class: "job-content" });
  readonly element: HTMLElement;
  private readonly actions = new JobActions((words) => (this.note.textContent = words));
  private look: Look | null = null;
  private shown = "";

  constructor(readonly name: string, leave: () => void) {
    const back = h("button", { type: "button", class: "link" }, "\u2190 All runs");
    back.addEventListener("click", leave);
    this.element = h("section", { class: "job", "aria-labelledby": "job-name" }, back,
      h("header", { class: "bar" }, h("h1", { id: "job-name" }, name), this.state, this.progress, this.buttons),
      this.note, this.verdict, this.said, this.content);
  }

  show(job: Job | undefined): void {
    const text = JSON.stringify(job ?? null);
    if (text === this.shown) return;
    this.shown = text;
    if (!job) {
      this.note.textContent = GONE;
      this.buttons.replaceChildren();
      return;
    }
    if (this.note.textContent === GONE) this.note.textContent = "";
    this.element.className = `job ${job.state}`;
    this.state.textContent = job.state;
    this.progress.replaceChildren(progressOf(job));
    this.verdict.textContent = unbroken(job.verdict ?? "");
    this.said.hidden = !job.said;
    this.said.textContent = job.said ?? "";
    renew(this.buttons, ...this.actions.of(job));
    this.look ??= this.lookAt(job);
    this.look(job).then(paintSwatches).catch((error: Error) => (this.note.textContent = error.message));
  }

  private lookAt(job: Job): Look {
    switch (job.kind) {
      case "run": {
        const live = new LiveRun(job.name);
        this.content.replaceChildren(live.element);
        return ({ state }) => live.look(state === "done");
      }
      case "study":
        return async ({ name }) => renew(this.content, studyContent(await api.study<StudyResult>(name)));
      case "map":
        return async ({ name, verdict }) => {
          if (verdict) renew(this.content, mapContent(await api.json<MapResult>(name, "result.json"), name));
        };
      case "sort":
        return async ({ name, state }) => {
          if (state !== "done") return;
          const [result, view] = await Promise.all([api.json<SortResult>(name, "result.json"), api.json<SortView>(name, "view.json")]);
          renew(this.content, sortFacts(result), sortView({ ...result, view }));
        };
      case "campaign":
        return async ({ name, verdict }) => {
          if (verdict) renew(this.content, campaignContent(await api.json<Campaign>(name, "result.json"), name));
        };
    }
  }
}

function studyContent(study: StudyResult): HTMLElement {
  const charts = studyCharts(study);
  return charts.length > 0 ? h("div", { class: "chart-grid" }, ...charts) : h("p", { class: "note" }, "Curves come when two of its runs with numbers are done.");
}

function mapContent(map: MapResult, name: string): HTMLElement {
  // Its dots lead to the runs, which lie in its directory.
  const runs = map.runs.map((run) => ({ ...run, directory: fileOf(name, run.directory) }));
  const view = mapView({ ...map, runs });
  view.addEventListener("click", (event) => {
    const link = (event.target as Element).closest("a");
    if (!link) return;
    event.preventDefault();
    open(link.getAttribute("href")!, "_blank", "noopener");
  });
  return h("div", {}, mapFacts(map), view);
}

interface Campaign {
  parts: { kind: string; title: string; done: boolean; directory: string; problem?: string; summary?: string }[];
}

function campaignContent({ parts }: Campaign, name: string): HTMLElement {
  return h("div", { class: "table" }, h("table", {}, h("thead", {}, h("tr", {}, ...["Part", "Kind", "State", "Result"].map((t) => h("th", { scope: "col" }, t)))),
    h("tbody", {}, ...parts.map((part) => h("tr", {}, h("th", { scope: "row" }, part.done ? h("a", { href: fileOf(name, `${part.directory}/report.html`), target: "_blank", rel: "noopener" }, part.title) : part.title),
      h("td", {}, part.kind), h("td", {}, part.problem || (part.done ? "done" : "open")), h("td", {}, unbroken(part.summary ?? "")))))));
}
