import { render } from "preact";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { CalibrationPage, type Calibration } from "./calibration";
import { WhatBroke, WhatIsUndecided } from "./cards";
import { Claims } from "./claims";
import { PageContext } from "./page";
import { unpack, type Page, type Standing } from "./record";
import { useAddress, type Choice } from "./state";
import { Estimators, Fold, KillMatrix, Statements } from "./suites";

const chips: { choice: Choice; mark: string; words: string; style: string }[] = [
  { choice: "all", mark: "", words: "All", style: "" },
  { choice: "broken", mark: "✗ ", words: "Broken", style: "bad" },
  { choice: "no verdict", mark: "✗ ", words: "Without a verdict", style: "bad" },
  { choice: "undecided", mark: "? ", words: "Undecided", style: "open" },
  { choice: "holds", mark: "✓ ", words: "Hold", style: "good" },
  { choice: "caught", mark: "✓ ", words: "Planted bugs caught", style: "good" },
  { choice: "not run", mark: "– ", words: "Not run", style: "muted" },
];

function useCounts(page: Page) {
  return useMemo(() => {
    const tests = page.record.suites.flatMap((suite) => suite.tests);
    const counts = new Map<Choice, number>([["all", tests.length]]);
    for (const test of tests) {
      const standing: Standing = test.display.standing;
      counts.set(standing, (counts.get(standing) ?? 0) + 1);
    }
    return counts;
  }, [page]);
}

function App({ page }: { page: Page }) {
  const { record } = page;
  const [state, change] = useAddress();
  const search = useRef<HTMLInputElement>(null);
  const counts = useCounts(page);
  const broken = counts.has("broken") || counts.has("no verdict") || record.ledger.series.some((series) => series.alarm);
  const open = !broken && (counts.has("undecided") || page.test.size === 0);
  const style = broken ? "bad" : open ? "open" : "good";
  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      if (event.key !== "/" || event.ctrlKey || event.metaKey || event.target instanceof HTMLInputElement) return;
      event.preventDefault();
      search.current?.focus();
    };
    addEventListener("keydown", key);
    return () => removeEventListener("keydown", key);
  }, []);
  // A link to a claim shows it.
  useEffect(() => {
    const show = () => {
      const ids = new URLSearchParams(location.hash.slice(1)).getAll("open");
      const id = ids[ids.length - 1];
      if (id) requestAnimationFrame(() => document.getElementById(id)?.scrollIntoView({ block: "start" }));
    };
    show();
    addEventListener("hashchange", show);
    return () => removeEventListener("hashchange", show);
  }, []);
  const environment = record.environment;
  const retries = record.suites.reduce((sum, suite) => sum + suite.retries.length, 0);
  return (
    <PageContext.Provider value={page}>
      <header>
        <div class="top">
          <h1 class={style}>
            {broken ? "✗" : open ? "?" : "✓"} {record.display.verdict}
          </h1>
          <nav aria-label="Filter">
            {chips
              .filter(({ choice }) => choice === state.show || counts.has(choice))
              .map(({ choice, mark, words, style }) => (
                <button key={choice} type="button" class={`chip ${style}`} aria-pressed={state.show === choice} onClick={() => change({ show: choice })}>
                  {mark}
                  {words} <b>{counts.get(choice) ?? 0}</b>
                </button>
              ))}
          </nav>
          <input
            ref={search}
            type="search"
            placeholder="Search claims, estimators, tags   /"
            aria-label="Search claims, estimators, tags"
            value={state.find}
            onInput={(event) => change({ find: event.currentTarget.value })}
          />
        </div>
        <p class="quiet about">
          seed <b>{record.display.seed}</b> · commit <b>{record.tool.commit || "unknown"}</b> · {record.seconds.toPrecision(3)} s · {record.display.rates.split(/\.(?: |$)/)[0]}
          {record.note && ` · ${record.note}`}
        </p>
      </header>
      <main>
        {state.show === "all" && state.find === "" && (
          <>
            <WhatBroke />
            <WhatIsUndecided />
          </>
        )}
        <Claims suites={record.suites} state={state} change={change} />
        <section aria-label="More" class="more-sections">
          {record.suites.map((suite) => (
            <KillMatrix key={`${suite.name} ${suite.file}`} suite={suite} />
          ))}
          {record.suites.map((suite) => (
            <Estimators key={`${suite.name} ${suite.file}`} suite={suite} />
          ))}
          {record.ledger.file && (
            <Fold title={record.display.ledger}>
              {() => (
                <>
                  <p>{record.display.quiet}</p>
                  <ul>
                    {record.display.notes.map((note) => (
                      <li key={note}>{note}</li>
                    ))}
                  </ul>
                </>
              )}
            </Fold>
          )}
          <Statements />
          <Fold title="About this run">
            {() => (
              <>
                <p>{record.display.counts}.</p>
                <p>{record.display.rates}</p>
                {retries > 0 && <p>Programs that failed and were started again: {retries}.</p>}
                <ul>
                  {record.suites.map((suite) => (
                    <li key={`${suite.name} ${suite.file}`}>
                      {suite.name}{suite.file && ` (${suite.file})`}: {suite.display.levels}. {suite.about}
                    </li>
                  ))}
                </ul>
                <p>
                  {record.tool.name} {record.tool.version}, {record.started}, {environment.threads} {environment.threads === 1 ? "thread" : "threads"} of {environment.cpu}, {environment.isa}, {environment.compiler}
                </p>
              </>
            )}
          </Fold>
        </section>
      </main>
    </PageContext.Provider>
  );
}

const place = document.getElementById("app")!;
const data = document.getElementById("record")!;
unpack<Calibration>(data.textContent.trim()).then(
  (page) => {
    data.remove();
    render("record" in page ? <App page={page} /> : <CalibrationPage {...page} />, place);
    performance.mark("ready");
    document.documentElement.dataset.ready = "yes";
  },
  (error) => {
    place.textContent = `This page cannot be read: ${String(error)}. A newer browser may help.`;
  },
);
