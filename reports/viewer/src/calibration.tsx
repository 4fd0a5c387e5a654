// The results of `assay calibrate`: how often each method errs on each law, over alpha.
import { dot, ruleX } from "@observablehq/plot";
import { Chart } from "./charts";

interface Rate {
  count: number;
  runs: number;
  low: number;
  high: number;
}
export interface Calibration {
  calibration: {
    tolerance: number;
    cells: { method: string; question: string; law: string; alpha: number; mistaken: Rate; alone: Rate }[];
  };
  title: string;
  sound: boolean;
  text: string;
}

function Rates({ data, alpha }: { data: Calibration["calibration"]; alpha: number }) {
  const points = data.cells
    .filter((cell) => cell.alpha === alpha && cell.mistaken.runs > 0)
    .map(({ method, question, law, mistaken }) => ({
      place: `${method}, ${question}: ${law}`,
      value: mistaken.count / mistaken.runs / alpha,
      low: mistaken.low / alpha,
      high: Math.min(mistaken.high / alpha, 4),
      bad: mistaken.low > data.tolerance * alpha,
    }));
  if (points.length === 0) return null;
  const places = points.map((point) => point.place);
  return (
    <Chart
      label={`Rates of mistakes at alpha ${alpha}`}
      caption={`Mistakes of the whole procedure over alpha ${alpha}, with exact limits. Dashed: what is tolerated.`}
      options={{
        width: 900,
        height: 40 + 16 * points.length,
        marginLeft: 430,
        x: { label: null, domain: [0, 4], clamp: true },
        y: { label: null, domain: places },
        marks: [
          ruleX([1], { stroke: "var(--muted)" }),
          ruleX([data.tolerance], { stroke: "var(--muted)", strokeDasharray: "5 3" }),
          dot(points, { x: "low", y: "place", symbol: "times", r: 2.5, stroke: "var(--muted)" }),
          dot(points, { x: "high", y: "place", symbol: "times", r: 2.5, stroke: "var(--muted)" }),
          dot(points, { x: "value", y: "place", fill: (point) => (point.bad ? "var(--bad)" : "var(--mark)"), r: 3.5 }),
        ],
      }}
    />
  );
}

export function CalibrationPage({ calibration: data, title, sound, text }: Calibration) {
  const alphas = [...new Set(data.cells.map((cell) => cell.alpha))];
  return (
    <>
      <header>
        <h1 class={sound ? "good" : "bad"}>
          {sound ? "✓" : "✗"} Calibration: {title}
        </h1>
      </header>
      <main>
        {alphas.map((alpha) => (
          <section key={alpha} aria-label={`alpha ${alpha}`}>
            <h2>alpha {alpha}</h2>
            <div class="scroll" tabIndex={0} role="region" aria-label={`Rates at alpha ${alpha}`}>
              <Rates data={data} alpha={alpha} />
            </div>
          </section>
        ))}
        <h2>Numbers</h2>
        <div class="scroll" tabIndex={0} role="region" aria-label="Numbers">
          <pre class="code">{text}</pre>
        </div>
      </main>
    </>
  );
}
