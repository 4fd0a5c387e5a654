// Charts by Observable Plot, drawn when they are looked at.
import { areaY, dot, line, link, plot, rectY, ruleX, ruleY, text, type PlotOptions } from "@observablehq/plot";
import { useEffect, useRef } from "preact/hooks";
import { finite, type Channel, type Estimator, type Sample, type Series, type Test } from "./record";

const percent = (n: number) => `${Number((100 * n).toPrecision(3))} %`;
const short = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });

export function Chart({ options, label, caption }: { options: PlotOptions; label: string; caption: string }) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    // Letters keep their size on a phone; a chart with long names scrolls instead.
    const wanted = options.width ?? 340;
    const width = options.marginLeft ? wanted : Math.min(wanted, innerWidth - 70);
    const drawn = plot({
      height: 204,
      marginTop: 25,
      marginBottom: 40,
      marginLeft: 56,
      className: "plot",
      ariaLabel: label,
      ...options,
      width,
    });
    // The page's policy forbids Plot's own style element; style.css holds its rules.
    for (const style of drawn.querySelectorAll("style")) style.remove();
    drawn.setAttribute("role", "img");
    for (const part of drawn.querySelectorAll("[aria-label]")) part.removeAttribute("aria-label");
    place.current?.replaceChildren(drawn);
  }, [options]);
  return (
    <figure style={{ width: `${options.width ?? 340}px` }}>
      <div ref={place} />
      <figcaption>{caption}</figcaption>
    </figure>
  );
}

export function HistogramChart({ sample, channel }: { sample: Sample; channel: Channel | undefined }) {
  const { low, high, counts } = sample.histogram;
  const from = finite(low);
  const to = finite(high);
  if (from === null || to === null || counts.length === 0 || !(to > from)) return null;
  const step = (to - from) / counts.length;
  const bins = counts.map((count, i) => ({ x1: from + i * step, x2: from + (i + 1) * step, count }));
  const mean = finite(sample.mean);
  const reference = finite(channel?.reference);
  const caption =
    `${sample.estimator}: ${short.format(sample.secondaries)} observations. ` +
    `Solid: their mean.${reference === null ? "" : " Dashed: what is claimed."}`;
  return (
    <Chart
      label={`Histogram of ${sample.estimator}`}
      caption={caption}
      options={{
        x: { label: "value", ticks: 4 },
        y: { label: "observations", ticks: 3, tickFormat: (n: number) => short.format(n) },
        marks: [
          rectY(bins, { x1: "x1", x2: "x2", y: "count", fill: "var(--mark)", fillOpacity: 0.55, inset: 0.3 }),
          ruleY([0]),
          ...(mean === null ? [] : [ruleX([mean], { stroke: "var(--ink)", strokeWidth: 2 })]),
          ...(reference === null
            ? []
            : [ruleX([reference], { stroke: "var(--ink)", strokeWidth: 2, strokeDasharray: "5 3" })]),
        ],
      }}
    />
  );
}

export function LooksChart({ test }: { test: Test }) {
  const points = test.looks.flatMap((look) => {
    const value = finite(look.effect?.estimate);
    if (value === null) return [];
    const low = finite(look.effect?.low);
    const high = finite(look.effect?.high);
    return [{ count: look.secondaries, value, low: low ?? value, high: high ?? value }];
  });
  if (points.length < 2) return null;
  const unit = finite(test.detect);
  return (
    <Chart
      label="Estimate after each look"
      caption={`The estimate and its interval after each look, by observations.${unit ? " Band: what need not be caught." : ""}`}
      options={{
        x: { type: "log", label: "observations", ticks: 4, tickFormat: (n: number) => short.format(n) },
        y: {
          label: "estimate",
          ticks: 5,
          tickFormat: test.effect.relative ? percent : undefined,
        },
        marks: [
          ...(unit
            ? [areaY(points, { x: "count", y1: -unit, y2: unit, fill: "var(--good)", fillOpacity: 0.15, clip: true })]
            : []),
          ruleY([0], { stroke: "var(--muted)" }),
          ruleX(points, { x: "count", y1: "low", y2: "high", stroke: "var(--mark)", strokeWidth: 1.5 }),
          line(points, { x: "count", y: "value", stroke: "var(--mark)" }),
          dot(points, { x: "count", y: "value", fill: "var(--mark)", r: 3 }),
        ],
      }}
    />
  );
}

export function QuantileChart({ sample }: { sample: Sample }) {
  const points = sample.quantiles.flatMap(({ normal, observed }) => {
    const x = finite(normal);
    const y = finite(observed);
    return x === null || y === null ? [] : [{ x, y }];
  });
  if (points.length === 0) return null;
  return (
    <Chart
      label={`Quantiles of ${sample.estimator}`}
      caption={`${sample.estimator}: quantiles against those of a normal law. A straight line is normal.`}
      options={{
        x: { label: "standard deviations of a normal law" },
        y: { label: "observed value" },
        marks: [dot(points, { x: "x", y: "y", r: 2, fill: "var(--mark)" })],
      }}
    />
  );
}

