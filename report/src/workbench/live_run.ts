/** A run while it goes: the jet with the bodies in it, and forces, from the files that it writes anyway. */

import { axisLabel, growingChart, type Series } from "../charts";
import { componentColour } from "../colour";
import { readFrame, readHeader, strongest, type RawFrame, type RawHeader, type Run } from "../data";
import { h } from "../dom";
import { fixed } from "../format";
import { Player } from "../player";
import { fastestAir, SliceView } from "../slice";
import { fileOf, GrowingFile } from "./api";

const SHOWN: [prefix: string, title: string, unit: string][] = [["force", "Force of the air", "N"], ["velocity", "Velocity", "m/s"]];
const COMPONENTS = ["x", "y", "z"];

export class LiveRun {
  readonly element = h("div", { class: "live" });
  private replay: GrowingFile;
  private history: LiveHistory | null = null;
  private readonly picture = h("div", {});
  private readonly charts = h("div", {});
  private run: Run | null = null;
  private player: Player | null = null;
  private slice: SliceView | null = null;
  private top = 0;
  private busy = false;

  constructor(private readonly name: string) {
    this.replay = new GrowingFile(fileOf(name, "replay.jsonl"));
    this.element.append(this.picture, this.charts);
  }

  /** Takes in what has come since. Who followed it to its end is shown the moment that decided: at the end itself the air
   * is no longer computed and the body has left. */
  async look(done: boolean): Promise<void> {
    if (this.busy) return; // the next look has it
    this.busy = true;
    try {
      const lines = await this.replay.more();
      if (!lines) this.begin(null); // it went back to a checkpoint
      else await this.take(lines);
      await this.history?.look(this.player);
      const push = done ? this.history?.strongestPush() : null;
      if (this.player && !this.player.playing && this.player.time >= this.player.end && push) this.player.seek(push);
    } finally {
      this.busy = false;
    }
  }

  private begin(header: RawHeader | null): void {
    this.run = header && { name: this.name, verdict: "", result: null, manifest: null, caseText: "", history: new Map(), replay: readHeader(header), figures: [], pictures: [] };
    this.player = this.slice = this.history = null;
    this.top = 0;
    this.picture.replaceChildren();
    this.charts.replaceChildren();
    if (header?.bodies.length) this.watchBody(header.bodies.map((b) => b.name));
  }

  private async take(lines: string[]): Promise<void> {
    if (!this.run && lines.length > 0) this.begin(JSON.parse(lines.shift()!) as RawHeader);
    const replay = this.run?.replay;
    if (!replay || lines.length === 0) return;
    const newest = !this.player || this.player.time >= this.player.end;
    replay.frames.push(...await Promise.all(lines.map((line) => readFrame(JSON.parse(line) as RawFrame))));
    const end = replay.frames.at(-1)!.time;
    if (!this.player) this.show(new Player(replay.frames[0]!.time, end));
    const player = this.player!;
    player.end = end;
    if (this.slice && fastestAir(this.run!) > this.top) this.select(0);
    player.seek(newest && !player.playing ? end : player.time);
  }

  private select(raster: number): void {
    const chosen = this.picture.querySelector("select");
    this.top = fastestAir(this.run!);
    this.slice!.select(this.run!, chosen ? Number(chosen.value) : raster);
  }

