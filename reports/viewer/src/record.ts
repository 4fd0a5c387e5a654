// The record as the page holds it (reports/viewer/page.h).

export type Num = number | "NaN" | "Infinity" | "-Infinity" | null;

/// A number that can be drawn, or null.
export const finite = (value: Num | undefined): number | null =>
  typeof value === "number" && Number.isFinite(value) ? value : null;

export interface Effect {
  quantity: string;
  estimate: Num;
  low: Num;
  high: Num;
  confidence: number;
  relative: boolean;
}
export interface Histogram {
  low: Num;
  high: Num;
  counts: number[];
}
export interface Cost {
  camera_rays: number;
  closest_hit_rays: number;
  shadow_rays: number;
  samples: number;
  seconds: number;
}
export interface Sample {
  estimator: string;
  plugin: string;
  channel: string;
  primaries: number;
  secondaries: number;
  mean: Num;
  histogram: Histogram;
  quantiles: { normal: Num; observed: Num }[];
}
export interface LawPoint {
  value: Num;
  observed: Num;
  low: Num;
  high: Num;
  law: Num;
}
export interface Channel {
  name: string;
  effect: Effect;
  reference: Num;
  laws: { source: string; points: LawPoint[] }[];
}
export interface Look {
  secondaries: number;
  effect: Effect | null;
}
export interface Finding {
  statistic: string;
  x: number;
  y: number;
  width: number;
  height: number;
  component: string;
}
export interface Gate {
  name: string;
  value: Num;
  limit: Num;
  state: string;
}
export interface Test {
  name: string;
  id: string;
  claim: string;
  verdict: "pass" | "fail" | "inconclusive" | "invalid" | "error" | "skipped";
  tags: string[];
  effect: Effect;
  detect: Num;
  looks: Look[];
  gates: Gate[];
  samples: Sample[];
  channels: Channel[];
  image: { width: number; height: number; components: string[]; winner: Finding } | null;
  message: string;
  replay: string;
  display: {
    standing: Standing;
    verdict: string;
    sentence: string;
    meaning: string;
    effect: string;
    interval: string;
    margin: string;
    chance: string;
    place: string;
    steps: { label: string; words: string; paste: string }[];
    facts: { label: string; text: string }[];
  };
}
export type Standing = "broken" | "no verdict" | "undecided" | "holds" | "caught" | "not run";
export interface Estimate {
  value: Num;
  low: Num;
  high: Num;
}
export interface Estimator {
  name: string;
  plugin: string;
  parameters: string;
  bias: string;
  primaries: number;
  secondaries: number;
  channels: { name: string; mean: Estimate; variance: Estimate; reference: Num }[];
  cost: Cost;
}
export interface KillCell {
  test: string;
  text: string;
  sentence: string;
  killed: boolean;
}
export interface Kills {
  methods: string[];
  rows: { mutant: string; defect: string; cells: (KillCell | null)[] }[];
  totals: string;
  legend: string;
}
export interface Suite {
  name: string;
  file: string;
  about: string;
  estimators: Estimator[];
  retries: unknown[];
  tests: Test[];
  statements: { text: string; source: string; holds: string[]; fails: string[] }[];
  display: {
    counts: string;
    levels: string;
    kills: Kills | null;
    statements: { answer: string; holds: string; fails: string }[];
  };
}
export interface Night {
  date: string;
  commit: string;
  estimate: Num;
  low: Num;
  high: Num;
  mean: Num;
}
export interface Series {
  test: string;
  alarm: boolean;
  quantity: string;
  relative: boolean;
  moved: string;
  moved_commit: string;
  moved_from: string;
  nights: Night[];
}
export interface SeriesDisplay {
  name: string;
  sentence: string;
  alarm: string;
  changes: string;
}
export interface Suspect {
  suite: string;
  name: string;
  standing: Standing;
  tests: string[];
  sentence: string;
}
export interface Record {
  tool: { name: string; version: string; commit: string };
  environment: { compiler: string; cpu: string; isa: string; threads: number };
  started: string;
  seconds: number;
  note: string;
  suites: Suite[];
  ledger: { file: string; series: Series[] };
  display: {
    verdict: string;
    counts: string;
    rates: string;
    seed: string;
    suspects: Suspect[];
    ledger: string;
    quiet: string;
    notes: string[];
    series: SeriesDisplay[];
  };
}

interface PackedPicture {
  test: string;
  name: string;
  title: string;
  width: number;
  height: number;
  reduced: number; // pixels of the record a side of one here
  components: string[];
  coding: "float" | "linear" | "logarithm";
  step: number;
  zero: number;
  start: number;
  length: number;
}

/// A map of numbers, unpacked when it is first looked at.
export class Picture {
  private planes: Float32Array[] | null = null;

  constructor(
    readonly about: PackedPicture,
    private readonly bytes: Uint8Array,
  ) {}

  /// One plane of numbers a component.
  components(): Float32Array[] {
    this.planes ??= this.about.coding === "float" ? this.interleaved() : this.coded();
    return this.planes;
  }

  private interleaved(): Float32Array[] {
    const count = this.about.components.length;
    const view = new DataView(this.bytes.buffer, this.bytes.byteOffset, this.bytes.byteLength);
    const pixels = this.about.width * this.about.height;
    return this.about.components.map((_, c) =>
      Float32Array.from({ length: pixels }, (_, i) => view.getFloat32(4 * (i * count + c), true)),
    );
  }

  private coded(): Float32Array[] {
    const { coding, step, zero, width, height, components } = this.about;
    const pixels = width * height;
    const all = pixels * components.length;
    return components.map((_, c) => {
      const plane = new Float32Array(pixels);
      let before = 0;
      for (let i = 0; i < pixels; ++i) {
        const at = c * pixels + i;
        const folded = (this.bytes[at] ?? 0) + 256 * (this.bytes[all + at] ?? 0);
        const code = folded & 1 ? -(folded + 1) / 2 : folded / 2;
        if (coding === "linear") {
          plane[i] = code * step;
        } else {
          before += code;
          plane[i] = before === 0 ? 0 : 2 ** ((before - zero) * step);
        }
      }
      return plane;
    });
  }
}

export interface Page {
  record: Record;
  pictures: Map<string, Picture[]>;
  suite: Map<string, Suite>;
  test: Map<string, Test>;
}

/// Reads what the page holds: a record, or something else that its JSON text tells.
export async function unpack<Other>(base64: string): Promise<Page | Other> {
  const text = atob(base64);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const held = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  if (!("record" in held)) return held as Other;
  const { record, pictures } = held as { record: Record; pictures: PackedPicture[] };
  const page: Page = { record, pictures: new Map(), suite: new Map(), test: new Map() };
  for (const about of pictures) {
    const start = 4 + length + about.start;
    const all = page.pictures.get(about.test) ?? [];
    all.push(new Picture(about, bytes.subarray(start, start + about.length)));
    page.pictures.set(about.test, all);
  }
  for (const suite of record.suites) {
    for (const test of suite.tests) {
      page.suite.set(test.id, suite);
      page.test.set(test.id, test);
    }
  }
  return page;
}
