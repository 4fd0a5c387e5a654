// The page in Chromium: viewer_test.mjs VIEWER_FOLDER CHROMIUM PAGES_FOLDER times | views [SCREENSHOT_FOLDER]
// PAGES_FOLDER holds what assay_write_example writes. The tests of times want the machine alone.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { deflateSync, inflateSync } from "node:zlib";

const [viewer, chromium_path, pages, part, screenshots] = process.argv.slice(2);
const require = createRequire(join(resolve(viewer), "package.json"));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

const widths = { wide: [1400, 1000], middle: [800, 1000], phone: [390, 844] };
const browser = await chromium.launch({ executablePath: chromium_path, args: ["--no-sandbox"] });
const reader = await (await browser.newContext()).newPage();

/// Pages between tests: to load another file is cheaper than to begin in a new context.
const idle = { true: [], false: [] };
async function begun(scripts) {
  const page = await (await browser.newContext({ javaScriptEnabled: scripts })).newPage();
  Object.assign(page, { idle: idle[scripts], said: [], asked: [] });
  page.on("console", (message) => page.said.push(message.text()));
  page.on("pageerror", (error) => page.said.push(String(error)));
  page.on("dialog", (dialog) => {
    page.said.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => page.asked.push(request.url()));
  // A guard against hanging on a busy machine; the part `times` measures.
  page.setDefaultTimeout(120000);
  return page;
}

/// A page that is ready, with all that it said on the console and all that it asked the network.
let loads = 0;
async function opened(name, { size = "wide", scheme = "light", hash = "", scripts = true } = {}) {
  const page = idle[scripts].pop() ?? (await begun(scripts));
  const [width, height] = widths[size];
  await page.setViewportSize({ width, height });
  await page.emulateMedia({ media: null, colorScheme: scheme });
  await page.mouse.move(0, 0);
  page.said = [];
  page.asked = [];
  // The query makes each address another one: the browser loads it anew.
  await page.goto(`file://${resolve(pages, name)}.html?${(loads += 1)}${hash}`);
  if (scripts) await page.waitForFunction(() => document.documentElement.dataset.ready === "yes");
  return page;
}

/// Writes a page whose record is that of another page after a change, and returns its name.
function changed(name, as, change) {
  const page = readFileSync(resolve(pages, `${name}.html`), "utf8");
  const [, before, held] = page.match(/^([^]*<script[^>]*id="record"[^>]*>)([^<]*)/);
  const bytes = inflateSync(Buffer.from(held, "base64"));
  const length = bytes.readUInt32LE(0);
  const told = JSON.parse(bytes.toString("utf8", 4, 4 + length));
  change(told.record, (verdict, standing) => {
    for (const test of told.record.suites.flatMap((suite) => suite.tests)) {
      test.verdict = verdict;
      test.display.standing = standing;
    }
  });
  const text = Buffer.from(JSON.stringify(told));
  const start = Buffer.alloc(4);
  start.writeUInt32LE(text.length);
  const packed = deflateSync(Buffer.concat([start, text, bytes.subarray(4 + length)]), { level: 1 }).toString("base64");
  writeFileSync(resolve(pages, `${as}.html`), before + packed + page.slice(before.length + held.length));
  return as;
}

async function closed(page) {
  assert.deepEqual(page.said, [], "the console is silent");
  assert.equal(page.asked.length, 1, `one request, the page itself: ${page.asked}`);
  page.idle.push(page);
}

/// Clicks what matches until nothing does: a click changes what matches.
async function click_all(page, selector) {
  for (let left = 20; left > 0 && (await page.locator(selector).count()) > 0; --left) {
    await page.locator(selector).evaluateAll((all) => all.forEach((one) => one.click()));
    await frame(page);
  }
  assert.equal(await page.locator(selector).count(), 0, `${selector} is left`);
}
async function open_all(page) {
  await click_all(page, '.suite h3 button[aria-expanded="false"]');
  await click_all(page, 'button.row[aria-expanded="false"]');
  await click_all(page, '.tools button[aria-expanded="false"]');
  await click_all(page, "details:not([open]) > summary");
}

/// What axe-core finds. It comes by the browser's own channel: the page's policy lets no script in.
async function violations(page) {
  await page.evaluate(axe);
  return page.evaluate(async () => {
    const { violations } = await window.axe.run({ resultTypes: ["violations"] });
    return violations.map(({ id, nodes }) => `${id}: ${nodes[0].html.slice(0, 200)} ${nodes[0].failureSummary}`);
  });
}

const plain = async (locator) => (await locator.innerText()).replaceAll("\u00a0", " ");
const elements = (page) => page.evaluate(() => document.querySelectorAll("*").length);
const chosen = (page) => page.locator('nav [aria-pressed="true"]').innerText();
const rows = (page) => page.locator(".suite li").count();
const frame = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/// How bright a part of the page looks, 0 to 1.
async function brightness(locator) {
  const picture = (await locator.screenshot()).toString("base64");
  return reader.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let sum = 0;
    for (let i = 0; i < data.length; ++i) sum += i % 4 === 3 ? 0 : data[i] / 255;
    return sum / (0.75 * data.length);
  }, picture);
}

