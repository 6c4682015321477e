// Opens the pages of a map and of a study in a real browser, in light, dark, on a phone and as print.
// node study_page_test.mjs NODE_MODULES_OF_REPORT SCREENSHOTS KIND REPORT.html RESULT.json
// Ends with 77 (skipped) where playwright-core or the browser is absent.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [modules, screenshots, kind, report, resultFile] = process.argv.slice(2);
const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};
const browserPath = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);
if (!browserPath) skip("no chromium");
if (!existsSync(path.join(modules, "playwright-core"))) skip("no playwright-core: the report page was not built");
const { chromium } = createRequire(path.join(modules, "x.js"))("playwright-core");
const result = JSON.parse(readFileSync(resultFile, "utf8"));

const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"],
});
try {
  assert.ok(statSync(report).size < 1.5e6, `the page has ${statSync(report).size} bytes`);
  mkdirSync(screenshots, { recursive: true });
  for (const [width, scheme] of [[1280, "light"], [1280, "dark"], [390, "light"]]) {
    const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme: scheme });
    const errors = [];
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("request", (request) => /^https?:/.test(request.url()) && errors.push(`not offline: ${request.url()}`));
    await page.goto(pathToFileURL(report).href);
    await page.waitForSelector("html[data-ready]");
    await page.waitForTimeout(300);
    assert.ok((await page.title()).includes(result.title));
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0, "scrolls sideways");
    for (const figure of await page.locator("svg[role=img], .chart").all())
      assert.ok((await figure.getAttribute("aria-label"))?.length > 20, "a figure without words");
    if (kind === "map") {
      // Every run is a mark that opens its report, in its place.
      const marks = await page.locator(".map-view a").all();
      assert.equal(marks.length, result.runs.length);
      assert.equal(await marks[0].getAttribute("href"), `${result.runs[0].directory}/report.html`);
      assert.equal(await page.locator(".map-view .run.failed").count(), result.runs.filter((r) => r.clearance_m === null).length);
      assert.equal(await page.locator(".map-view .plate-variant").count(), result.plates.length);
      assert.equal(await page.locator(".map-view .contradiction").count(), result.contradictions.length);
      assert.ok((await page.locator("h1").textContent()).replace(/\u00a0/g, " ").includes(result.summary.slice(10, 40)));
    } else {
      assert.equal(await page.locator("#runs tbody tr").count(), result.runs.length);
      assert.ok((await page.locator("#charts .chart").count()) >= result.keys.length);
      assert.ok((await page.locator("#extremes a").count()) >= 2);
    }
    await page.screenshot({ path: path.join(screenshots, `${kind}-${width}-${scheme}.png`), fullPage: true });
    if (scheme === "dark") {
      await page.emulateMedia({ media: "print" });
      await page.pdf({ path: path.join(screenshots, `${kind}.pdf`), format: "A4" });
    }
    assert.deepEqual(errors, []);
    await page.close();
  }
  console.log(`${kind}: ${result.runs.length} runs shown`);
} finally {
  await browser.close();
}
