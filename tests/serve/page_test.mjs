// The workbench in a real browser: from the form to the verdict, wrong entries, reload, a server that dies, stop.
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
const { chromium } = createRequire(path.join(modules, "x.js"))("playwright-core");

rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
mkdirSync(screenshots, { recursive: true });
const small = readFileSync(path.join(source, "tests", "app", "small-ejection.toml"), "utf8");
writeFileSync(path.join(scratch, "small.toml"), small.replace('end_time = "6 ms"', 'end_time = "1 ms"   # short'));
writeFileSync(path.join(scratch, "slow.toml"), small.replace('end_time = "6 ms"', 'end_time = "60 ms"'));

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
const row = (page, name) => page.locator(`tr[data-run="${name}"]`);
const say = (words) => console.log(words);

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
  await page.getByRole("button", { name: "small.toml" }).click();
  await page.waitForSelector(".field.given");
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
  const start = page.locator("#start");
  await text.fill((await text.inputValue()).replace('duration = "7 ms"', 'duration = "7 mm"'));
  await page.waitForSelector(".problems .error");
  assert.ok(await start.isDisabled());
  assert.match(await page.locator(".problems .error").first().textContent(), /valve\.duration.*a time/s);
  assert.match(await page.locator(".fault.error").first().textContent(), /expected: a time/);
  await page.screenshot({ path: path.join(screenshots, "workbench-error.png") });
  await text.fill((await text.inputValue()).replace('duration = "7 mm"', 'duration = "7 ms"'));
  await page.waitForFunction(() => !document.querySelector(".problems .error"));
  assert.ok((await page.locator(".drawing .body").count()) === 1, "the drawing shows the body");

  // What is typed fast arrives whole, and the checker keeps up.
  await text.press("Control+End");
  const typed = "# " + "abcdefgh ".repeat(100);
  const before = Date.now();
  await text.pressSequentially(typed);
  say(`${typed.length} keys typed in ${Date.now() - before} ms`);
  assert.ok((await text.inputValue()).endsWith(typed));
  await page.screenshot({ path: path.join(screenshots, "workbench-case.png") });

  // Two tabs: the second does not save over the first.
  const context = page.context();
  const other = await open(undefined, undefined, context);
  await other.getByRole("button", { name: "small.toml" }).click();
  await other.waitForSelector(".field.given");

  // A double click is one run; it comes to its verdict.
  await start.dblclick();
  await page.waitForSelector('tr[data-run="small.run"]');
  await page.waitForSelector('tr[data-run="small.run"].done', { timeout: 120000 });
  assert.equal(await page.locator("tr[data-run]").count(), 1, "one run");
  assert.match(await row(page, "small.run").textContent(), /particle/);
  await other.locator("#text").press("Control+End");
  await other.locator("#text").pressSequentially("# other");
  await other.locator("#save").click();
  await other.waitForFunction(() => document.querySelector(".status").textContent.includes("changed elsewhere"));
  await other.close();
  const [report] = await Promise.all([context.waitForEvent("page"), row(page, "small.run").getByRole("link", { name: "Report" }).click()]);
  await report.waitForSelector("html[data-ready]", { timeout: 30000 });
  await report.close();

  // The page and the server may go and come back in the middle of a run.
  await page.getByRole("button", { name: "slow.toml" }).click();
  await page.waitForSelector(".field.given");
  await start.click();
  await page.waitForSelector('tr[data-run="slow.run"].running', { timeout: 60000 });
  await page.reload();
  await page.waitForSelector('tr[data-run="slow.run"].running');
  server.kill("SIGKILL");
  await page.waitForSelector(".lost:not([hidden])");
  ({ server, address } = await serve(port));
  const again = await open();
  await again.waitForSelector('tr[data-run="slow.run"].running');
  await again.screenshot({ path: path.join(screenshots, "workbench-runs.png") });

  // By the keyboard alone: to the button that stops it.
  const stop = again.getByRole("button", { name: "Stop slow.run" });
  for (let n = 0; n < 60 && !(await stop.evaluate((b) => b === document.activeElement)); ++n) await again.keyboard.press("Tab");
  assert.ok(await stop.evaluate((b) => b === document.activeElement), "the keyboard reaches it");
  await again.keyboard.press("Enter");
  await again.waitForSelector('tr[data-run="slow.run"].stopped', { timeout: 60000 });
  assert.ok(await again.getByRole("button", { name: "Resume slow.run" }).isVisible());

  // A first case of somebody who has none.
  await again.getByLabel("Name of a new case").fill("mine");
  await again.getByRole("button", { name: "New case" }).click();
  await again.waitForSelector(".drawing .body");
  assert.ok(existsSync(path.join(scratch, "mine.toml")));

  for (const [width, scheme] of [[1440, "dark"], [800, "light"], [390, "light"], [390, "dark"]]) {
    const small = await open({ width, height: 900 }, scheme);
    assert.equal(await small.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0, `scrolls sideways at ${width}`);
    await small.screenshot({ path: path.join(screenshots, `workbench-runs-${width}-${scheme}.png`), fullPage: true });
    await small.getByRole("button", { name: "mine.toml" }).click();
    await small.waitForSelector(".drawing .body");
    assert.equal(await small.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0, `scrolls sideways at ${width}`);
    await small.screenshot({ path: path.join(screenshots, `workbench-case-${width}-${scheme}.png`), fullPage: true });
    await small.context().close();
  }

  // A long list.
  for (let n = 0; n < 1000; ++n) {
    const copy = path.join(scratch, `copy-${n}.run`);
    mkdirSync(copy);
    for (const name of ["manifest.json", "result.json", "progress.json"]) cpSync(path.join(scratch, "small.run", name), path.join(copy, name));
  }
  const long = await open();
  const begun = Date.now();
  await long.reload();
  await long.waitForFunction(() => document.querySelectorAll("tr[data-run]").length > 1000);
  say(`1000 runs shown in ${Date.now() - begun} ms`);

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