/// How much colour a canvas shows, 0 to 1, inside and outside a rectangle of its pixels.
function colour(page, rectangle) {
  return page.locator(".card canvas").first().evaluate((canvas, [x, y, width, height]) => {
    const copy = document.createElement("canvas");
    Object.assign(copy, { width: canvas.width, height: canvas.height });
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.fillStyle = "#fff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    const sums = { inside: [0, 0], outside: [0, 0] };
    for (let py = 0; py < canvas.height; ++py) {
      for (let px = 0; px < canvas.width; ++px) {
        const at = 4 * (py * canvas.width + px);
        const [least, most] = [Math.min(data[at], data[at + 2]), Math.max(data[at], data[at + 2])];
        const inside = px >= x && px < x + width && py >= y && py < y + height;
        const sum = sums[inside ? "inside" : "outside"];
        sum[0] += (most - least) / 255;
        sum[1] += 1;
      }
    }
    return { inside: sums.inside[0] / sums.inside[1], outside: sums.outside[0] / sums.outside[1] };
  }, rectangle);
}

/// Opens all parts. In a colour scheme, axe finds no violation in them.
async function parts_open(size, scheme) {
  const page = await opened("example", { size });
  await open_all(page);
  assert.equal(await page.locator(".detail").count(), 13);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= widths[size][0], `${wide} pixels wide`);
  assert.ok((await page.locator("figure svg").count()) > 10, "charts are drawn");
  assert.equal(await page.locator("svg style").count(), 0);
  const named = await page.locator(".detail figure svg").evaluateAll((all) => all.map((svg) => (svg.textContent.match(/[↑→]/g) ?? []).length));
  assert.ok(named.every((names) => names === 2), `names of axes: ${named}`);
  assert.ok((await page.locator(".matrix td").count()) > 0, "the matrix of planted bugs is shown");
  assert.match(await page.locator(".statements").innerText(), /contradicted/);
  const intervals = await page.locator(".detail").allInnerTexts();
  assert.ok(intervals.some((text) => text.includes("Chance of this if nothing is wrong")));
  // Hostile names run nothing.
  assert.equal(await page.locator("script").count(), 1);
  assert.equal(await page.locator("main b b, main script").count(), 0);
  assert.match(await page.locator("main").innerText(), /<script>alert\(1\)<\/script>/);
  if (scheme) {
    await page.emulateMedia({ colorScheme: scheme });
    assert.deepEqual(await violations(page), [], `${scheme} ${size}`);
  }
  await closed(page);
}

/// How long this browser takes to unpack what the page holds, in milliseconds: the machine's own speed.
function bare_reading(name) {
  const held = readFileSync(resolve(pages, `${name}.html`), "utf8").match(/<script[^>]*id="record"[^>]*>([^<]*)/)[1];
  return reader.evaluate(async (base64) => {
    const start = performance.now();
    const packed = Uint8Array.from(atob(base64.trim()), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = await new Response(stream).arrayBuffer();
    JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, new DataView(bytes).getUint32(0, true))));
    return performance.now() - start;
  }, held);
}

