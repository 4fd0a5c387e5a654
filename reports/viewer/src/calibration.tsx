// The results of `assay calibrate`: how often each method errs on each law, over alpha.
import { dot, ruleX, ruleY } from "@observablehq/plot";
import { Chart } from "./charts";

interface Rate {
  count: number;
  runs: number;
  low: number;
  high: number;
}
interface Verdicts {
  pass: Rate;
  fail: Rate;
}
interface Cell {
  method: string;
  question: string;
  law: string;
  alpha: number;
  proof: boolean;
  holds: Verdicts;
  off: Verdicts;
}
/** A true claim that fails; of a proof, a claim off by `detect` that passes. */
const mistakes = (cell: Cell): Rate => (cell.proof ? cell.off.pass : cell.holds.fail);

export interface Calibration {
  calibration: {
    tolerance: number;
    cells: Cell[];
  };
  title: string;
  sound: boolean;
  text: string;
}

function Rates({ data, alpha }: { data: Calibration["calibration"]; alpha: number }) {
  const points = data.cells
    .filter((cell) => cell.alpha === alpha && mistakes(cell).runs > 0)
    .map((cell) => ({
      place: `${cell.method}, ${cell.question}: ${cell.law}`,
      value: mistakes(cell).count / mistakes(cell).runs / alpha,
      low: mistakes(cell).low / alpha,
      high: Math.min(mistakes(cell).high / alpha, 4),
      bad: mistakes(cell).low > data.tolerance * alpha,
    }));
  if (points.length === 0) return null;
  const places = points.map((point) => point.place);
  const column = Math.min(430, 20 + 6.5 * Math.max(...places.map((place) => place.length)));
  return (
    <Chart
      label={`Rates of mistakes at alpha ${alpha}`}
      caption={`How often each method errs, as a multiple of the promised rate, with its exact interval cut at 4. 1: as promised. Dashed: tolerated.`}
      options={{
        width: column + 470,
        height: 70 + 18 * points.length,
        marginLeft: column,
        x: { label: "rate of mistakes, over the promised one", domain: [0, 4], clamp: true },
        y: { label: null, domain: places },
        marks: [
          ruleX([1], { stroke: "var(--muted)" }),
          ruleX([data.tolerance], { stroke: "var(--muted)", strokeDasharray: "5 3" }),
          ruleY(points, { x1: "low", x2: "high", y: "place", stroke: (point) => (point.bad ? "var(--bad)" : "var(--mark)") }),
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
            <h2>
              Promised: at most {Number((100 * alpha).toPrecision(3))} {alpha === 0.01 ? "mistake" : "mistakes"} in 100
            </h2>
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
