// The list of all claims: suites, rows, and what a row opens to.
import { Fragment } from "preact";
import { useContext, useState } from "preact/hooks";
import { Axis, Bar, hasBar } from "./bar";
import { HistogramChart, LawsChart, LooksChart, QuantileChart } from "./charts";
import { CellMap, ImageViewer } from "./image";
import { PageContext } from "./page";
import { finite, type Standing, type Suite, type Test } from "./record";
import { link, matches, type State } from "./state";

export const words: { [standing in Standing]: { mark: string; one: string; style: string } } = {
  broken: { mark: "✗", one: "Broken", style: "bad" },
  "no verdict": { mark: "✗", one: "No verdict", style: "bad" },
  undecided: { mark: "?", one: "Undecided", style: "open" },
  holds: { mark: "✓", one: "Holds", style: "good" },
  caught: { mark: "✓", one: "Caught", style: "good" },
  "not run": { mark: "–", one: "Not run", style: "muted" },
};
const at_a_time = 100;

export function Copy({ command, label = "" }: { command: string; label?: string }) {
  const [done, setDone] = useState(false);
  if (command === "") return null;
  const copy = async () => {
    await navigator.clipboard.writeText(command);
    setDone(true);
    setTimeout(() => setDone(false), 2000);
  };
  return (
    <div class="command">
      {label && <span class="quiet">{label}</span>}
      <code title={command}>
        {command.split(" ").map((word, i) => (
          <Fragment key={i}>
            {i > 0 && " "}
            <span class="word">{word}</span>
          </Fragment>
        ))}
      </code>
      <button type="button" onClick={copy}>
        {done ? "Copied" : "Copy"}
      </button>
    </div>
  );
}

export function Advice({ label, words }: { label: string; words: string }) {
  return (
    <div class="command">
      <span class="quiet">{label}</span>
      <span>{words}</span>
    </div>
  );
}

/// What to do about a claim: words or a line to paste each.
export function Steps({ test }: { test: Test }) {
  const steps = test.display.steps.filter(({ label }) => label !== "see it"); // this page shows it
  return (
    <>
      {steps.map(({ label, words, paste }) =>
        paste ? (
          <Copy key={paste} label={label} command={paste} />
        ) : (
          <Advice key={words} label={label} words={words} />
        ),
      )}
    </>
  );
}

/// Why a claim has no verdict: what that means, the reason, and what the checks measured.
export function NoVerdict({ test }: { test: Test }) {
  const violated = test.gates.filter((gate) => gate.state === "red");
  return (
    <dl class="reason">
      <div>
        <dt>No verdict</dt>
        <dd>{test.display.meaning}</dd>
      </div>
      <div>
        <dt>Reason</dt>
        <dd class="sentence">{test.display.sentence}</dd>
      </div>
      {violated.length > 0 && (
        <div>
          <dt>Measured</dt>
          <dd>
            {violated.map((gate, i) => (
              <span key={i} class="measured">{gate.name} <b>{number(finite(gate.value))}</b>, limit {number(finite(gate.limit))}</span>
            ))}
          </dd>
        </div>
      )}
    </dl>
  );
}

/// What a claim came to, with what the console says beside its verdict.
export function Told({ test }: { test: Test }) {
  const { sentence, standing, steps, verdict } = test.display;
  if (standing === "no verdict") return <NoVerdict test={test} />;
  // The sentence has all of a fail. Words that are a step of their own are not repeated.
  const more = test.verdict === "fail" ? "" : steps.reduce((text, { words }) => (words ? text.replace(`; ${words}`, "") : text), test.message);
  return (
    <>
      <p class="sentence">
        {standing === "broken" && test.verdict !== "fail" && <b>{verdict}: </b>}
        {sentence}
      </p>
      {more && <p>{more}</p>}
    </>
  );
}

function number(value: number | null) {
  return value === null ? "n/a" : String(Number(value.toPrecision(4)));
}

