import "../style.css";
import "./workbench.css";
import { paintSwatches } from "../colour";
import { h } from "../dom";
import { api, fileName, watchFolder, type FolderState } from "./api";
import { CaseView } from "./case_view";
import { JobListView } from "./job_list";
import { JobView } from "./job_view";
import { renew } from "./renew";

function followTheme(): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const follow = (): void => {
    document.documentElement.dataset["theme"] = dark.matches ? "dark" : "light";
    paintSwatches();
    document.dispatchEvent(new Event("themechange"));
  };
  dark.addEventListener("change", follow);
  follow();
}

async function start(): Promise<void> {
  const app = document.getElementById("app")!;
  // It is large, and the list of runs needs none of it. What did not come, as the server had gone, is asked for again.
  let asked: ReturnType<typeof api.schema> | null = null;
  const schema = (): ReturnType<typeof api.schema> => (asked ??= api.schema().catch((error: Error) => {
    asked = null;
    throw error;
  }));
  schema().catch(() => undefined);
  const main = h("main", { id: "content" });
  const list = h("ul", {});
  const note = h("p", { class: "note", role: "status" });
  const folder = h("p", { class: "folder" });
  const lost = h("p", { class: "lost", role: "alert", hidden: true }, "The server does not answer. Runs go on; this page finds them again when it is back.");
  const trouble = h("p", { class: "lost", role: "alert", hidden: true });
  let view: CaseView | null = null;
  let job: JobView | null = null;
  let state: FolderState = { folder: "", jobs: [], cases: [], at_once: 1, trouble: "" };

  const mark = (name: string): void => {
    for (const b of document.querySelectorAll<HTMLElement>("[data-case]"))
      if (b.dataset["case"] === name) b.setAttribute("aria-current", "page");
      else b.removeAttribute("aria-current");
  };
  const leave = (): boolean => !view?.changed || confirm(`${view.name} is not saved. Leave it?`);
  const swap = (element: HTMLElement, name: string): void => {
    view = job = null;
    const focused = main.contains(document.activeElement);
    main.replaceChildren(element);
    mark(name);
    if (!focused) return;
    const title = element.querySelector("h1")!; // where who works by the keyboard goes on
    title.tabIndex = -1;
    title.focus({ preventScroll: true });
  };
  const showJob = (name: string): void => {
    const shown = new JobView(name, showJobs);
    swap(shown.element, "");
    job = shown;
    update(state);
  };
  const jobs = new JobListView(showJob);
  const showJobs = (): void => swap(jobs.element, "");
  const showCase = async (name: string): Promise<void> => {
    const shown = new CaseView(name, await schema(), showJob, (copy) => {
      add(copy);
      void showCase(copy);
    });
    swap(shown.element, name);
    view = shown;
    await shown.open();
  };
  const entry = (name: string, words: string, act: () => void): HTMLElement => {
    const b = h("button", { type: "button", "data-case": name }, words);
    b.addEventListener("click", act);
    return b;
  };
  const showCases = (names: string[]): void => {
    renew(list, ...names.map((name) => h("li", {}, entry(name, name, () => {
      if (leave()) showCase(name).catch((error: Error) => (note.textContent = error.message));
    }))));
    mark(view?.name ?? "");
  };
  const add = (name: string): void => showCases((state.cases = [...new Set([...state.cases, name])].sort()));
  const update = (now: FolderState): void => {
    if (now.cases !== state.cases && now.cases.join("\n") !== [...list.querySelectorAll("[data-case]")].map((b) => b.getAttribute("data-case")).join("\n")) showCases(now.cases);
    state = now;
    folder.title = now.folder;
    folder.textContent = now.folder.split("/").at(-1)!;
    trouble.hidden = !now.trouble;
    trouble.textContent = now.trouble;
    jobs.show(now);
    job?.show(now.jobs.find((one) => one.name === job!.name));
  };
  const newName = h("input", { type: "text", id: "new-name", placeholder: "my-rock.toml", autocomplete: "off", "aria-label": "Name of a new case" });
  const create = h("form", { class: "new" }, newName, h("button", { type: "submit" }, "New case"));
  create.addEventListener("submit", (event) => {
    event.preventDefault();
    const name = fileName(newName.value.trim() || newName.placeholder, ".toml");
    api.create(name).then(() => {
      note.textContent = "";
      newName.value = "";
      add(name);
      return showCase(name);
    }).catch((error: Error) => (note.textContent = error.message));
  });

  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    const target = view;
    if (!file || !target?.element.isConnected) return;
    void target.useShape(file);
  });

  app.replaceChildren(
    h("a", { class: "skip", href: "#content" }, "Skip to the content"),
    h("div", { class: "desk" },
      h("nav", { class: "side", "aria-label": "Cases and runs" }, h("span", { class: "brand" }, "Ejecta"), folder,
        entry("", "Runs", () => leave() && showJobs()), h("h2", {}, "Cases"), list, create, note),
      h("div", { class: "content" }, lost, trouble, main)));
  showJobs();
  const first = new Promise<void>((resolve) => watchFolder((now) => {
    update(now);
    resolve();
  }, (yes) => (lost.hidden = yes)));
  await first;
  document.documentElement.dataset["ready"] = "true";
}

followTheme();
start().catch((error: unknown) => {
  document.getElementById("app")!.replaceChildren(h("main", {}, h("h1", {}, "The workbench cannot be shown"), h("p", {}, String(error))));
});
