// Makes the picture of the README from a real run, whose bug has a place.
//   node tests/viewer/screenshot.mjs build/harness/assay reports/viewer "$(command -v chromium)" reports/finding.png
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

const [assay, viewer, chromium_path, picture] = process.argv.slice(2);
const { chromium } = createRequire(join(resolve(viewer), "package.json"))("playwright-core");
const folder = mkdtempSync(join(tmpdir(), "assay-"));
const report = join(folder, "report.html");
const light = "{polygon: [[-.5, -.5, 1.5], [.5, -.5, 1.5], [.5, .5, 1.5], [-.5, .5, 1.5]], radiance: 1}";
const stool = "{polygon: [[-.4, -.4, .6], [.5, -.3, .6], [.1, .5, .6]]}";
const scene = `scene={receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: ${light}, occluders: [${stool}]}`;
const size = "width=96,height=64,primaries=64";
const run = spawnSync(assay, [
  "check", "mean(new) == mean(old)", "--quiet", "--report", `html=${report}`, "console=/dev/null",
  "--estimator", `new=mutants/floor_tile,${size},${scene}`, "--estimator", `old=luminaire/floor,${size},${scene}`,
]);
if (run.status !== 1) throw new Error(`the run ended with ${run.status}: ${run.stderr}`);
const browser = await chromium.launch({ executablePath: chromium_path, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 900, height: 660 }, colorScheme: "light" });
await page.goto(`file://${report}`);
await page.waitForFunction(() => document.documentElement.dataset.ready === "yes");
await page.screenshot({ path: picture });
await browser.close();
rmSync(folder, { recursive: true });
