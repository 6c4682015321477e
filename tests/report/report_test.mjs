// Opens reports in a real browser: no console error, the replay moves, the numbers equal result.json.
// node report_test.mjs NODE_MODULES_OF_REPORT SCREENSHOTS REPORT.html RUN_DIR [RUN_DIR...]
// Ends with 77 (skipped) where playwright-core or the browser is absent.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [modules, screenshots, report, ...runs] = process.argv.slice(2);
const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};
const browserPath = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);
if (!browserPath) skip("no chromium");
if (!existsSync(path.join(modules, "playwright-core"))) skip("no playwright-core: the report page was not built");
const { chromium } = createRequire(path.join(modules, "x.js"))("playwright-core");

const results = runs.map((run) => JSON.parse(readFileSync(path.join(run, "result.json"), "utf8")));
const at = (json, pointer) => pointer.split("/").slice(1).reduce((value, key) => value?.[key], json);
const SIZE_LIMIT = 5e6;
/** Units the page shows, in SI. */
const UNITS = { mm: 1e-3, "m/s": 1, "mN\u00b7s": 1e-3, g: 1e-3, ms: 1e-3, s: 1, million: 1e6 };
const SUPERSCRIPT = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";

/** The number of a text such as "+31.2 mm", "2.2x10^-6" or "2 min 14 s" and half a unit of its last digit, in SI. */
function shown(text) {
  const plain = text.replace(/\u2212/g, "-").replace(/\u202f/g, "").trim();
  const clock = plain.match(/^(\d+) (h|min) (\d+) (min|s)$/);
  if (clock) {
    const last = clock[4] === "min" ? 60 : 1;
    return { value: (Number(clock[1]) * 60 + Number(clock[3])) * last, half: last };
  }
  const power = plain.match(/\u00d710([\u207b]?)([\u2070\u00b9\u00b2\u00b3\u2074-\u2079]+)/);
  const exponent = power ? Number((power[1] ? "-" : "") + [...power[2]].map((c) => SUPERSCRIPT.indexOf(c)).join("")) : 0;
  const number = plain.match(/[+-]?\d+(\.(\d+))?/);
  const unit = plain.replace(/\u00d710\S+/, "").match(/[a-z][a-zN\u00b7/]*$/i)?.[0];
  const scale = 10 ** exponent * (unit ? (UNITS[unit] ?? NaN) : 1);
  return { value: Number(number[0]) * scale, half: 0.5 * 10 ** -(number[2]?.length ?? 0) * scale };
}