const times = {
  async "1508 claims are small, soon ready and few elements"() {
    const bytes = statSync(resolve(pages, "many.html")).size;
    assert.ok(bytes < 5e6, `${bytes} bytes`);
    const [ready, bare] = [[], []];
    for (let i = 0; i < 3; ++i) {
      bare.push(await bare_reading("many"));
      const page = await opened("many");
      ready.push(await page.evaluate(() => performance.getEntriesByName("ready")[0].startTime));
      const count = await elements(page);
      assert.ok(count < 3000, `${count} elements`);
      assert.match(await page.title(), /8 of 1508/);
      if (i === 2) console.log(`    ${bytes} bytes, ${count} elements`);
      await closed(page);
    }
    const [page, reading] = [ready, bare].map((each) => Math.round(Math.min(...each)));
    console.log(`    ready after ${page} ms, bare reading takes ${reading} ms`);
    // On a slow machine the bound grows with the time of bare reading.
    assert.ok(page < Math.max(1500, 3 * reading), `ready after ${ready} ms, bare reading ${bare} ms`);
  },
};

const views = {
  async "failures are on the first screen at every width"() {
    for (const size of Object.keys(widths)) {
      for (const name of ["many", "example", "ellipse"]) {
        const page = await opened(name, { size });
        const [width, height] = widths[size];
        const box = await page.locator(".card .sentence").first().boundingBox();
        assert.ok(box.y + box.height <= height, `${name} at ${width}: the first failure ends at ${box.y + box.height}`);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${name} at ${width}: ${wide} pixels wide`);
        await closed(page);
      }
    }
  },

  async "a claim without a verdict says why, and what to do"() {
    const page = await opened("example", { hash: "#show=no+verdict" });
    assert.equal(await rows(page), 2);
    await page.locator(".suite li .row", { hasText: "variance(heavy)" }).click();
    const detail = await plain(page.locator(".detail"));
    for (const part of [/Nothing was decided/, /Reason\s+the fourth moment/, /tail index 0.41, limit 0.25/, /claim a quantile/, /assay replay run.json/])
      assert.match(detail, part);
    await closed(page);
  },

  async "what the console says beside a verdict is on the page"() {
    const name = changed("example", "notes", (record) => {
      const [first, second] = record.suites[0].tests.filter((test) => test.verdict === "fail");
      first.display.steps.unshift({ label: "note", words: "one picture, taken as exact", paste: "" });
      second.display.steps.unshift({ label: "note", words: "rarer values could also explain this", paste: "" });
      record.display.suspects.find(({ tests }) => tests.includes(first.id)).tests.push(second.id);
    });
    const page = await opened(name);
    const cards = await plain(page.locator('[aria-label="What broke"]'));
    assert.match(cards, /note\s+one picture, taken as exact/);
    assert.match(cards, /note\s+forgetting the receiver's cosine is caught: rarer values could also explain this/);
    assert.match(cards, /pass, but fail expected: mean\(shared_seed\) is 0\.06 % above analytic/);
    assert.match(await plain(page.locator("header")), /filtered: verdicts rest on fixed shares/);
    await open_all(page);
    const claims = await plain(page.locator(".claims"));
    for (const part of [/a bias of 0\.31 % or more is excluded/, /It was not run\.\s+belongs to another shard/])
      assert.match(claims, part);
    assert.match(await plain(page.locator("main")), /Programs that failed and were started again: 1\./);
    await closed(page);
  },

  async "an undecided claim has a card on the first screen that says what would decide it"() {
    const name = changed("many", "undecided", (record, judge) => {
      judge("pass", "holds");
      record.display.suspects = [];
      for (const test of record.suites[3].tests.slice(0, 20)) {
        Object.assign(test, { verdict: "inconclusive", message: "the budget ended; 5 k more observations would decide" });
        Object.assign(test.display, { standing: "undecided", verdict: "inconclusive" });
        test.display.steps = [{ label: "write into the test", words: "", paste: "secondaries: 10000" }];
      }
    });
    for (const size of Object.keys(widths)) {
      const page = await opened(name, { size });
      const card = page.locator(".card").first();
      const box = await card.boundingBox();
      assert.ok(box.y + box.height <= widths[size][1], `the first card ends at ${box.y + box.height}`);
      for (const part of [/the budget ended/, /write into the test\s+secondaries: 10000/]) assert.match(await plain(card), part);
      assert.equal(await page.locator(".card").count(), 12);
      await page.getByRole("link", { name: "8 more" }).click();
      assert.equal(await rows(page), 20);
      await closed(page);
    }
    // The cards of broken claims come first.
    const page = await opened("example");
    const kinds = await page.locator(".card").evaluateAll((all) => all.map((card) => card.className));
    assert.deepEqual(kinds.slice(-2), ["card undecided", "card undecided"]);
    assert.equal(kinds.filter((kind) => kind === "card").length, kinds.length - 2);
    await closed(page);
  },

  async "an alarm of nights shows when it moved and what changed"() {
    const page = await opened("example");
    const card = page.locator(".card", { hasText: "drifted" });
    assert.match(await plain(card), /most likely on the night of 2026-11-13 02:00 UTC, by Assay 14467a0bbe61/);
    assert.match(await plain(card), /git log --oneline \w+\.\.14467a0bbe61/);
    assert.equal(await card.locator("figure circle").count(), 12);
    assert.equal(await card.locator('figure path[stroke-dasharray], figure [stroke-dasharray] path').count(), 1);
    assert.doesNotMatch(await plain(card), /e-value/);
    await closed(page);
  },

  async "the axis is shown where some claim has what must be caught"() {
    for (const [name, axes, size] of [["example", 1, "wide"], ["example", 1, "phone"], ["without-detect", 0, "wide"]]) {
      const page = await opened(name, { size });
      assert.equal(await page.locator(".row.head", { hasText: "must be caught" }).count(), axes);
      assert.equal(await page.locator(".row.head svg.axis:visible").count(), axes);
      await closed(page);
    }
  },

  async "claims are filtered by keyboard within three tabs"() {
    const page = await opened("many");
    for (let tabs = 1; tabs <= 3; ++tabs) {
      await page.keyboard.press("Tab");
      const words = await page.evaluate(() => document.activeElement.textContent);
      if (words.includes("Broken")) break;
      assert.ok(tabs < 3, "three tabs do not reach the filter");
    }
    await page.keyboard.press("Enter");
    assert.match(await chosen(page), /Broken/);
    assert.equal(await rows(page), 8);
    await page.keyboard.press("/");
    await page.keyboard.type("estimator_21)");
    assert.equal(await rows(page), 1);
    await closed(page);
  },

  async "what a reader chose survives a reload and a link"() {
    const page = await opened("many");
    await page.getByRole("button", { name: /Broken/ }).first().click();
    await page.getByRole("searchbox").fill("estimator_31)");
    await page.locator(".suite li .row").first().click();
    await page.locator(".detail").waitFor();
    const address = await page.evaluate(() => location.hash);
    await page.reload();
    const copy = await opened("many", { hash: address });
    for (const one of [page, copy]) {
      await one.locator(".detail").waitFor();
      assert.match(await chosen(one), /Broken/);
      assert.equal(await rows(one), 1);
      assert.match(await one.locator(".detail .sentence").innerText(), /estimator_31/);
      assert.equal(await one.getByRole("searchbox").inputValue(), "estimator_31)");
    }
    page.asked.length = 1;
    await closed(page);
    await closed(copy);
  },

  async "a link names a claim by its id and shows it"() {
    const id = "suite_3/mean(estimator_1503) == analytic";
    const page = await opened("many", { hash: "#" + new URLSearchParams({ open: id }) });
    const row = page.locator(`[id="${id}"]`);
    await row.locator(".detail figure svg").first().waitFor();
    await frame(page);
    const box = await row.boundingBox();
    assert.ok(box.y >= 0 && box.y < widths.wide[1], `the claim stands at ${box.y}`);
    await closed(page);
  },

  async "every part opens within the width, nothing of it is said on the console, hostile names run nothing"() {
    await parts_open("wide", "light");
    await parts_open("middle");
    await parts_open("phone", "dark");
  },

  async "a script of another text does not run"() {
    const page = await opened("example");
    await page.evaluate(() => {
      const script = document.createElement("script");
      script.textContent = "document.documentElement.dataset.ran = 'yes'";
      document.body.append(script);
    });
    assert.equal(await page.evaluate(() => document.documentElement.dataset.ran), undefined);
    assert.match(page.said.join(), /Content Security Policy/);
    await page.context().close();
  },

  async "without scripts the tables are shown"() {
    const page = await opened("example", { scripts: false });
    assert.match(await page.locator("body").innerText(), /\| verdict \| test \|/);
    await closed(page);
  },

  async "a planted ellipse is seen in Where, and the page is small"() {
    const bytes = statSync(resolve(pages, "ellipse.html")).size;
    assert.ok(bytes < 4e6, `${bytes} bytes`);
    const page = await opened("ellipse");
    await frame(page);
    const seen = await colour(page, [610, 284, 60, 32]);
    console.log(`    ${bytes} bytes; colour inside over outside: ${(seen.inside / seen.outside).toFixed(1)}`);
    assert.ok(seen.inside > 3 * seen.outside, JSON.stringify(seen));
    assert.match(await plain(page.locator(".card .sentence")), /^x 600-680, y 276-324 of G is 5 % too bright/);
    const canvas = page.locator(".card canvas");
    // Windows are cut at the left edge as at the right one: its columns have sums of their own.
    const columns = await canvas.first().evaluate((shown) => {
      const copy = document.createElement("canvas");
      Object.assign(copy, { width: shown.width, height: shown.height });
      const context = copy.getContext("2d", { willReadFrequently: true });
      context.drawImage(shown, 0, 0);
      return [0, 10].map((x) => context.getImageData(x, 0, 1, shown.height).data.join());
    });
    assert.notEqual(columns[0], columns[1]);
    await canvas.hover({ position: { x: 50, y: 50 } });
    assert.match(await page.locator(".controls .code").innerText(), /^x \d+, y \d+ · .* standard errors · new .* · old /);
    await canvas.focus();
    for (const [key, name] of [["2", "How much"], ["3", "New"], ["4", "Old"], ["5", "Wipe"], ["1", "Where"]]) {
      await page.keyboard.press(key);
      await frame(page);
      assert.equal(await page.locator('.controls [aria-pressed="true"]').innerText(), name);
    }
    await page.keyboard.press("2");
    await frame(page);
    const much = await colour(page, [610, 284, 60, 32]);
    assert.ok(much.inside > 3 * much.outside, JSON.stringify(much));
    await closed(page);
  },

  async "controls stand beside their picture, on a phone below it"() {
    for (const size of Object.keys(widths)) {
      const page = await opened("example", { size });
      const [picture, controls] = await Promise.all([".card .picture", ".card .controls"].map((part) => page.locator(part).first().boundingBox()));
      const between = size === "phone" ? controls.y - picture.y - picture.height : controls.x - picture.x - picture.width;
      assert.ok(between >= 8 && between <= 24, `${between} pixels lie between at ${widths[size][0]}`);
      await closed(page);
    }
  },

  async "a map of differences has the page's own colour where nothing differs, light and dark"() {
    for (const [scheme, least, most] of [["light", 0.8, 1], ["dark", 0, 0.3]]) {
      const page = await opened("ellipse", { scheme });
      await frame(page);
      for (const key of ["1", "2"]) {
        await page.locator(".card canvas").press(key);
        await frame(page);
        const shown = await brightness(page.locator(".card canvas"));
        assert.ok(shown >= least && shown <= most, `${scheme}, key ${key}: ${shown}`);
      }
      await closed(page);
    }
  },

  async "a single hot pixel is found by zooming to the finding"() {
    const page = await opened("hot");
    await frame(page);
    await page.getByRole("button", { name: "Zoom to finding" }).click();
    await frame(page);
    const found = await page.locator(".card canvas").evaluate((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let full = 0, x = 0, y = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (data[i] < 170 || data[i + 3] < 250) continue;
        full += 1;
        x += (i / 4) % canvas.width;
        y += Math.floor(i / 4 / canvas.width);
      }
      return { full, x: x / full / canvas.width, y: y / full / canvas.height };
    });
    assert.ok(found.full > 100, `the pixel covers ${found.full} pixels`);
    assert.ok(Math.abs(found.x - 0.5) < 0.1 && Math.abs(found.y - 0.5) < 0.1, JSON.stringify(found));
    await closed(page);
  },

  async "a comparison of images that holds has no finding to zoom to"() {
    const name = changed("hot", "holds", (record, judge) => {
      judge("pass", "holds");
      record.display.suspects = [];
    });
    const page = await opened(name);
    await page.locator(".suite li .row").click();
    await page.locator(".viewer canvas").waitFor();
    assert.equal(await page.getByRole("button", { name: "Zoom to finding" }).count(), 0);
    assert.equal(await page.locator(".frame").count(), 0);
    assert.doesNotMatch(await page.locator(".viewer canvas").getAttribute("aria-label"), /finding/);
    await page.locator(".viewer canvas").press("z");
    await closed(page);
  },

  async "a calibration shows its rates, its verdict and its tables"() {
    for (const [scheme, size] of [["light", "wide"], ["dark", "phone"]]) {
      const page = await opened("calibration", { scheme, size });
      const letters = await page.locator("figure svg text").first().boundingBox();
      assert.ok(letters.height > 10, `letters are ${letters.height} pixels high`);
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= widths[size][0]);
      assert.match(await page.locator("h1").innerText(), /Calibration: 1 of 4 cells/);
      assert.equal(await page.locator("figure svg").count(), 2);
      assert.match(await page.locator("pre.code").innerText(), /0\.15 of <means>/);
      assert.deepEqual(await violations(page), []);
      await closed(page);
    }
  },

  async "names of estimators that are alike do not overlap on the chart of cost against variance"() {
    const name = changed("example", "alike", ({ suites: [suite] }) => {
      const [model] = suite.estimators;
      model.channels[0].variance.value = 0.5;
      suite.estimators = Array.from({ length: 30 }, (_, i) => ({ ...model, name: `an_estimator_with_a_long_name_${i}` }));
    });
    for (const size of Object.keys(widths)) {
      const page = await opened(name, { size });
      await page.locator("summary", { hasText: "Estimators: triangle" }).first().click();
      const names = page.locator('svg[aria-label="Cost against variance"] text', { hasText: "an_" });
      await names.first().waitFor();
      const boxes = await names.evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON()));
      boxes.sort((a, b) => a.top - b.top);
      assert.equal(boxes.length, 30);
      boxes.forEach((box, i) => assert.ok(i === 0 || box.top >= boxes[i - 1].bottom - 1, JSON.stringify(boxes.slice(i - 1, i + 1))));
      assert.ok(boxes.every(({ right }) => right <= widths[size][0]), "names end within the page");
      await closed(page);
    }
  },

  async "print is dark on white, whatever the screen's scheme, and a sound run prints no list"() {
    const page = await opened("example", { scheme: "dark" });
    await page.emulateMedia({ media: "print" });
    const ink = await page.locator(".card .sentence").first().evaluate((one) => getComputedStyle(one).color);
    assert.equal(ink, "rgb(23, 25, 28)");
    const high = await page.locator(".card .picture").first().evaluate((one) => one.getBoundingClientRect().height);
    assert.ok(high <= 320, `the picture is ${high} pixels high`);
    await closed(page);
    const sound = changed("many", "sound", (record, judge) => {
      judge("pass", "holds");
      record.display.suspects = [];
    });
    const other = await opened(sound);
    await other.emulateMedia({ media: "print" });
    assert.ok(await other.locator("h1").isVisible());
    assert.equal(await other.locator("h2:visible, h3:visible").count(), 0);
    await closed(other);
  },

  async "print shows the summary and failures only"() {
    const page = await opened("example");
    await click_all(page, '.suite h3 button[aria-expanded="false"]');
    await page.emulateMedia({ media: "print" });
    assert.equal(await page.locator(".suite li.good:visible").count(), 0);
    assert.ok((await page.locator(".suite li.bad:visible").count()) > 0);
    assert.ok(await page.locator("h1").isVisible());
    assert.equal(await page.locator("nav:visible, input:visible").count(), 0);
    assert.ok((await page.locator(".suite li.open:visible").count()) > 0, "undecided claims are printed");
    if (screenshots) await page.screenshot({ path: join(screenshots, "print.png"), fullPage: true });
    await closed(page);
  },
};

if (screenshots) {
  mkdirSync(screenshots, { recursive: true });
  for (const name of ["example", "many", "ellipse"]) {
    for (const size of Object.keys(widths)) {
      for (const scheme of ["light", "dark"]) {
        const page = await opened(name, { size, scheme });
        await frame(page);
        await page.screenshot({ path: join(screenshots, `${name}-${size}-${scheme}.png`) });
        await closed(page);
      }
    }
  }
}
let failed = 0;
async function tried([name, run]) {
  try {
    await run();
    console.log(`ok   ${name}`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL ${name}\n${error.message}`);
  }
}
const queue = Object.entries({ times, views }[part]).values();
const worker = async () => {
  for (const test of queue) await tried(test);
};
await Promise.all(part === "times" ? [worker()] : [worker(), worker()]);
await browser.close();
process.exit(failed === 0 ? 0 : 1);
