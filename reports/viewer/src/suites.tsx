// A suite shows these beside its claims: planted bugs, estimators, statements of sources.
import { useState, useContext } from "preact/hooks";
import type { ComponentChildren } from "preact";
import { PlaneChart } from "./charts";
import { PageContext } from "./page";
import { finite, type Estimate, type Suite } from "./record";
import { link } from "./state";

/// A section whose inside is made when it is opened.
export function Fold({ title, children }: { title: string; children: () => ComponentChildren }) {
  const [open, setOpen] = useState(false);
  return (
    <details onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>{title}</summary>
      {open && children()}
    </details>
  );
}

export function KillMatrix({ suite }: { suite: Suite }) {
  const kills = suite.display.kills;
  if (!kills) return null;
  return (
    <Fold title={`Which method sees which planted bug: ${suite.name}`}>
      {() => (
        <>
          <p>{kills.totals}</p>
          <p class="quiet">{kills.legend}</p>
          <div class="scroll" tabIndex={0} role="region" aria-label={`Planted bugs of ${suite.name}`}>
            <table class="matrix">
              <thead>
                <tr>
                  <th scope="col">planted bug</th>
                  {kills.methods.map((method) => (
                    <th scope="col" key={method}>{method}</th>
                  ))}
                </tr>
              </thead>
              <tbody>
                {kills.rows.map((row) => (
                  <tr key={row.mutant}>
                    <th scope="row" title={row.defect}>{row.mutant}</th>
                    {row.cells.map((cell, i) => (
                      <td key={i} class={cell ? (cell.killed ? "killed" : "survived") : ""}>
                        {cell && (
                          <a href={link({ open: [cell.test] })} title={cell.sentence}>
                            {cell.killed ? "✓" : "·"} {cell.text}
                          </a>
                        )}
                      </td>
                    ))}
                  </tr>
                ))}
              </tbody>
            </table>
          </div>
        </>
      )}
    </Fold>
  );
}

function estimate({ value, low, high }: Estimate): string {
  const text = (number: number | null) => (number === null ? "n/a" : String(Number(number.toPrecision(5))));
  const ends = finite(low) === null || finite(high) === null ? "" : ` [${text(finite(low))}, ${text(finite(high))}]`;
  return text(finite(value)) + ends;
}

export function Estimators({ suite }: { suite: Suite }) {
  if (suite.estimators.length === 0) return null;
  return (
    <Fold title={`Estimators: ${suite.name}`}>
      {() => (
        <>
          <PlaneChart estimators={suite.estimators} />
          <div class="scroll" tabIndex={0} role="region" aria-label={`Estimators of ${suite.name}`}>
            <table>
              <thead>
                <tr>
                  {["estimator", "plugin", "channel", "mean", "variance", "reference"].map((head) => (
                    <th scope="col" key={head}>{head}</th>
                  ))}
                </tr>
              </thead>
              <tbody>
                {suite.estimators.flatMap((estimator) =>
                  estimator.channels.map((channel) => (
                    <tr key={`${estimator.name} ${channel.name}`}>
                      <th scope="row">{estimator.name}</th>
                      <td title={estimator.parameters}>{estimator.plugin}</td>
                      <td>{channel.name}</td>
                      <td>{estimate(channel.mean)}</td>
                      <td>{estimate(channel.variance)}</td>
                      <td>{finite(channel.reference) ?? ""}</td>
                    </tr>
                  )),
                )}
              </tbody>
            </table>
          </div>
        </>
      )}
    </Fold>
  );
}

export function Statements() {
  const { record } = useContext(PageContext);
  const count = record.suites.reduce((sum, suite) => sum + suite.statements.length, 0);
  if (count === 0) return null;
  return (
    <Fold title={`Statements of sources: ${count}`}>
      {() => (
        <ul class="statements">
          {record.suites.flatMap((suite) =>
            suite.statements.map((statement, i) => {
              const answer = suite.display.statements[i];
              return (
                <li key={`${suite.name} ${i}`}>
                  <b>{answer?.answer}</b> {statement.text} <span class="quiet">({statement.source})</span>
                  {answer?.holds && <p class="quiet">It holds: {answer.holds}</p>}
                  {answer?.fails && <p class="quiet">It does not: {answer.fails}</p>}
                </li>
              );
            }),
          )}
        </ul>
      )}
    </Fold>
  );
}
