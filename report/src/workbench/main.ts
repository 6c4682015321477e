import "../style.css";
import "./workbench.css";
import { h } from "../dom";
import { api, watchRuns } from "./api";
import { CaseView } from "./case_view";
import { RunView } from "./run_view";

function followTheme(): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const follow = (): void => void (document.documentElement.dataset["theme"] = dark.matches ? "dark" : "light");
  dark.addEventListener("change", follow);
  follow();
}

async function start(): Promise<void> {
  const app = document.getElementById("app")!;
  const [schema, { folder, cases }] = await Promise.all([api.schema(), api.cases()]);
  const runs = new RunView();
  const main = h("main", { id: "content" });
  const list = h("ul", {});
  const note = h("p", { class: "note", role: "status" });
  const lost = h("p", { class: "lost", role: "alert", hidden: true }, "The server does not answer. Runs go on; this page finds them again when it is back.");
  let view: CaseView | null = null;

  const leave = (): boolean => !view?.changed || confirm(`${view.name} is not saved. Leave it?`);
  const showRuns = (): void => {
    main.replaceChildren(runs.element);
    mark("");
  };
  const showCase = async (name: string): Promise<void> => {
    view = new CaseView(name, schema, (run) => {
      showRuns();
      document.querySelector(`[data-run="${CSS.escape(run)}"]`)?.scrollIntoView();
    });
    main.replaceChildren(view.element);
    mark(name);
    await view.open();
  };
  const mark = (name: string): void => {
    for (const b of document.querySelectorAll<HTMLElement>("[data-case]"))
      if (b.dataset["case"] === name) b.setAttribute("aria-current", "page");
      else b.removeAttribute("aria-current");
  };
  const entry = (name: string, words: string, act: () => void): HTMLElement => {
    const b = h("button", { type: "button", "data-case": name }, words);
    b.addEventListener("click", act);
    return b;
  };
  const add = (name: string): void => {
    list.append(h("li", {}, entry(name, name, () => {
      if (leave()) showCase(name).catch((error: Error) => (note.textContent = error.message));
    })));
  };
  cases.forEach(add);

  const newName = h("input", { type: "text", id: "new-name", placeholder: "my-rock.toml", autocomplete: "off", "aria-label": "Name of a new case" });
  const create = h("form", { class: "new" }, newName, h("button", { type: "submit" }, "New case"));
  create.addEventListener("submit", (event) => {
    event.preventDefault();
    const typed = newName.value.trim() || newName.placeholder;
    const name = typed.endsWith(".toml") ? typed : `${typed}.toml`;
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
    api.upload(file).then(({ name }) => target.useShape(name)).catch((error: Error) => (note.textContent = error.message));
  });

  app.replaceChildren(
    h("a", { class: "skip", href: "#content" }, "Skip to the content"),
    h("div", { class: "desk" },
      h("nav", { class: "side", "aria-label": "Cases and runs" }, h("span", { class: "brand" }, "Ejecta"), h("p", { class: "folder", title: folder }, folder.split("/").at(-1)!),
        entry("", "Runs", () => leave() && showRuns()), h("h2", {}, "Cases"), list, create, note),
      h("div", { class: "content" }, lost, main)));
  watchRuns((states) => runs.show(states), (yes) => (lost.hidden = yes));
  runs.show(await api.runs());
  showRuns();
  document.documentElement.dataset["ready"] = "true";
}

followTheme();
start().catch((error: unknown) => {
  document.getElementById("app")!.replaceChildren(h("main", {}, h("h1", {}, "The workbench cannot be shown"), h("p", {}, String(error))));
});
