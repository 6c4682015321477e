/** What the list and the page of a job share. */

import { h } from "../dom";
import { duration } from "../format";
import { api, fileOf, type Job } from "./api";

export const isBusy = (job: Job): boolean => job.state === "running" || job.state === "starting";

export function progressOf(job: Job): HTMLElement | string {
  if (job.state === "waiting") return job.before ? `after ${job.before} other${job.before > 1 ? "s" : ""}` : "is next";
  if (job.state === "done") return job.wall_time_s ? `took ${duration(job.wall_time_s)}` : job.progress ?? "";
  const left = isBusy(job) && job.eta_s ? `${duration(Math.ceil(job.eta_s))} left` : "";
  if (job.fraction === undefined) return job.progress ?? "";
  const words = job.progress ?? [`${Math.round(100 * job.fraction)} %`, left].filter(Boolean).join(", ");
  return h("div", {}, h("progress", { max: 1, value: job.fraction, "aria-label": `Progress of ${job.name}` }), h("span", { class: "left" }, words));
}

export class JobActions {
  constructor(private readonly say: (words: string) => void) {}

  of(job: Job): HTMLElement[] {
    const list: HTMLElement[] = [];
    if (job.state === "waiting") list.push(this.button(job, "Cancel", () => api.stop(job.name)));
    if (isBusy(job))
      list.push(this.button(job, "Stop", () => (confirm(`Stop ${job.name}? It keeps what it has and can go on later.`) ? api.stop(job.name) : null)));
    if (job.state === "stopped" || (job.state === "failed" && (job.fraction !== undefined || job.progress !== undefined)))
      list.push(this.button(job, "Resume", () => api.resume(job.name)));
    const link = (file: string, words: string): HTMLElement => h("a", { href: fileOf(job.name, file), target: "_blank", rel: "noopener", "aria-label": `${words} of ${job.name}` }, words);
    if (job.report) list.push(link("report.html", "Report"));
    if (job.state === "done") list.push(link("result.json", "Numbers"));
    if (job.state !== "waiting" && !isBusy(job))
      list.push(this.button(job, "Remove", () => (confirm(`Remove ${job.name}? It goes into the folder .removed beside it.`) ? api.remove(job.name) : null)));
    return list;
  }

  /** `act` gives nothing where somebody thought better of it. A button that waits for its answer keeps the focus, which one
   * that is disabled loses. */
  private button(job: Job, words: string, act: () => Promise<unknown> | null): HTMLElement {
    const b = h("button", { type: "button", "aria-label": `${words} ${job.name}` }, words);
    b.addEventListener("click", () => {
      if (b.ariaDisabled) return;
      const done = act();
      if (!done) return;
      b.ariaDisabled = "true";
      done.then(() => this.say(""), (error: Error) => {
        this.say(error.message);
        b.ariaDisabled = null;
      });
    });
    return b;
  }
}
