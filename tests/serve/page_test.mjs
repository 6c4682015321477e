// The workbench in a real browser: from the form to the verdict, wrong entries, reload, a server that dies, stop, a
// shape from a file, a queue, a study, a live picture, keyboard alone; axe-core finds nothing against any view.
// node page_test.mjs NODE_MODULES_OF_REPORT SCREENSHOTS PROGRAM SOURCE SCRATCH; ends with 77 (skipped) without a browser.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { cpSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { createInterface } from "node:readline";

const [modules, screenshots, program, source, scratch] = process.argv.slice(2);
const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};
const browserPath = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);
if (!browserPath) skip("no chromium");
if (!existsSync(path.join(modules, "playwright-core"))) skip("no playwright-core: the page was not built");
const require = createRequire(path.join(modules, "x.js"));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
mkdirSync(screenshots, { recursive: true });
const small = readFileSync(path.join(source, "tests", "app", "small-ejection.toml"), "utf8");
writeFileSync(path.join(scratch, "small.toml"), small.replace('end_time = "6 ms"', 'end_time = "1 ms"   # short'));
for (const name of ["slow.toml", "next.toml"]) writeFileSync(path.join(scratch, name), small.replace('end_time = "6 ms"', 'end_time = "60 ms"'));
writeFileSync(path.join(scratch, "sizes.toml"), `[run]
end_time = "20 ms"
[flow]
solver = "none"
[[body]]
name = "ball"
shape = "sphere"
diameter = "10 mm"
[study]
quantities = ["/bodies/0/peak_speed_m_s"]
[[study.vary]]
key = "run.end_time"
values = ["5 ms", "10 ms", "15 ms", "20 ms"]
`);
writeFileSync(path.join(scratch, "area.toml"), `[run]
until = "verdict"
end_time = "200 ms"
[flow]
solver = "none"
[launch]
[splitter]
[[body]]
name = "cube"
shape = "box"
size = ["10 mm", "10 mm", "10 mm"]
on_belt = true
[map]
along = ["-20 mm", "20 mm"]
across = ["-10 mm", "10 mm"]
max_runs = 6
`);
for (const name of ["sorter/tutorial.toml", "paper/setup"]) cpSync(path.join(source, "cases", name), path.join(scratch, name), { recursive: true });
writeFileSync(path.join(scratch, "both.toml"), `[campaign]
[[campaign.part]]
kind = "study"
case = "sizes.toml"
`);

/** A box as an STL file, in a unit that only its owner knows. */
function rock([x, y, z]) {
  const corner = (n) => `${n & 1 ? x : 0} ${n & 2 ? y : 0} ${n & 4 ? z : 0}`;
  const quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  const facets = quads.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]).map((f) => `facet normal 0 0 0\nouter loop\n${f.map((n) => `vertex ${corner(n)}\n`).join("")}endloop\nendfacet\n`);
  return `solid rock\n${facets.join("")}endsolid rock\n`;
}

/** A ball of 18 x 13 x 9 with bumps. */
function lump() {
  const rings = 6, around = 8, points = [[0, 0, 4.5]];
  for (let r = 1; r < rings; ++r)
    for (let a = 0; a < around; ++a) {
      const [polar, turn, bump] = [(Math.PI * r) / rings, (2 * Math.PI * a) / around, 1 + 0.07 * Math.sin(5 * r * a + r + 3 * a)];
      points.push([9 * bump * Math.sin(polar) * Math.cos(turn), 6.5 * bump * Math.sin(polar) * Math.sin(turn), 4.5 * bump * Math.cos(polar)]);
    }
  points.push([0, 0, -4.5]);
  const at = (r, a) => (r === 0 ? 0 : r === rings ? points.length - 1 : 1 + (r - 1) * around + (a % around));
  const facets = [];
  for (let r = 0; r < rings; ++r)
    for (let a = 0; a < around; ++a) {
      if (r > 0) facets.push([at(r, a), at(r + 1, a), at(r, a + 1)]);
      if (r < rings - 1) facets.push([at(r, a + 1), at(r + 1, a), at(r + 1, a + 1)]);
    }
  return `solid lump\n${facets.map((f) => `facet normal 0 0 0\nouter loop\n${f.map((n) => `vertex ${points[n].join(" ")}\n`).join("")}endloop\nendfacet\n`).join("")}endsolid lump\n`;
}