  private show(player: Player): void {
    this.player = player;
    const rasters = this.run!.replay!.rasters;
    if (rasters.length === 0) return; // no air is computed
    this.slice = new SliceView([this.run!], player);
    const views = h("select", { "aria-label": "Seen from" }, ...rasters.map((r, n) => h("option", { value: n }, r.name)));
    views.addEventListener("change", () => this.select(Number(views.value)));
    const slider = h("input", { type: "range", min: 0, max: 1000, step: 1, "aria-label": "Time" });
    const clock = h("output", { class: "clock" });
    const play = h("button", { type: "button", class: "play" }, "Play");
    slider.addEventListener("input", () => player.seek(player.start + (Number(slider.value) / 1000) * (player.end - player.start)));
    play.addEventListener("click", () => {
      player.toggle();
      play.classList.toggle("playing", player.playing);
    });
    player.onChange(() => {
      slider.value = String(Math.round((1000 * (player.time - player.start)) / Math.max(player.end - player.start, 1e-12)));
      clock.textContent = `${fixed(player.time * 1e3, 2)} ms`;
      play.textContent = player.playing ? "Pause" : "Play";
      play.classList.toggle("playing", player.playing);
    });
    this.picture.replaceChildren(h("div", { class: "panel" }, h("div", { class: "panel-head" }, h("h2", {}, "Air and bodies"), this.slice.legend, rasters.length > 1 ? views : null), this.slice.canvas),
      h("div", { class: "controls" }, play, h("div", { class: "timeline" }, slider), clock));
    this.select(0);
  }

  private watchBody(names: string[]): void {
    const watch = (name: string): void => {
      this.history = new LiveHistory(this.name, name);
      holder.replaceChildren(this.history.element);
      void this.history.look(this.player);
    };
    const holder = h("div", {});
    const chooser = h("select", {}, ...names.map((name) => h("option", { value: name }, name)));
    chooser.addEventListener("change", () => watch(chooser.value));
    this.charts.replaceChildren(...(names.length > 1 ? [h("label", { class: "body-chooser" }, "Body ", chooser)] : []), holder);
    watch(names[0]!);
  }
}

/** What moves a body, from history/body-NAME.csv. */
class LiveHistory {
  readonly element = h("div", { class: "chart-grid" });
  private readonly file: GrowingFile;
  private columns: string[] = [];
  private readonly time: number[] = [];
  private readonly values = new Map<string, number[]>();
  private grown: (() => void)[] | null = null;
  private looks: Promise<void> = Promise.resolve();

  constructor(job: string, private readonly body: string) {
    this.file = new GrowingFile(fileOf(job, `history/body-${body}.csv`));
  }

  /** One look after the other: each takes what the last one left. */
  look(player: Player | null): Promise<void> {
    return (this.looks = this.looks.then(() => this.take(player)));
  }

  /** When the air pushed hardest, s; null where none did. */
  strongestPush(): number | null {
    const { at } = strongest(COMPONENTS.map((component) => this.values.get(`force_${component}`) ?? []));
    return at < 0 ? null : this.time[at]! / 1e3;
  }

  private async take(player: Player | null): Promise<void> {
    const lines = await this.file.more();
    if (!lines) {
      this.columns = [];
      this.time.length = 0;
      for (const list of this.values.values()) list.length = 0;
      return;
    }
    for (const line of lines) {
      if (line.startsWith("#")) continue;
      const cells = line.split(",");
      if (this.columns.length === 0) {
        this.columns = cells.map((cell) => cell.split(" ")[0]!);
        for (const column of this.columns) if (!this.values.has(column)) this.values.set(column, []);
        continue;
      }
      this.time.push(Number(cells[0]) * 1e3);
      this.columns.forEach((column, n) => this.values.get(column)!.push(Number(cells[n])));
    }
    if (this.grown) this.grown.forEach((grown) => grown());
    else if (player && this.time.length > 1) this.build(player);
  }

  private build(player: Player): void {
    this.grown = [];
    for (const [prefix, title, unit] of SHOWN) {
      const series = COMPONENTS.flatMap((component, c): Series[] => {
        const values = this.values.get(`${prefix}_${component}`);
        return values ? [{ label: component, values, colour: (dark) => componentColour(c, dark) }] : [];
      });
      if (series.length === 0) continue;
      const { figure, grown } = growingChart({ title: `${title}: ${this.body}`, xLabel: "time [ms]", yLabel: axisLabel(prefix, unit), x: this.time, series, player });
      this.grown.push(grown);
      this.element.append(figure);
    }
  }
}
