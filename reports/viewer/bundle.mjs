// Bundles the viewer into bundle/page.html: `npm run bundle`. With --check it compares instead.
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import esbuild from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

async function bundled(entry) {
  const result = await esbuild.build({
    absWorkingDir: here,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    charset: "ascii",
    format: "iife",
    target: "es2022",
    jsx: "automatic",
    jsxImportSource: "preact",
    legalComments: "none",
    outdir: "out",
  });
  return { text: result.outputFiles[0].text.trim(), inputs: Object.keys(result.metafile.inputs) };
}

const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

/// The names and licences of the packages whose files are in the bundle.
function licences(inputs) {
  const names = new Set();
  for (const input of inputs) {
    const found = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input);
    if (found) names.add(found[1]);
  }
  let text = "Packages in page.html, with their licences.\n";
  for (const name of [...names].sort()) {
    const folder = join(here, "node_modules", name);
    const about = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    text += `\n---- ${name} ${about.version} (${about.license})\n\n`;
    text += file ? readFileSync(join(folder, file), "utf8").trim() + "\n" : "No licence file.\n";
  }
  return text;
}

const script = await bundled("src/main.tsx");
const style = await bundled("src/style.css");
const policy = [
  "default-src 'none'",
  `script-src ${hash(script.text)}`,
  `style-src ${hash(style.text)}`,
  "img-src data:",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");
const page = `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{{title}}</title>
<style>${style.text}</style>
</head>
<body>
<div id="app"></div>
<noscript><pre>{{markdown}}</pre></noscript>
<script type="text/plain" id="record">{{record}}</script>
<script>${script.text}</script>
</body>
</html>
`;
const files = { "page.html": page, "licences.txt": licences(script.inputs) };
let same = true;
mkdirSync(join(here, "bundle"), { recursive: true });
for (const [name, text] of Object.entries(files)) {
  const path = join(here, "bundle", name);
  if (!process.argv.includes("--check")) {
    writeFileSync(path, text);
  } else if (!existsSync(path) || readFileSync(path, "utf8") !== text) {
    console.error(`${path} is not what the sources give: run \`npm run bundle\` in reports/viewer`);
    same = false;
  }
}
console.log(`page.html: ${page.length} bytes`);
process.exit(same ? 0 : 1);