/** The same as a scan gives it: rough all over, with more hollows than convex parts can follow. */
function scanned() {
  const rings = 10, around = 16, corners = [];
  const noise = (n) => 1 + 0.03 * (2 * ((Math.sin(12.9898 * n) * 43758.5453) % 1));
  const at = (r, a) => (r === 0 ? 0 : r === rings ? 1 : 2 + (r - 1) * around + (a % around));
  for (let n = 0; n < 2 + (rings - 1) * around; ++n) {
    const polar = n === 0 ? 0 : n === 1 ? Math.PI : (Math.PI * (1 + Math.floor((n - 2) / around))) / rings, turn = (2 * Math.PI * ((n - 2) % around)) / around;
    corners.push([8 * Math.sin(polar) * Math.cos(turn), 6 * Math.sin(polar) * Math.sin(turn), 5 * Math.cos(polar)].map((v) => v * noise(n)));
  }
  const facets = [];
  for (let r = 0; r < rings; ++r)
    for (let a = 0; a < around; ++a) {
      if (r > 0) facets.push([at(r, a), at(r + 1, a), at(r, a + 1)]);
      if (r < rings - 1) facets.push([at(r, a + 1), at(r + 1, a), at(r + 1, a + 1)]);
    }
  return `solid scan\n${facets.map((f) => `facet normal 0 0 0\nouter loop\n${f.map((n) => `vertex ${corners[n].join(" ")}\n`).join("")}endloop\nendfacet\n`).join("")}endsolid scan\n`;
}

async function serve(port) {
  const server = spawn(program, ["serve", scratch, ...(port ? ["--port", String(port)] : [])], { stdio: ["ignore", "pipe", "inherit"] });
  const [address] = await new Promise((resolve) => createInterface(server.stdout).once("line", (line) => resolve([line])));
  return { server, address, port: Number(new URL(address).port) };
}