export function LawsChart({ channel }: { channel: Channel }) {
  const sides = ["mark", "other"]; // both may be one estimator's
  const points = channel.laws.flatMap(({ points }, i) =>
    points.map((p) => ({
      side: sides[i],
      value: finite(p.value),
      observed: finite(p.observed),
      low: finite(p.low),
      high: finite(p.high),
      law: finite(p.law),
    })),
  );
  if (points.length === 0) return null;
  const claimed = points.filter((p) => p.law !== null);
  const [one, other] = channel.laws.map(({ source }) => source);
  const colours = other === undefined ? "" : ` Blue: ${one}. Orange: ${other}.`;
  return (
    <Chart
      label="Distribution functions"
      caption={`Part of the values up to x, with the band that holds the law.${colours}${claimed.length ? " Dashed: the claimed law." : ""}`}
      options={{
        x: { label: "x", ticks: 5 },
        y: { label: "part of the values", domain: [0, 1] },
        color: { domain: sides, range: ["var(--mark)", "var(--other)"] },
        marks: [
          areaY(points, { x: "value", y1: "low", y2: "high", fill: "side", fillOpacity: 0.2 }),
          line(points, { x: "value", y: "observed", stroke: "side" }),
          line(claimed, { x: "value", y: "law", stroke: "var(--ink)", strokeDasharray: "5 3" }),
        ],
      }}
    />
  );
}

export function NightsChart({ series }: { series: Series }) {
  const nights = series.nights.flatMap((night) => {
    const value = finite(night.estimate);
    if (value === null) return [];
    const date = new Date(night.date);
    const words = `${night.date}, commit ${night.commit}`;
    return [{ date, value, words, low: finite(night.low) ?? value, high: finite(night.high) ?? value, mean: finite(night.mean) }];
  });
  if (nights.length === 0) return null;
  const means = nights.filter((night) => night.mean !== null);
  const stayed = [series.moved, series.moved_from].includes(series.nights[0]!.date);
  const moved = series.moved && !stayed ? [new Date(series.moved)] : [];
  return (
    <Chart
      label={`Nights of ${series.test}`}
      caption={`A point a night with its interval: ${series.quantity || "the claim"}, claimed 0. Dashed: the mean of all nights so far.${moved.length ? ` Upright: the night it moved, commit ${series.moved_commit}.` : ""}`}
      options={{
        width: 900,
        height: 240,
        x: { type: "utc", label: null },
        y: { label: "estimate", tickFormat: series.relative ? percent : undefined },
        marks: [
          ruleY([0], { stroke: "var(--muted)" }),
          ruleX(moved, { stroke: "var(--bad)", strokeWidth: 2 }),
          line(means, { x: "date", y: "mean", stroke: "var(--ink)", strokeDasharray: "5 3" }),
          ruleX(nights, { x: "date", y1: "low", y2: "high", stroke: "var(--mark)" }),
          dot(nights, { x: "date", y: "value", fill: "var(--mark)", r: 3, title: "words" }),
        ],
      }}
    />
  );
}

/// The places moved apart along a line of this length, in their order, by at least the gap.
function apart(places: number[], gap: number, length: number): number[] {
  const order = places.map((_, i) => i).sort((a, b) => places[a]! - places[b]!);
  const moved = [...places];
  let least = 0;
  for (const i of order) least = (moved[i] = Math.max(moved[i]!, least)) + gap;
  let most = length;
  for (const i of order.reverse()) most = (moved[i] = Math.min(moved[i]!, most)) - gap;
  return moved;
}

/// Cost of a primary estimate against its variance. Lines join equal efficiency. The names stand in
/// a column at the right, where they have room.
export function PlaneChart({ estimators }: { estimators: Estimator[] }) {
  const points = estimators.flatMap(({ name, cost, primaries, secondaries, channels }) => {
    const rays = cost.camera_rays + cost.closest_hit_rays + cost.shadow_rays;
    const each = (rays || cost.samples) / (primaries * secondaries || 1);
    const variance = finite(channels[0]?.variance.value);
    return each > 0 && variance !== null && variance > 0 ? [{ name, each, variance }] : [];
  });
  if (points.length < 2) return null;
  const costs = points.map((p) => p.each);
  const variances = points.map((p) => p.variance);
  const ends: [number, number] = [Math.min(...costs) / 2, Math.max(...costs) * 2];
  const [low, high] = [Math.min(...variances) / 2, Math.max(...variances) * 2];
  const column = innerWidth < 640 ? 130 : 190;
  const gap = 14;
  const length = Math.max(260, gap * points.length);
  const logarithm = Math.log(high / low);
  const places = apart(points.map((p) => (length * Math.log(high / p.variance)) / logarithm), gap, length);
  const names = points.map((p, i) => ({ ...p, edge: ends[1], at: high * Math.exp((-logarithm * places[i]!) / length) }));
  const lines = points.flatMap((p, z) => ends.map((x) => ({ z, x, y: (p.each * p.variance) / x })));
  return (
    <Chart
      label="Cost against variance"
      caption="Cost of a primary estimate (across) against its variance. Lines of equal efficiency: further down is better."
      options={{
        width: 720,
        height: length + 65,
        marginRight: column,
        x: { type: "log", label: "cost", labelAnchor: "center", domain: ends, ticks: 4, tickFormat: (n: number) => short.format(n) },
        y: { type: "log", label: "variance", domain: [low, high], ticks: 4, tickFormat: (n: number) => short.format(n) },
        marks: [
          line(lines, { x: "x", y: "y", z: "z", stroke: "var(--muted)", strokeOpacity: 0.4, clip: true }),
          link(names, { x1: "each", y1: "variance", x2: "edge", y2: "at", stroke: "var(--mark)", strokeDasharray: "1 3" }),
          dot(points, { x: "each", y: "variance", fill: "var(--mark)", r: 4, title: "name" }),
          text(names, { x: "edge", y: "at", text: "name", title: "name", dx: 5, textAnchor: "start", fill: "var(--ink)", lineWidth: column / 12, textOverflow: "ellipsis-middle" }),
        ],
      }}
    />
  );
}