function Statistics({ test }: { test: Test }) {
  return (
    <div class="statistics">
      <dl>
        {test.display.facts.map(({ label, text }) => (
          <div key={label}>
            <dt>{label}</dt>
            <dd>{text}</dd>
          </div>
        ))}
      </dl>
      {test.gates.length > 0 && (
        <table>
          <caption>Assumptions</caption>
          <thead>
            <tr>
              <th scope="col">what</th>
              <th scope="col">value</th>
              <th scope="col">limit</th>
              <th scope="col">state</th>
            </tr>
          </thead>
          <tbody>
            {test.gates.map((gate, i) => (
              <tr key={i}>
                <td>{gate.name}</td>
                <td>{number(finite(gate.value))}</td>
                <td>{number(finite(gate.limit))}</td>
                <td>{gate.state === "green" ? "✓ holds" : gate.state === "amber" ? "? allowed for" : "✗ violated"}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </div>
  );
}

function Gates({ test }: { test: Test }) {
  if (test.gates.length === 0) return null;
  const bad = test.gates.filter((gate) => gate.state === "red").length;
  const amber = test.gates.filter((gate) => gate.state === "amber").length;
  const count = test.gates.length === 1 ? "The assumption check" : `All ${test.gates.length} assumption checks`;
  if (bad > 0) return <span>✗ {bad} of {test.gates.length} assumptions are violated.</span>;
  if (amber > 0) return <span>? {amber} of {test.gates.length} assumptions do not hold by themselves; the method allows for it.</span>;
  return <span>✓ {count} hold{test.gates.length === 1 ? "s" : ""}.</span>;
}

export function Detail({ test }: { test: Test }) {
  const page = useContext(PageContext);
  const [statistics, setStatistics] = useState(false);
  const notGreen = test.gates.some((gate) => gate.state !== "green");
  const [quantiles, setQuantiles] = useState(notGreen);
  const pictures = page.pictures.get(test.id) ?? [];
  const channel = test.channels[0];
  const samples = test.samples.filter((sample) => !channel || sample.channel === channel.name || test.samples.length <= 2);
  const { chance } = test.display;
  return (
    <div class="detail">
      <Told test={test} />
      {chance && test.verdict !== "pass" && <p class="quiet">Chance of this if nothing is wrong: {chance}.</p>}
      <Steps test={test} />
      {test.image && <ImageViewer test={test} pictures={pictures} />}
      <div class="charts">
        {pictures.filter((picture) => picture.about.name.startsWith("cells")).map((picture) => (
          <CellMap key={picture.about.name} picture={picture} />
        ))}
        {samples.slice(0, 4).map((sample, i) => (
          <HistogramChart key={i} sample={sample} channel={channel} />
        ))}
        <LooksChart test={test} />
        {channel && <LawsChart channel={channel} />}
        {quantiles && samples.slice(0, 4).map((sample, i) => <QuantileChart key={i} sample={sample} />)}
      </div>
      <p class="tools">
        <Gates test={test} />
        <button type="button" aria-expanded={statistics} onClick={() => setStatistics(!statistics)}>
          Statistics
        </button>
        {!quantiles && samples.some((sample) => sample.quantiles.length > 0) && (
          <button type="button" onClick={() => setQuantiles(true)}>
            Quantile plots
          </button>
        )}
        <a href={link({ open: [test.id] })}>Link to this claim</a>
        {test.display.place && <span class="quiet">{test.display.place}</span>}
      </p>
      {statistics && <Statistics test={test} />}
    </div>
  );
}

interface RowProps {
  test: Test;
  open: boolean;
  toggle: (id: string) => void;
}

function Row({ test, open, toggle }: RowProps) {
  const { mark, one, style } = words[test.display.standing];
  const { effect, interval, verdict } = test.display;
  return (
    <li id={test.id} class={style}>
      <button type="button" class="row" aria-expanded={open} onClick={() => toggle(test.id)}>
        <span class="standing">{mark} {one}</span>
        <span class="claim">{test.name}</span>
        <span class="effect">{effect ? <><b>{effect}</b> {interval}</> : verdict}</span>
        <Bar test={test} />
      </button>
      {open && <Detail test={test} />}
    </li>
  );
}

const order: { [standing in Standing]: number } = { broken: 0, "no verdict": 1, undecided: 2, "not run": 3, holds: 4, caught: 5 };

interface SuiteProps {
  suite: Suite;
  state: State;
  toggle: (id: string) => void;
  few: boolean;
}

function SuiteClaims({ suite, state, toggle, few }: SuiteProps) {
  const [folded, setFolded] = useState<boolean | null>(null);
  const [shown, setShown] = useState(at_a_time);
  const chosen = suite.tests.filter((test) => matches(test, state)).sort((a, b) => order[a.display.standing] - order[b.display.standing]);
  if (chosen.length === 0) return null;
  const narrowed = state.show !== "all" || state.find !== "";
  const opened = new Set(state.open);
  const urgent = chosen.filter((test) => order[test.display.standing] < 3 || opened.has(test.id));
  const isFolded = folded ?? !(narrowed || few);
  const rows = isFolded ? urgent : chosen;
  const visible = rows.slice(0, shown);
  return (
    <section class="suite" aria-label={suite.name}>
      <h3>
        <button type="button" aria-expanded={!isFolded} onClick={() => setFolded(!isFolded)}>
          <span aria-hidden="true">{isFolded ? "▸" : "▾"}</span> {suite.name} <span class="quiet">{suite.display.counts}</span>
        </button>
      </h3>
      <ul>
        {visible.map((test, i) => (
          <Row key={`${i} ${test.id}`} test={test} open={opened.has(test.id)} toggle={toggle} />
        ))}
      </ul>
      {visible.length < rows.length && (
        <button type="button" class="more" onClick={() => setShown(shown + at_a_time)}>
          {rows.length - visible.length} more
        </button>
      )}
    </section>
  );
}

export function Claims({ suites, state, change }: { suites: Suite[]; state: State; change: (part: Partial<State>) => void }) {
  const toggle = (id: string) =>
    change({ open: state.open.includes(id) ? state.open.filter((other) => other !== id) : [...state.open, id] });
  const few = suites.reduce((sum, suite) => sum + suite.tests.length, 0) <= at_a_time;
  const caught = suites.some((suite) => suite.tests.some(hasBar));
  const none = suites.every((suite) => suite.tests.every((test) => !matches(test, state)));
  return (
    <section class="claims" aria-label="All claims">
      <h2>All claims</h2>
      <div class="row head" aria-hidden="true">
        <span>result</span>
        <span>claim</span>
        <span>measured, plausible range</span>
        <span>{caught && <>1: the error that must be caught<Axis /></>}</span>
      </div>
      {suites.map((suite) => (
        <SuiteClaims key={`${suite.name} ${suite.file} ${state.show}`} suite={suite} state={state} toggle={toggle} few={few} />
      ))}
      {none && (
        <p>
          No claim is like that.{" "}
          <button type="button" onClick={() => change({ show: "all", find: "" })}>Show all</button>
        </p>
      )}
    </section>
  );
}