let { server, address, port } = await serve();
const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"],
});
const errors = [];
// With the page's policy bypassed, waitForFunction can look into it; those of other sizes are opened as they are served.
async function open(viewport = { width: 1440, height: 900 }, colorScheme = "light", context) {
  const bypassCSP = viewport.width === 1440 && colorScheme === "light";
  const page = await (context ?? (await browser.newContext({ viewport, colorScheme, bypassCSP }))).newPage();
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("dialog", (dialog) => dialog.accept());
  await page.goto(address);
  await page.waitForSelector("html[data-ready]");
  return page;
}
const row = (page, name) => page.locator(`tr[data-job="${name}"]`);
const listed = (name, state) => `tr[data-job="${name}"]${state ? `.${state}` : ""}`;
const say = (words) => console.log(words);
/** Nobody is shut out: axe-core finds nothing. */
async function accessible(page, view) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  assert.deepEqual(violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).slice(0, 3).join(" | ")}`), [], view);
}
async function picture(page, name) {
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0, `${name} scrolls sideways`);
  await accessible(page, name);
  await page.screenshot({ path: path.join(screenshots, `workbench-${name}.png`), fullPage: true });
}
async function openCase(page, name) {
  await page.getByRole("button", { name, exact: true }).click();
  await page.locator("#case-name").getByText(name, { exact: true }).waitFor();
  await page.waitForSelector(".field.given", { state: "attached" });
}
const toRuns = (page) => page.getByRole("button", { name: "Runs", exact: true }).click();

try {
  const page = await open();
  assert.ok(!page.url().includes("token"), "the token stays out of the address");
  const paints = []; // of several, as the machine has other work
  for (let n = 0; n < 4; ++n) {
    await page.reload();
    await page.waitForSelector("html[data-ready]");
    paints.push(await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime));
  }
  const paint = Math.min(...paints);
  say(`first paint ${Math.round(paint)} ms`);
  if (process.env.EJECTA_TIMED) assert.ok(paint < 1000); // on a machine that does nothing else

  // Form and text are one case.
  await openCase(page, "small.toml");
  const text = page.locator("#text");
  const field = page.locator(`[id="key-valve.duration"]`);
  await field.fill("5");
  await field.press("Tab");
  await page.waitForFunction(() => document.querySelector("#text").value.includes('duration = "5 ms"'));
  assert.ok((await text.inputValue()).includes("# short"), "comments stay");
  assert.ok((await text.inputValue()).includes("# A small ejection"), "comments stay");
  await text.fill((await text.inputValue()).replace('duration = "5 ms"', 'duration = "7 ms"'));
  await page.waitForFunction(() => document.querySelector('[id="key-valve.duration"]').value === "7");

  // A wrong entry is said where it stands, in the words of the program.
  const start = page.locator('[data-start="run"]');
  await text.fill((await text.inputValue()).replace('duration = "7 ms"', 'duration = "7 mm"'));
  await page.waitForSelector(".problems .error");
  assert.ok(await start.isDisabled());
  assert.match(await page.locator(".problems .error").first().textContent(), /valve\.duration.*a time/s);
  assert.match(await page.locator(".fault.error").first().textContent(), /expected: a time/);
  await accessible(page, "a wrong entry");
  await page.screenshot({ path: path.join(screenshots, "workbench-error.png") });
  await text.fill((await text.inputValue()).replace('duration = "7 mm"', 'duration = "7 ms"'));
  await page.waitForFunction(() => !document.querySelector(".problems .error"));
  assert.ok((await page.locator(".drawing .body").count()) === 1, "the drawing shows the body");

  // What is typed fast arrives whole, and the checker keeps up.
  await text.press("Control+End");
  const typed = "# " + "abcdefgh ".repeat(Number(process.env.EJECTA_KEYS ?? 900) / 9);
  const before = Date.now();
  await text.pressSequentially(typed, { timeout: 0 });
  say(`${typed.length} keys typed in ${Date.now() - before} ms`);
  assert.ok((await text.inputValue()).endsWith(typed));

  // Two tabs: the second does not save over the first.
  const context = page.context();
  const other = await open(undefined, undefined, context);
  await openCase(other, "small.toml");

  // A double click is one run, which is shown as it goes; it comes to its verdict.
  await start.dblclick();
  await page.waitForSelector("section.job.done", { timeout: 120000 });
  await page.waitForSelector(".live canvas.stage");
  await page.waitForSelector(".live .u-wrap");
  assert.match(await page.locator(".verdict-line").textContent(), /particle/);
  await toRuns(page);
  assert.equal(await page.locator("tr[data-job]").count(), 1, "one run");
  assert.match(await row(page, "small.run").textContent(), /particle/);
  await other.locator("#text").press("Control+End");
  await other.locator("#text").pressSequentially("# other");
  await other.locator("#save").click();
  await other.waitForFunction(() => document.querySelector(".status").textContent.includes("changed elsewhere"));
  await other.close();
  const [report] = await Promise.all([context.waitForEvent("page"), row(page, "small.run").getByRole("link", { name: "Report" }).click()]);
  await report.waitForSelector("html[data-ready]", { timeout: 30000 });
  await report.close();

  // Several are a queue. Page and server may go and come back in the middle of it.
  for (const name of ["slow.toml", "next.toml"]) {
    await openCase(page, name);
    await start.click();
    await page.waitForSelector("section.job");
  }
  await toRuns(page);
  await page.waitForSelector(listed("slow.run", "running"), { timeout: 60000 });
  await page.waitForSelector(listed("next.run", "waiting"));
  await page.reload();
  await page.waitForSelector(listed("slow.run", "running"));
  server.kill("SIGKILL");
  await page.waitForSelector(".lost:not([hidden])");
  ({ server, address } = await serve(port));
  const again = await open();
  await again.waitForSelector(listed("slow.run", "running"));
  await again.waitForSelector(listed("next.run", "waiting"));
  await again.getByRole("button", { name: "Cancel next.run" }).click();
  await again.waitForSelector(listed("next.run"), { state: "detached" });

  // The jet with the body while it runs: the picture moves on by itself.
  await again.getByRole("button", { name: "Look at slow.run" }).click();
  await again.waitForFunction(() => parseFloat(document.querySelector(".live .clock")?.textContent) > 0.3, null, { timeout: 60000 });
  const clock = () => again.locator(".live .clock").textContent();
  const shown = await clock();
  await again.waitForFunction((then) => document.querySelector(".live .clock").textContent !== then, shown, { timeout: 60000 });
  say(`slider ${await again.locator(".live input[type=range]").inputValue()}`);
  await picture(again, "live");
  await again.getByRole("button", { name: "All runs" }).click();

  // By the keyboard alone: to the button that stops it.
  const stop = again.getByRole("button", { name: "Stop slow.run" });
  const tabTo = async (target) => {
    const there = () => target.evaluate((b) => b === document.activeElement);
    for (let n = 0; n < 240 && !(await there()); ++n) await again.keyboard.press("Tab");
    assert.ok(await there(), "the keyboard reaches it");
  };
  await tabTo(stop);

  // The focus stays where it is while the list goes on: the row of the run is another one every second.
  const focused = () => again.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.tagName);
  const renewed = async (name) => {
    await row(again, name).locator("td.progress").evaluate((cell) => (cell.dataset.old = ""));
    await again.waitForFunction((of) => !document.querySelector(`tr[data-job="${of}"] td.progress`).hasAttribute("data-old"), name, { timeout: 60000 });
  };
  await renewed("slow.run");
  assert.equal(await focused(), "Stop slow.run");
  await row(again, "small.run").getByRole("link", { name: "Report" }).focus(); // of a row that others pass
  writeFileSync(path.join(scratch, "again.toml"), readFileSync(path.join(scratch, "small.toml")));
  await again.evaluate(() => fetch("/api/start", { method: "POST", body: JSON.stringify({ case: "again.toml", kind: "run" }) }));
  await again.waitForSelector(listed("again.run", "waiting"));
  assert.equal(await focused(), "Report of small.run");
  await again.getByRole("button", { name: "Cancel again.run" }).focus();
  await again.keyboard.press("Enter");
  await again.waitForSelector(listed("again.run"), { state: "detached" });
  assert.notEqual(await focused(), "BODY", "what has gone leaves the focus to its neighbour");
  await stop.focus();
  await again.keyboard.press("Enter");
  await again.waitForSelector(listed("slow.run", "stopped"), { timeout: 60000 });
  assert.match(await focused(), /slow\.run$/);
  assert.ok(await again.getByRole("button", { name: "Resume slow.run" }).isVisible());

  // By the keyboard alone: a first case of somebody who has none, with the rock that he has as a file.
  await again.keyboard.press("Home");
  await tabTo(again.getByLabel("Name of a new case"));
  await again.keyboard.type("mine!"); // what no file is called is left out
  await again.keyboard.press("Enter");
  await again.waitForSelector(".drawing .body");
  assert.ok(existsSync(path.join(scratch, "mine.toml")));
  const [chooser] = await Promise.all([again.waitForEvent("filechooser"), tabTo(again.locator("#shape")).then(() => again.keyboard.press("Enter"))]);
  await chooser.setFiles({ name: "rock.stl", mimeType: "model/stl", buffer: Buffer.from(rock([20, 10, 5])) });
  await again.waitForSelector(".shapes fieldset");
  await again.waitForFunction(() => !document.querySelector(".problems .error") && document.querySelector(".shapes .size").textContent.includes("20.0"));
  const mine = () => again.locator("#text").inputValue();
  assert.match(await mine(), /scale = 0\.001/, "millimetres are guessed");
  assert.match(await again.locator(".shapes .note").textContent(), /mm is guessed/);
  const outline = () => again.locator(".drawing .body").getAttribute("points");
  const flat = await outline();
  await again.getByRole("button", { name: "Turn rock.stl about x" }).click();
  await again.waitForFunction(() => /^rotation_angle = "90 deg"/m.test(document.querySelector("#text").value));
  await again.waitForFunction((then) => document.querySelector(".drawing .body").getAttribute("points") !== then, flat);
  await again.getByRole("button", { name: "Turn rock.stl about z" }).click();
  await again.waitForFunction(() => /^rotation_angle = "120 deg"/m.test(document.querySelector("#text").value));
  await again.getByRole("button", { name: "as in the file" }).click();
  await again.waitForFunction(() => !/^rotation_/m.test(document.querySelector("#text").value));
  await again.locator("#shape-0-unit").selectOption("in");
  await again.waitForFunction(() => /scale = 0\.0254/.test(document.querySelector("#text").value));
  await again.locator("#shape-0-unit").selectOption("mm");
  await again.waitForFunction(() => document.querySelector(".shapes .size").textContent.includes("20.0"));
  assert.match(await mine(), /^name = "rock"/m, "it is the cube of the template no more");
  await again.locator("#shape-0-longest").fill("30");
  await again.locator("#shape-0-longest").press("Tab");
  await again.waitForFunction(() => /scale = 0\.0015/.test(document.querySelector("#text").value));
  await again.locator("#shape-0-unit").selectOption("mm");
  await again.waitForFunction(() => /scale = 0\.001\b/.test(document.querySelector("#text").value));
  assert.ok(await again.locator('[id="key-body.0.diameter"]').isHidden(), "what another shape needs");

  // A rock whose surface the grid cannot see as it is: its dents are filled, and that is said.
  const [finer] = await Promise.all([again.waitForEvent("filechooser"), again.locator("#shape").click()]);
  await finer.setFiles({ name: "lump.stl", mimeType: "model/stl", buffer: Buffer.from(lump()) });
  await again.waitForFunction(() => /are filled/.test(document.querySelector(".shapes .note").textContent) && !document.querySelector(".problems .error"));
  assert.match(await mine(), /^title = "lump"[^]*^name = "lump"/m);
  await again.locator("#shape-0-filled").fill("");
  await again.locator("#shape-0-filled").press("Tab");
  await again.waitForSelector(".problems .error");
  await again.locator("#shape-0-filled").fill("1.5");
  await again.locator("#shape-0-filled").press("Tab");
  await again.waitForFunction(() => !document.querySelector(".problems .error"));
  await again.locator("#save").click(); // before the page has heard that the text is changed
  await again.waitForFunction(() => document.querySelector("#save").ariaDisabled === "true");
  assert.match(readFileSync(path.join(scratch, "mine.toml"), "utf8"), /^scale = 0\.001/m);

  // One as a scan gives it, with the name that somebody gave the file.
  const [rough] = await Promise.all([again.waitForEvent("filechooser"), again.locator("#shape").click()]);
  await rough.setFiles({ name: "Rock #3 (scan).STL", mimeType: "model/stl", buffer: Buffer.from(scanned()) });
  await again.waitForFunction(() => /Rock 3 scan/.test(document.querySelector(".shapes legend").textContent)
    && /are filled/.test(document.querySelector(".shapes .note").textContent) && !document.querySelector(".problems .error"), null, { timeout: 60000 });
  assert.ok(existsSync(path.join(scratch, "Rock 3 scan.stl")));
  assert.match(await mine(), /^name = "Rock 3 scan"/m);
  await again.locator("#save").click();
  await again.waitForFunction(() => document.querySelector("#save").ariaDisabled === "true");

  // A study: its curves come with its runs.
  await openCase(again, "sizes.toml");
  await again.getByRole("button", { name: "Start study" }).click();
  await again.waitForSelector("section.job.done", { timeout: 60000 });
  await again.waitForSelector(".job-content .u-wrap");
  await picture(again, "study");

  // A map, of nothing where no air blows.
  await openCase(again, "area.toml");
  await again.getByRole("button", { name: "Start map" }).click();
  await again.waitForSelector("section.job.done", { timeout: 60000 });
  await again.waitForSelector(".job-content svg");
  await picture(again, "map");

  // What has ended can be put away.
  await toRuns(again);
  await row(again, "area.map").getByRole("button", { name: "Remove area.map" }).click();
  await again.waitForSelector(listed("area.map"), { state: "detached" });
  assert.ok(existsSync(path.join(scratch, ".removed", "1", "area.map", "result.json")));

  // A sorter, and a campaign.
  await openCase(again, "sorter/tutorial.toml");
  await again.getByRole("button", { name: "Start sorter" }).click();
  await again.waitForSelector("section.job.done", { timeout: 60000 });
  await again.waitForSelector(".sort-view canvas");
  await picture(again, "sorter");
  await openCase(again, "both.toml");
  await again.getByRole("button", { name: "Start campaign" }).click();
  await again.waitForSelector("section.job.done", { timeout: 60000 });
  await again.waitForSelector(".job-content tbody tr");
  await picture(again, "campaign");

  for (const [width, scheme] of [[1440, "light"], [1440, "dark"], [800, "light"], [800, "dark"], [390, "light"], [390, "dark"]]) {
    const small = await open({ width, height: 900 }, scheme);
    await picture(small, `runs-${width}-${scheme}`);
    await openCase(small, "mine.toml");
    await small.waitForSelector(".drawing .body");
    await picture(small, `case-${width}-${scheme}`);
    await toRuns(small);
    await small.getByRole("button", { name: "Look at slow.run" }).click();
    await small.waitForSelector(".live .u-wrap");
    await picture(small, `job-${width}-${scheme}`);
    await small.context().close();
  }

  // A long list.
  for (let n = 0; n < 1000; ++n) {
    const copy = path.join(scratch, `copy-${n}.run`);
    mkdirSync(copy);
    for (const name of ["manifest.json", "result.json", "progress.json"]) cpSync(path.join(scratch, "small.run", name), path.join(copy, name));
  }
  const long = await open();
  // By the clock of the page, until the frame after the one that has them all; of several, as the machine has other work.
  await long.addInitScript(() => {
    const look = () => requestAnimationFrame(document.querySelectorAll("tr[data-job]").length > 1000 ? () => (window.listed = performance.now()) : look);
    look();
  });
  const lists = [];
  for (let n = 0; n < 4; ++n) {
    await long.reload();
    lists.push(await (await long.waitForFunction(() => window.listed)).jsonValue());
  }
  const took = Math.min(...lists);
  say(`1000 runs shown in ${lists.map(Math.round).join(", ")} ms`);
  if (process.env.EJECTA_TIMED) assert.ok(took < 1000);
  await long.getByLabel("Show").fill("copy-99");
  assert.equal(await long.locator("tr[data-job]:visible").count(), 11);

  await browser.newPage().then(async (stranger) => {
    const answer = await stranger.goto(`http://127.0.0.1:${port}/`);
    assert.equal(answer.status(), 403, "who has no token sees nothing");
  });
  assert.deepEqual(errors, []);
  say("workbench: passed");
} finally {
  await browser.close();
  server.kill("SIGINT");
}
