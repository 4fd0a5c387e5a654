#include "reports/viewer/html_parts.h"

namespace assay::reports {

// Colours are set once for light and once for dark; print is always light. Every distinction made
// by colour is made by a word or a shape too. Without "<" and "&": the page is well-formed XML.
const char* const page_style = R"css(
:root { color-scheme: light dark;
  --paper: #ffffff; --panel: #f6f7f9; --ink: #1b1f24; --muted: #59636e; --grid: #dfe3e8; --edge: #c5ccd3;
  --mean: #c8362e; --variance: #2f6fb7; --link: #0b5cad; --ok: #1a7f37; --bad: #b42318; --open: #8a5a00;
  --differ: #f6c9c4; --smaller: #c3dbf5; --larger: #f5e3b8; --agree: #eef1f4; --band: #d8eadc; --code: #eef1f4; }
@media (prefers-color-scheme: dark) { :root {
  --paper: #14171b; --panel: #1c2127; --ink: #e6e9ed; --muted: #9ba6b2; --grid: #2d343c; --edge: #46505b;
  --mean: #f0776c; --variance: #69aaf0; --link: #7db8ff; --ok: #56c271; --bad: #ff8a7d; --open: #e3b341;
  --differ: #6b2b26; --smaller: #21456b; --larger: #5c4a1b; --agree: #262c33; --band: #1f3b28; --code: #262c33; } }
@media print { :root { color-scheme: light;
  --paper: #ffffff; --panel: #ffffff; --ink: #000000; --muted: #444444; --grid: #dddddd; --edge: #aaaaaa;
  --mean: #c8362e; --variance: #2f6fb7; --link: #000000; --ok: #1a7f37; --bad: #b42318; --open: #8a5a00;
  --differ: #f6c9c4; --smaller: #c3dbf5; --larger: #f5e3b8; --agree: #f2f2f2; --band: #d8eadc; --code: #f2f2f2; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 24px 20px 60px; max-width: 1180px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 26px; line-height: 1.25; margin: 0 0 4px; }
h2 { font-size: 21px; margin: 44px 0 4px; padding-top: 14px; border-top: 2px solid var(--edge); overflow-wrap: anywhere; }
h3 { font-size: 16px; margin: 26px 0 6px; }
p { margin: 6px 0; max-width: 85ch; overflow-wrap: anywhere; }
a { color: var(--link); }
.muted, figcaption, th { color: var(--muted); }
.facts { display: flex; flex-wrap: wrap; gap: 2px 22px; color: var(--muted); font-size: 13px; margin: 6px 0 14px; }
.facts b { color: var(--ink); font-weight: 600; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 13px; margin: 10px 0; }
table.small { width: auto; max-width: 100%; }
th, td { text-align: left; vertical-align: top; padding: 5px 8px; border-bottom: 1px solid var(--grid); }
th { font-weight: 600; } th.group { padding-top: 16px; font-size: 14px; color: var(--ink); } tr.failed th.group { color: var(--bad); } tr.inconclusive th.group { color: var(--open); }
td { overflow-wrap: break-word; }
td.name { min-width: 180px; overflow-wrap: anywhere; }
td.number { white-space: nowrap; } td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
td .muted { font-size: 12px; } td > .chart { min-width: 130px; } .whole { white-space: nowrap; }
.badge { font-weight: 600; }
h2.first { margin-top: 16px; }
table.statements td { padding-top: 8px; } td .statement { font-size: 14px; } td.answer { min-width: 9em; width: 17%; }
ul.witnesses { margin: 0 0 4px; padding-left: 1.1em; } ul.witnesses li { overflow-wrap: anywhere; }
table.statements td.name { width: 36%; }
.passed .badge { color: var(--ok); } .failed .badge { color: var(--bad); }
.inconclusive .badge { color: var(--open); } .skipped .badge { color: var(--muted); }
h1.passed { color: var(--ok); } h1.failed { color: var(--bad); } h1.inconclusive { color: var(--open); }
.claim { color: var(--muted); font-family: ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; font-size: 12px; }
details.test { border: 1px solid var(--edge); border-left-width: 5px; border-radius: 6px; margin: 10px 0; background: var(--panel); }
details.test.passed { border-left-color: var(--ok); } details.test.failed { border-left-color: var(--bad); }
details.test.inconclusive { border-left-color: var(--open); }
details.test > summary { padding: 8px 12px; cursor: pointer; overflow-wrap: anywhere; }
details.test > summary .key { color: var(--muted); font-size: 13px; margin-left: 8px; }
details.test > div { padding: 0 14px 12px; }
details.more { margin: 10px 0; } details.more > summary { cursor: pointer; color: var(--link); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 3px 16px; margin: 6px 0 12px; font-size: 14px; }
dt { color: var(--muted); } dd { margin: 0; overflow-wrap: anywhere; white-space: pre-line; }
pre { background: var(--code); padding: 8px 12px; border-radius: 4px; margin: 8px 0; font-size: 12.5px;
  white-space: pre-wrap; overflow-wrap: anywhere; }
figure { margin: 12px 0; } figcaption { font-size: 13px; max-width: 90ch; }
.figures { display: flex; flex-wrap: wrap; gap: 4px 20px; align-items: flex-start; }
.figures figure { flex: 0 1 auto; max-width: 100%; }
.figures figcaption { contain: inline-size; }
.scroll > .chart { max-width: none; } .figures .scroll > .chart { max-width: 100%; }
@media print { .scroll > .chart { max-width: 100%; } }
.chart { display: block; max-width: 100%; height: auto; font: 11px ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
.chart text { fill: var(--muted); } .chart text.title { fill: var(--ink); } .chart text.over { fill: var(--ink); }
.chart text.mutant { font-style: italic; }
.chart .axis { stroke: var(--muted); stroke-width: 1; } .chart .grid { stroke: var(--grid); stroke-width: 1; }
.chart rect.mean { fill: var(--mean); } .chart rect.variance { fill: var(--variance); }
.chart .whisker { fill: none; stroke: var(--ink); stroke-width: 1.4; }
.chart .reference { stroke: var(--ink); stroke-width: 1.4; stroke-dasharray: 4 3; }
.chart image { image-rendering: pixelated; }
.chart .outline { fill: none; stroke: #ffffff; stroke-width: 4.5; } .chart .found { fill: none; stroke: #000000; stroke-width: 2; }
.chart .cell { fill: none; stroke: var(--edge); stroke-width: 1; } .chart .diagonal { fill: var(--edge); }
.chart .agree { fill: var(--agree); } .chart .differ { fill: var(--differ); } .chart .unclear { fill: var(--paper); }
.chart .smaller { fill: var(--smaller); } .chart .larger { fill: var(--larger); }
.chart .kill { fill: var(--variance); stroke: var(--edge); stroke-width: 1; } .chart .k0 { fill-opacity: .6; } .chart .k1 { fill-opacity: .47; }
.chart .k2 { fill-opacity: .36; } .chart .k3 { fill-opacity: .26; } .chart .k4 { fill-opacity: .17; } .chart .k5 { fill-opacity: .09; }
.chart .allowed { fill: var(--band); } .chart .zero { stroke: var(--ink); stroke-width: 1.2; }
.chart .detect { stroke: var(--mean); stroke-width: 1.6; stroke-dasharray: 6 3; }
.chart .interval { fill: none; stroke: var(--variance); stroke-width: 2; } .chart .estimate { fill: var(--variance); }
.chart .first { fill: var(--variance); fill-opacity: .45; stroke: var(--variance); stroke-width: 1; }
.chart .bandfirst { fill: var(--variance); fill-opacity: .2; stroke: none; } .chart .bandsecond { fill: var(--mean); fill-opacity: .2; stroke: none; }
.chart .curvefirst { fill: none; stroke: var(--variance); stroke-width: 1.4; } .chart .curvesecond { fill: none; stroke: var(--mean); stroke-width: 1.4; }
.chart .law { fill: none; stroke: var(--ink); stroke-width: 1.4; stroke-dasharray: 5 3; }
.chart .second { fill: none; stroke: var(--mean); stroke-width: 1.8; }
.chart .points { fill: none; stroke: var(--variance); stroke-width: 4; stroke-linecap: round; }
.chart .normal { stroke: var(--ink); stroke-width: 1.2; stroke-dasharray: 4 3; }
.red { color: var(--bad); font-weight: 600; } .amber { color: var(--open); font-weight: 600; } .green { color: var(--ok); }
.only-problems tr.passed, .only-problems details.passed, .only-problems tr.skipped, .only-problems details.skipped { display: none; }
@media screen and (max-width: 900px) {
  table.cards, table.small.cards { width: 100%; } table.cards thead { display: none; } table.cards tbody, table.cards tr, table.cards th.group { display: block; }
  table.cards tr { padding: 8px 0; border-bottom: 1px solid var(--edge); }
  table.cards td { display: grid; grid-template-columns: 11em minmax(0, 1fr); gap: 8px; border: 0; padding: 2px 0; text-align: left; overflow-wrap: anywhere; }
  table.cards td.empty { display: none; }
  table.cards td::before { content: attr(data-label); color: var(--muted); white-space: normal; } }
@media screen and (max-width: 480px) { table.cards td { grid-template-columns: 8em minmax(0, 1fr); } }
@media (max-width: 620px) { body { padding: 16px 12px 40px; } dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: 6px; } }
@media print { body { max-width: none; padding: 0; font-size: 11px; } .tools { display: none; }
  table, .facts, dl, figcaption, .key { font-size: 10px !important; } .claim, td .muted { font-size: 9px; } h2 { break-after: avoid; } h3 { break-after: avoid; }
  figure, tr, pre { break-inside: avoid; } .scroll { overflow: visible; }
  details::details-content { content-visibility: visible; display: block; height: auto; }
  .chart { -webkit-print-color-adjust: exact; print-color-adjust: exact; } }
)css";

const char* const page_script = R"js(
(function () {
  var tools = document.querySelector('.tools');
  var button = document.createElement('button');
  var only = false;
  function label() { button.textContent = only ? 'show all tests' : 'show only what is not ok'; }
  button.addEventListener('click', function () {
    only = !only; document.body.classList.toggle('only-problems', only); label();
  });
  label(); tools.appendChild(button);
  function open(target) { if (target) { target.open = true; } }
  function follow() { open(document.getElementById(location.hash.slice(1))); }
  window.addEventListener('hashchange', follow); follow();
  window.addEventListener('beforeprint', function () { document.querySelectorAll('details').forEach(open); });
})();
)js";

}  // namespace assay::reports
