/** The list of runs, as they go. */

import { h } from "../dom";
import { duration, unbroken } from "../format";
import { api, type RunState } from "./api";

const WORDS: Record<RunState["state"], string> = {
  starting: "starting", running: "running", done: "done", stopped: "stopped", diverged: "diverged", failed: "failed",
};

export class RunView {
  private readonly body = h("tbody", {});
  private readonly chosen = new Set<string>();
  private readonly together = [["Compare", "compare.html", 2], ["CSV", "results.csv", 1], ["Excel", "results.xlsx", 1]].map(([words, file, least]) => {
    const b = h("button", { type: "button", disabled: true, "data-least": least }, String(words));
    b.addEventListener("click", () => open(`/runs/${file}?${[...this.chosen].map((name) => `run=${encodeURIComponent(name)}`).join("&")}`, "_blank", "noopener"));
    return b;
  });
  private readonly note = h("p", { class: "note", role: "status" });
  readonly element = h("section", { class: "runs", "aria-labelledby": "runs-name" },
    h("header", { class: "bar" }, h("h1", { id: "runs-name" }, "Runs"), ...this.together), this.note,
    h("div", { class: "table" }, h("table", {},
      h("thead", {}, h("tr", {}, ...["Run", "State", "Progress", "Verdict", ""].map((name) => h("th", { scope: "col" }, name || h("span", { class: "unseen" }, "Actions"))))),
      this.body)));
  private readonly rows = new Map<string, { row: HTMLTableRowElement; shown: string }>();

  show(runs: RunState[]): void {
    const busy = (run: RunState): number => (run.state === "running" || run.state === "starting" ? 0 : 1);
    const ordered = [...runs].sort((a, b) => busy(a) - busy(b));
    const known = new Set(runs.map((run) => run.name));
    for (const name of this.chosen) if (!known.has(name)) this.chosen.delete(name);
    for (const [name, { row }] of this.rows)
      if (!known.has(name)) {
        row.remove();
        this.rows.delete(name);
      }
    ordered.forEach((run, n) => {
      const shown = JSON.stringify(run);
      let entry = this.rows.get(run.name);
      if (!entry || entry.shown !== shown) {
        const row = this.row(run);
        const focused = entry?.row.contains(document.activeElement) ? document.activeElement?.textContent : null;
        entry?.row.replaceWith(row);
        this.rows.set(run.name, (entry = { row, shown }));
        if (focused) [...row.querySelectorAll("button")].find((b) => b.textContent === focused)?.focus();
      }
      if (this.body.children[n] !== entry.row) this.body.insertBefore(entry.row, this.body.children[n] ?? null);
    });
    if (runs.length === 0) this.note.textContent = "No runs yet: open a case and start it.";
    else if (this.note.textContent?.startsWith("No runs")) this.note.textContent = "";
  }

  private row(run: RunState): HTMLTableRowElement {
    return h("tr", { "data-run": run.name, class: run.state },
      h("th", { scope: "row" }, run.state === "done" ? this.choice(run.name) : null, run.name, run.title ? h("span", { class: "title" }, run.title) : null),
      h("td", { class: "state" }, WORDS[run.state]),
      h("td", {}, this.progress(run)),
      h("td", {}, run.verdict ? unbroken(run.verdict) : run.said ? h("details", {}, h("summary", {}, "what it said"), h("pre", { tabindex: 0 }, run.said)) : ""),
      h("td", { class: "actions" }, ...this.actions(run)));
  }

  private choice(name: string): HTMLElement {
    const box = h("input", { type: "checkbox", "aria-label": `Choose ${name}`, checked: this.chosen.has(name) });
    box.addEventListener("change", () => {
      if (box.checked) this.chosen.add(name);
      else this.chosen.delete(name);
      for (const b of this.together) b.disabled = this.chosen.size < Number(b.dataset["least"]);
    });
    return box;
  }

  private progress(run: RunState): HTMLElement | string {
    if (run.state === "done") return run.wall_time_s ? `took ${duration(run.wall_time_s)}` : "";
    if (run.fraction === undefined) return "";
    const left = run.state === "running" && run.eta_s ? `, ${duration(Math.ceil(run.eta_s))} left` : "";
    return h("div", {}, h("progress", { max: 1, value: run.fraction, "aria-label": `Progress of ${run.name}` }),
      h("span", { class: "left" }, `${Math.round(100 * run.fraction)} %${left}`));
  }

  private actions(run: RunState): HTMLElement[] {
    const button = (words: string, act: () => Promise<unknown>): HTMLElement => {
      const b = h("button", { type: "button", "aria-label": `${words} ${run.name}` }, words);
      b.addEventListener("click", () => {
        b.disabled = true;
        act().then(() => (this.note.textContent = ""), (error: Error) => {
          this.note.textContent = error.message;
          b.disabled = false;
        });
      });
      return b;
    };
    const file = (name: string): string => `/files/${[...run.name.split("/"), name].map(encodeURIComponent).join("/")}`;
    const list: HTMLElement[] = [];
    if (run.state === "running" || run.state === "starting")
      list.push(button("Stop", async () => {
        if (!confirm(`Stop ${run.name}? It keeps a checkpoint and can go on later.`)) throw new Error("");
        await api.stop(run.name);
      }));
    if (run.state === "stopped" || (run.state === "failed" && run.fraction !== undefined)) list.push(button("Resume", () => api.resume(run.name)));
    if (run.report) list.push(h("a", { href: file("report.html"), target: "_blank", rel: "noopener" }, "Report"));
    if (run.state === "done") list.push(h("a", { href: file("result.json"), target: "_blank", rel: "noopener" }, "Numbers"));
    return list;
  }
}
