// Cards show what broke: a card a suspect, and a card a ledger's alarm. Undecided claims have cards of their own.
import { useContext } from "preact/hooks";
import { NightsChart } from "./charts";
import { Advice, Copy, Steps, Told } from "./claims";
import { ImageViewer } from "./image";
import { PageContext } from "./page";
import type { Suspect, Test } from "./record";
import { link } from "./state";
import { Fold } from "./suites";

const most = 12; // cards; the list of claims has the rest

function Card({ suspect }: { suspect: Suspect }) {
  const page = useContext(PageContext);
  const tests = suspect.tests.flatMap((id) => page.test.get(id) ?? []);
  const first: Test | undefined = tests.find((test) => test.image) ?? tests[0];
  if (!first) return null;
  const others = tests.filter((test) => test !== first);
  return (
    <article class="card">
      <h3>
        {suspect.name}{" "}
        <span class="quiet">
          {suspect.sentence && `${suspect.sentence} · `}
          <a href={link({ open: [first.id] })}>Details</a>
        </span>
      </h3>
      <Told test={first} />
      {first.image && <ImageViewer test={first} pictures={page.pictures.get(first.id) ?? []} />}
      {others.length > 0 && (
        <p class="quiet">
          Also:{" "}
          {others.slice(0, 8).map((test, i) => (
            <span key={test.id}>
              {i > 0 && ", "}
              <a href={link({ open: [test.id] })}>{test.name}</a>
            </span>
          ))}
          {others.length > 8 && ` and ${others.length - 8} more`}
        </p>
      )}
      <Steps test={first} />
      {others.slice(0, 8).flatMap((test) =>
        test.display.steps.filter(({ label, words }) => words && label !== "again").map(({ label, words }) => (
          <Advice key={`${test.id} ${words}`} label={label} words={`${test.name}: ${words}`} />
        )),
      )}
    </article>
  );
}

export function WhatBroke() {
  const { record } = useContext(PageContext);
  const { suspects } = record.display;
  const alarms = record.ledger.series.flatMap((series, i) => (series.alarm ? [{ series, words: record.display.series[i] }] : []));
  if (suspects.length === 0 && alarms.length === 0) return null;
  const of = (broken: boolean) => suspects.filter(({ standing }) => (standing === "broken") === broken).slice(0, most);
  const shown = [...of(true), ...of(false)];
  return (
    <section aria-label="What broke">
      <h2>{alarms.length > 0 || suspects.some(({ standing }) => standing === "broken") ? "What broke" : "What has no verdict"}</h2>
      {shown.map((suspect) => (
        <Card key={`${suspect.suite} ${suspect.name} ${suspect.standing}`} suspect={suspect} />
      ))}
      {suspects.length > shown.length && (
        <p>
          <a href={link({})}>{suspects.length - shown.length} more suspects are in the list of claims.</a>
        </p>
      )}
      {alarms.map(({ series, words }) => (
        <article class="card" key={words?.name}>
          <h3>
            {words?.name} <span class="quiet">drifted</span>
          </h3>
          <p class="sentence">{words?.alarm}</p>
          <NightsChart series={series} />
          <Copy label="what changed" command={words?.changes ?? ""} />
          <Fold title="Statistics">{() => <p class="quiet">{words?.sentence}</p>}</Fold>
        </article>
      ))}
    </section>
  );
}

/// A card an undecided claim: what it came to, and what would decide it.
export function WhatIsUndecided() {
  const { record } = useContext(PageContext);
  const undecided = record.suites.flatMap((suite) => suite.tests.filter((test) => test.display.standing === "undecided"));
  if (undecided.length === 0) return null;
  return (
    <section aria-label="What is undecided">
      <h2>What is undecided</h2>
      {undecided.slice(0, most).map((test, i) => (
        <article class="card undecided" key={`${i} ${test.id}`}>
          <h3>
            {test.name}{" "}
            <span class="quiet">
              <a href={link({ open: [test.id] })}>Details</a>
            </span>
          </h3>
          <Told test={test} />
          <Steps test={test} />
        </article>
      ))}
      {undecided.length > most && (
        <p>
          <a href={link({ show: "undecided" })}>{undecided.length - most} more are in the list of undecided claims.</a>
        </p>
      )}
    </section>
  );
}
