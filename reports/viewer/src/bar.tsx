import { finite, type Test } from "./record";

const reach = 2.5; // of the axis, in units of what must be caught
const width = 200;
const height = 18;
const at = (value: number) => ((value + reach) / (2 * reach)) * width;
const inside = (value: number) => Math.max(-reach, Math.min(reach, value));

/// Tells whether a test has an effect, and a least one that must be caught.
export function hasBar(test: Test) {
  return (finite(test.detect) ?? 0) > 0 && finite(test.effect.estimate) !== null && test.display.effect !== "";
}

/// The effect on the axis that all rows share.
export function Bar({ test }: { test: Test }) {
  if (!hasBar(test)) return null;
  const unit = finite(test.detect)!;
  const value = finite(test.effect.estimate)!;
  const low = inside((finite(test.effect.low) ?? -Infinity) / unit);
  const high = inside((finite(test.effect.high) ?? Infinity) / unit);
  const middle = height / 2;
  const shown = value / unit;
  const point = at(inside(shown));
  const beyond = Math.abs(shown) > reach ? Math.sign(shown) * 5 : 0;
  return (
    <svg class="bar" viewBox={`0 0 ${width} ${height}`} aria-hidden="true">
      <rect class="band" x={at(-1)} width={at(1) - at(-1)} height={height} />
      <line class="zero" x1={at(0)} x2={at(0)} y2={height} />
      <line class="range" x1={at(low)} x2={at(high)} y1={middle} y2={middle} />
      {beyond ? (
        <path class="point" d={`M${point - beyond},4L${point + beyond / 2},9L${point - beyond},14Z`} />
      ) : (
        <circle class="point" cx={point} cy={middle} r="4" />
      )}
    </svg>
  );
}

export function Axis() {
  return (
    <svg class="bar axis" viewBox={`0 0 ${width} 14`} aria-hidden="true">
      {[-2, -1, 0, 1, 2].map((value) => (
        <text key={value} x={at(value)} y="11" text-anchor="middle">
          {value}
        </text>
      ))}
    </svg>
  );
}