const browser = await chromium.launch({
  executablePath: browserPath,
  args: ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  assert.ok(statSync(report).size < SIZE_LIMIT, `the report has ${statSync(report).size} bytes`);
  mkdirSync(screenshots, { recursive: true });
  for (const [width, scheme] of [[1440, "light"], [1440, "dark"], [800, "light"], [800, "dark"]]) {
    const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme: scheme });
    const errors = [];
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("request", (request) => /^https?:/.test(request.url()) && errors.push(`not offline: ${request.url()}`));
    await page.goto(pathToFileURL(report).href);
    await page.waitForSelector("html[data-ready]");

    // Numbers, rounded and in full.
    let compared = 0;
    for (const element of await page.locator("[data-pointer]").all()) {
      const result = results[Number(await element.getAttribute("data-run"))];
      const expected = at(result, await element.getAttribute("data-pointer"));
      const text = await element.textContent();
      if (typeof expected !== "number") continue;
      const { value, half } = shown(text);
      const around = await element.evaluate((e) => e.parentElement.textContent);
      const signed = around.includes("below the plate's edge") ? -value : value;
      assert.ok(Math.abs(signed - expected) <= half * 1.01, `"${text}" for ${expected}: ${around}`);
      ++compared;
    }
    assert.ok(compared >= 5, `only ${compared} numbers shown`);
    for (const element of await page.locator("[data-exact]").all()) {
      const expected = at(results[Number(await element.getAttribute("data-run"))], await element.getAttribute("data-exact"));
      const text = !Array.isArray(expected) ? String(expected) : expected.length <= 6 ? expected.join(", ") : `${expected.length} values`;
      assert.equal(await element.textContent(), text);
    }

    // Inputs, and by what several runs differ: a line each.
    if (runs.length === 1 && results[0].inputs) {
      const inputs = await page.locator("#inputs tbody tr").allTextContents();
      for (const { key, value } of results[0].inputs.filter(({ key }) => /^(valve|launch|body)/.test(key)))
        assert.ok(inputs.some((line) => line.includes(key) && line.includes(value)), `${key} is not on the page`);
      await page.locator("#inputs .u-wrap").waitFor();
    }
    if (runs.length > 1 && results.every(({ inputs }) => inputs)) assert.equal(await page.locator(".verdict > .table-holder tbody tr").count(), runs.length);

    // No sideways scrolling, every image described, a heading for each section.
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `the page is ${overflow} px too wide at ${width}`);
    assert.equal(await page.locator("[role=img]:not([aria-label])").count(), 0, "an image without a description");
    assert.equal(await page.locator("section:not(:has(h2))").count(), 0, "a section without a heading");
    assert.equal(await page.locator("h1").count(), 1);

    // The replay plays, stops, steps and scrubs, by mouse and by keyboard.
    if ((await page.locator("#play").count()) > 0) {
      const clock = async () => parseFloat(await page.locator("#clock").textContent());
      const picture = () => page.locator("canvas.stage").first().evaluate((c) => c.toDataURL());
      await page.locator("#play").scrollIntoViewIfNeeded();
      const [time0, picture0] = [await clock(), await picture()];
      await page.locator("#play").click();
      await page.waitForFunction((t) => Math.abs(parseFloat(document.querySelector("#clock").textContent) - t) > 1, time0);
      await page.locator("#play").click();
      const time1 = await clock();
      assert.ok((await picture()) !== picture0, "the picture did not move");
      await page.waitForTimeout(150);
      assert.equal(await clock(), time1, "it did not stop");
      await page.locator("#scrub").focus();
      await page.keyboard.press("ArrowRight");
      assert.ok((await clock()) > time1, "an arrow key did not step");
      await page.keyboard.press(" ");
      await page.waitForFunction(() => document.querySelector("#play").textContent === "Pause");
      await page.keyboard.press(" ");
      await page.locator("#scrub").evaluate((range) => {
        range.value = "0";
        range.dispatchEvent(new Event("input"));
      });
      const colour = page.locator("label.field:has-text('Colour') select");
      if ((await colour.count()) > 0) {
        const inSpace = page.locator("canvas.stage").last();
        const drawn = () => inSpace.evaluate((c) => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(c.toDataURL())))));
        await colour.selectOption("body");
        const byBody = await drawn();
        await colour.selectOption("speed");
        assert.ok((await drawn()) !== byBody, "the colour of the bodies did not change");
        assert.match(await page.locator(".panel").last().locator(".legend").textContent(), /Speed of bodies 0.* m\/s/);
      }
      const start = await clock();
      assert.ok(start <= time0, "it did not go back to the start");
      await page.reload();
      await page.waitForSelector("html[data-ready]");
    }
    await page.evaluate(async () => {
      for (let y = 0; y < document.body.scrollHeight; y += 600) {
        scrollTo(0, y);
        await new Promise((done) => requestAnimationFrame(done));
      }
      scrollTo(0, 0);
    });
    await page.waitForTimeout(200);
    await page.screenshot({ path: path.join(screenshots, `${path.basename(report, ".html")}-${width}-${scheme}.png`), fullPage: true });
    // On paper a run has three pages; what there is only on the screen is on none.
    if (width === 1440 && scheme === "dark") {
      const paper = await page.pdf({ path: path.join(screenshots, `${path.basename(report, ".html")}.pdf`), format: "A4", printBackground: true });
      const pages = paper.toString("latin1").match(/\/Type \/Page\b/g).length;
      if (runs.length === 1 && results[0].bodies?.length) assert.equal(pages, 3);
    }
    assert.deepEqual(errors, []);
    await page.close();
  }
  console.log(`${path.basename(report)}: passed`);
} finally {
  await browser.close();
}
