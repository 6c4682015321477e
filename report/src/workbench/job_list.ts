/** The list of runs, studies, maps and sorters, as they go. */

import { h } from "../dom";
import { unbroken } from "../format";
import { api, type FolderState, type Job } from "./api";
import { JobActions, isBusy, progressOf } from "./job_parts";
import { keepingFocus, renew } from "./renew";

const RANK: Record<Job["state"], number> = { running: 0, starting: 0, waiting: 1, failed: 2, diverged: 2, stopped: 2, done: 2 };
const EMPTY = "Nothing has been started yet: open a case and start it.";
const BARE = "There is no case in this folder yet. Make one with \u201cNew case\u201d, give it your rock with \u201cShape from a file\u201d, and start it.";

export class JobListView {
  private readonly body = h("tbody", {});
  private readonly chosen = new Set<string>();
  private readonly together = [["Compare", "compare.html", 2], ["CSV", "results.csv", 1], ["Excel", "results.xlsx", 1]].map(([words, file, least]) => {
    const b = h("button", { type: "button", disabled: true, "data-least": least }, String(words));
    b.addEventListener("click", () => open(`/runs/${file}?${[...this.chosen].map((name) => `run=${encodeURIComponent(name)}`).join("&")}`, "_blank", "noopener"));
    return b;
  });
  private readonly note = h("p", { class: "note", role: "status" });
  private readonly atOnce = h("input", { type: "number", id: "at-once", min: 1, max: 64, value: 1 });
  private readonly filter = h("input", { type: "search", id: "filter", placeholder: "part of a name", autocomplete: "off" });
  private readonly table = h("div", { class: "table", role: "region", "aria-label": "Table of runs", tabindex: 0, hidden: true }, h("table", {},
    h("thead", {}, h("tr", {}, ...["Name", "State", "Progress", "Result", ""].map((name) => h("th", { scope: "col" }, name || h("span", { class: "unseen" }, "Actions"))))),
    this.body));
  readonly element = h("section", { class: "jobs", "aria-labelledby": "jobs-name" },
    h("header", { class: "bar" }, h("h1", { id: "jobs-name" }, "Runs"),
      h("span", { class: "pair" }, h("label", { for: "filter" }, "Show"), this.filter),
      h("span", { class: "pair" }, h("label", { for: "at-once" }, "Side by side"), this.atOnce), ...this.together),
    this.note, this.table);
  private readonly rows = new Map<string, { row: HTMLTableRowElement; shown: string }>();
  private readonly actions = new JobActions((words) => (this.note.textContent = words));

  constructor(private readonly openJob: (name: string) => void) {
    this.atOnce.addEventListener("change", () => {
      api.atOnce(Number(this.atOnce.value)).then(() => (this.note.textContent = ""), (error: Error) => (this.note.textContent = error.message));
    });
    this.filter.addEventListener("input", () => this.sift());
  }

  show({ jobs, cases, at_once }: FolderState): void {
    if (document.activeElement !== this.atOnce) this.atOnce.value = String(at_once);
    const ordered = [...jobs].sort((a, b) => RANK[a.state] - RANK[b.state] || (a.before ?? 0) - (b.before ?? 0) || (a.name < b.name ? -1 : 1));
    const known = new Set(jobs.map((job) => job.name));
    for (const name of this.chosen) if (!known.has(name)) this.chosen.delete(name);
    this.offer();
    const rows = ordered.map((job) => this.row(job));
    keepingFocus(this.body, () => {
      for (const [name, { row }] of this.rows)
        if (!known.has(name)) {
          row.remove();
          this.rows.delete(name);
        }
      let next = this.body.firstElementChild;
      for (const row of rows) {
        if (row === next) next = row.nextElementSibling;
        else this.body.insertBefore(row, next);
      }
      this.sift();
    });
    if (jobs.length === 0) this.note.textContent = cases.length > 0 ? EMPTY : BARE;
    else if ([EMPTY, BARE].includes(this.note.textContent!)) this.note.textContent = "";
    this.table.hidden = jobs.length === 0;
  }

  private sift(): void {
    const part = this.filter.value.trim().toLowerCase();
    for (const [name, { row }] of this.rows) row.hidden = !name.toLowerCase().includes(part);
  }

  /** That of a job, as it is now. */
  private row(job: Job): HTMLTableRowElement {
    const shown = JSON.stringify(job);
    const entry = this.rows.get(job.name) ?? { row: h("tr", { "data-job": job.name }), shown: "" };
    if (entry.shown === shown) return entry.row;
    entry.shown = shown;
    entry.row.className = job.state;
    renew(entry.row, ...this.cells(job));
    this.rows.set(job.name, entry);
    return entry.row;
  }

  private cells(job: Job): HTMLElement[] {
    const name = h("button", { type: "button", class: "link", "aria-label": `Look at ${job.name}` }, job.name);
    name.addEventListener("click", () => this.openJob(job.name));
    return [
      h("th", { scope: "row" }, h("div", { class: "name" }, job.kind === "run" && job.state === "done" ? this.choice(job.name) : null,
        h("div", {}, name, job.title ? h("span", { class: "title" }, job.title) : null))),
      h("td", { class: "state" }, job.state),
      h("td", { class: "progress" }, progressOf(job)),
      h("td", { class: "result" }, job.verdict ? unbroken(job.verdict) : job.said ? said(job) : ""),
      h("td", { class: "actions" }, ...this.actions.of(job)),
    ];
  }

  private choice(name: string): HTMLElement {
    const box = h("input", { type: "checkbox", "aria-label": `Choose ${name}`, checked: this.chosen.has(name) });
    box.addEventListener("change", () => {
      if (box.checked) this.chosen.add(name);
      else this.chosen.delete(name);
      this.offer();
    });
    return box;
  }

  private offer(): void {
    for (const b of this.together) b.disabled = this.chosen.size < Number(b.dataset["least"]);
  }
}

function said(job: Job): HTMLElement {
  return h("details", {}, h("summary", {}, isBusy(job) ? "what it says" : "what it said"),
    h("pre", { tabindex: 0, "aria-label": `What ${job.name} said` }, job.said!));
}
