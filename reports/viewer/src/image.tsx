// The pictures of a claim: where they differ, by how much, both sides, and a wipe between them.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Finding, Picture, Test } from "./record";

type Mode = "where" | "much" | "new" | "old" | "wipe";
const modes: { mode: Mode; name: string }[] = [
  { mode: "where", name: "Where" },
  { mode: "much", name: "How much" },
  { mode: "new", name: "New" },
  { mode: "old", name: "Old" },
  { mode: "wipe", name: "Wipe" },
];
const orange = [179, 64, 10];
const blue = [33, 90, 160];

/// Clear at 0, so that the page shows, orange at 1, blue at -1.
function signed(rgba: Uint8ClampedArray, i: number, value: number) {
  const t = Math.min(1, Math.abs(value));
  const full = value > 0 ? orange : blue;
  for (let c = 0; c < 3; ++c) rgba[4 * i + c] = full[c] ?? 0;
  rgba[4 * i + 3] = 255 * t;
}

/// Sums over a window around each pixel, cut at the edges, with the number of pixels.
function windowed(plane: Float32Array, size: Size, window: Size, give: (i: number, sum: number, count: number) => void) {
  const { width, height } = size;
  const table = new Float64Array((width + 1) * (height + 1));
  for (let y = 0; y < height; ++y) {
    let row = 0;
    for (let x = 0; x < width; ++x) {
      row += plane[y * width + x] ?? 0;
      table[(y + 1) * (width + 1) + x + 1] = (table[y * (width + 1) + x + 1] ?? 0) + row;
    }
  }
  const sum = (x: number, y: number) => table[y * (width + 1) + x] ?? 0;
  for (let y = 0; y < height; ++y) {
    const above = y - (window.height >> 1);
    const top = Math.max(0, above);
    const bottom = Math.min(height, above + window.height);
    for (let x = 0; x < width; ++x) {
      const before = x - (window.width >> 1);
      const left = Math.max(0, before);
      const right = Math.min(width, before + window.width);
      const total = sum(right, bottom) - sum(left, bottom) - sum(right, top) + sum(left, top);
      give(y * width + x, total, (right - left) * (bottom - top));
    }
  }
}

interface Size {
  width: number;
  height: number;
}

/// The places of red, green and blue; of other components the first three times.
function rgb(names: string[]): [number, number, number] {
  const place = (letter: string) =>
    names.findIndex((name) => name.toLowerCase().split(".").pop()?.startsWith(letter));
  const found: [number, number, number] = [place("r"), place("g"), place("b")];
  return found.every((index) => index >= 0) ? found : [0, 0, 0];
}

/// Draws the modes of one claim at one number a pixel.
class Painter {
  readonly size: Size;
  readonly window: Size;
  readonly component: string;
  private readonly index: number;
  private readonly done = new Map<string, HTMLCanvasElement>();
  private readonly level: number;

  constructor(
    readonly z: Picture,
    readonly fresh: Picture | undefined,
    readonly old: Picture | undefined,
    winner: Finding,
    readonly finding: Finding | null, // null: the images do not differ
  ) {
    this.size = { width: z.about.width, height: z.about.height };
    this.component = winner.component;
    this.index = Math.max(0, z.about.components.indexOf(winner.component));
    // A finding all over the image has no size to average over.
    const local = finding && finding.width * finding.height * 4 <= this.size.width * this.size.height;
    const whole = (extent: number) => Math.max(1, Math.round(extent));
    this.window = local ? { width: whole(finding.width), height: whole(finding.height) } : { width: 1, height: 1 };
    this.level = this.bright();
  }

  private bright(): number {
    const planes = (this.old ?? this.fresh)?.components() ?? [];
    const values: number[] = [];
    for (const plane of planes) {
      const step = Math.max(1, Math.floor(plane.length / 4096));
      for (let i = 0; i < plane.length; i += step) values.push(plane[i] ?? 0);
    }
    values.sort((a, b) => a - b);
    const high = values[Math.floor(0.98 * (values.length - 1))] ?? 1;
    return high > 0 ? high : 1;
  }

  canvas(mode: "where" | "much" | "new" | "old", stops: number): HTMLCanvasElement {
    const key = mode === "new" || mode === "old" ? `${mode} ${stops}` : mode;
    const known = this.done.get(key);
    if (known) return known;
    const canvas = document.createElement("canvas");
    canvas.width = this.size.width;
    canvas.height = this.size.height;
    const context = canvas.getContext("2d")!;
    const image = context.createImageData(canvas.width, canvas.height);
    if (mode === "where") this.where(image.data);
    else if (mode === "much") this.much(image.data);
    else this.side(image.data, mode === "new" ? this.fresh : this.old, stops);
    context.putImageData(image, 0, 0);
    if (this.done.size > 12) this.done.clear();
    this.done.set(key, canvas);
    return canvas;
  }

  private where(rgba: Uint8ClampedArray) {
    const plane = this.z.components()[this.index]!;
    windowed(plane, this.size, this.window, (i, sum, count) => signed(rgba, i, sum / Math.sqrt(count) / 8));
  }

  private much(rgba: Uint8ClampedArray) {
    const fresh = this.fresh?.components()[this.index];
    const old = this.old?.components()[this.index];
    if (!fresh || !old) return;
    const sums = new Float64Array(old.length);
    windowed(old, this.size, this.window, (i, sum) => (sums[i] = sum));
    windowed(fresh, this.size, this.window, (i, sum) => {
      const base = sums[i] ?? 0;
      signed(rgba, i, base === 0 ? Math.sign(sum) : (sum - base) / Math.abs(base) / 0.1);
    });
  }

  private side(rgba: Uint8ClampedArray, picture: Picture | undefined, stops: number) {
    const planes = picture?.components();
    if (!planes) return;
    const scale = (2 ** stops * 0.8) / this.level;
    const places = rgb(this.z.about.components);
    for (let i = 0; i < this.size.width * this.size.height; ++i) {
      for (let c = 0; c < 3; ++c) {
        const value = Math.max(0, planes[places[c]!]![i]! * scale);
        rgba[4 * i + c] = 255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);
      }
      rgba[4 * i + 3] = 255;
    }
  }

  read(x: number, y: number): string {
    const i = y * this.size.width + x;
    const list = (picture: Picture | undefined) =>
      picture?.components().map((plane) => Number((plane[i] ?? 0).toPrecision(3))).join(" ");
    const { reduced } = this.z.about;
    const parts = [`x ${x * reduced}, y ${y * reduced}`, `${list(this.z)} standard errors`];
    if (this.fresh) parts.push(`new ${list(this.fresh)}`);
    if (this.old) parts.push(`old ${list(this.old)}`);
    return parts.join(" · ");
  }
}

const legends: { [mode in Mode]: string } = {
  where: "Orange: new is brighter. Blue: darker. In standard errors.",
  much: "Orange: new is brighter. Blue: darker.",
  new: "The new picture.",
  old: "What it is compared with, at the same exposure.",
  wipe: "Left: old. Right: new. Move to shift the edge.",
};

const scales: { [mode in Mode]?: string } = { where: "8 errors", much: "10 %" };

interface View {
  scale: number; // canvas pixels a picture pixel
  x: number; // picture pixel at the left edge
  y: number;
}

export function ImageViewer({ test, pictures }: { test: Test; pictures: Picture[] }) {
  const painter = useMemo(() => {
    const named = (name: string) => pictures.find((picture) => picture.about.name === name);
    const z = named("z");
    if (!z || !test.image) return null;
    const { reduced } = z.about;
    const { winner } = test.image;
    const { x, y, width, height } = winner;
    const found = test.verdict === "fail" && width > 0;
    const finding = found ? { ...winner, x: x / reduced, y: y / reduced, width: width / reduced, height: height / reduced } : null;
    return new Painter(z, named("mean"), named("other_mean") ?? named("reference"), winner, finding);
  }, [test, pictures]);
  return painter && <Viewer painter={painter} name={test.name} />;
}

function Viewer({ painter, name }: { painter: Painter; name: string }) {
  const { width, height } = painter.size;
  const { reduced } = painter.z.about;
  const shown = useRef<HTMLCanvasElement>(null);
  const [mode, setMode] = useState<Mode>("where");
  const [stops, setStops] = useState(0);
  const [edge, setEdge] = useState(0.5);
  const [pixel, setPixel] = useState("Move over the picture to read pixels. Wheel: zoom. Drag: pan.");
  const pixels = Math.max(1, Math.round(960 / Math.max(width, height)));
  const canvasSize = { width: width * pixels, height: height * pixels };
  const fit: View = { scale: pixels, x: 0, y: 0 };
  const [view, setView] = useState(fit);
  const drag = useRef<{ x: number; y: number; view: View } | null>(null);

  useEffect(() => {
    const context = shown.current?.getContext("2d");
    if (!context) return;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvasSize.width, canvasSize.height);
    context.imageSmoothingEnabled = false;
    context.setTransform(view.scale, 0, 0, view.scale, -view.x * view.scale, -view.y * view.scale);
    if (mode === "wipe") {
      context.drawImage(painter.canvas("old", stops), 0, 0);
      const from = view.x + (edge * canvasSize.width) / view.scale;
      context.save();
      context.beginPath();
      context.rect(from, 0, width, height);
      context.clip();
      context.drawImage(painter.canvas("new", stops), 0, 0);
      context.restore();
      context.fillStyle = "#fff";
      context.fillRect(from, view.y, 2 / view.scale, canvasSize.height / view.scale);
    } else {
      context.drawImage(painter.canvas(mode, stops), 0, 0);
    }
  }, [painter, mode, stops, edge, view]);

  const zoomTo = ({ x, y, width: w, height: h }: Finding) => {
    const scale = Math.max(fit.scale, Math.min(canvasSize.width / (2 * w), canvasSize.height / (2 * h), 40 * pixels));
    setView(kept({
      scale,
      x: x + w / 2 - canvasSize.width / scale / 2,
      y: y + h / 2 - canvasSize.height / scale / 2,
    }));
  };
  /// The view moved so that it shows no more of the outside than it must.
  const kept = ({ scale, x, y }: View): View => {
    const most = (all: number, part: number) => Math.max(0, all - part / scale);
    return {
      scale,
      x: Math.max(0, Math.min(x, most(width, canvasSize.width))),
      y: Math.max(0, Math.min(y, most(height, canvasSize.height))),
    };
  };
  const zoom = (factor: number, px = canvasSize.width / 2, py = canvasSize.height / 2) =>
    setView((now) => {
      const scale = Math.max(fit.scale, Math.min(64 * pixels, now.scale * factor));
      return kept({ scale, x: now.x + px / now.scale - px / scale, y: now.y + py / now.scale - py / scale });
    });
  /// A place on the canvas, in its pixels.
  const place = (event: PointerEvent | WheelEvent) => {
    const box = shown.current!.getBoundingClientRect();
    return {
      px: ((event.clientX - box.left) / box.width) * canvasSize.width,
      py: ((event.clientY - box.top) / box.height) * canvasSize.height,
    };
  };
  const move = (event: PointerEvent) => {
    const { px, py } = place(event);
    if (drag.current) {
      const { x, y, view: start } = drag.current;
      setView(kept({ scale: start.scale, x: start.x - (px - x) / start.scale, y: start.y - (py - y) / start.scale }));
      return;
    }
    if (mode === "wipe") setEdge(px / canvasSize.width);
    const x = Math.floor(view.x + px / view.scale);
    const y = Math.floor(view.y + py / view.scale);
    if (x >= 0 && y >= 0 && x < width && y < height) setPixel(painter.read(x, y));
  };
  const key = (event: KeyboardEvent) => {
    const step = canvasSize.width / view.scale / 8;
    const pan = (x: number, y: number) => setView((now) => kept({ ...now, x: now.x + x, y: now.y + y }));
    const chosen = modes[Number(event.key) - 1];
    const actions: { [key: string]: () => void } = {
      "+": () => zoom(1.5),
      "-": () => zoom(1 / 1.5),
      ...(painter.finding && { z: () => zoomTo(painter.finding!) }),
      f: () => setView(fit),
      ArrowLeft: () => pan(-step, 0),
      ArrowRight: () => pan(step, 0),
      ArrowUp: () => pan(0, -step),
      ArrowDown: () => pan(0, step),
    };
    const action = chosen ? () => setMode(chosen.mode) : actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof HTMLInputElement) return;
    event.preventDefault();
    action();
  };
  return (
    <div class="viewer" role="group" aria-label={`Pictures of ${name}`} onKeyDown={key}>
      <div class="picture" style={{ width: `min(100%, ${(70 * width) / height}vh)` }}>
      <canvas
        ref={shown}
        class={scales[mode] && "map"}
        width={canvasSize.width}
        height={canvasSize.height}
        tabIndex={0}
        role="img"
        aria-label={`${modes.find((m) => m.mode === mode)?.name}: ${name}. Keys 1 to 5 choose, ${painter.finding ? "z zooms to the finding, " : ""}f fits, arrows pan.`}
        onPointerDown={(event) => {
          const { px, py } = place(event);
          drag.current = { x: px, y: py, view };
          shown.current?.setPointerCapture(event.pointerId);
        }}
        onPointerUp={() => (drag.current = null)}
        onPointerMove={move}
        onWheel={(event) => {
          event.preventDefault();
          const { px, py } = place(event);
          zoom(event.deltaY < 0 ? 1.25 : 0.8, px, py);
        }}
      />
      {painter.finding && <Frame finding={painter.finding} view={view} canvas={canvasSize} />}
      </div>
      <div class="controls">
        <div class="buttons">
          {modes.map(({ mode: one, name: words }, i) => (
            <button key={one} type="button" aria-pressed={mode === one} title={`Key ${i + 1}`} onClick={() => setMode(one)}>
              {words}
            </button>
          ))}
        </div>
        <div class="buttons">
          {painter.finding && <button type="button" onClick={() => zoomTo(painter.finding!)}>Zoom to finding</button>}
          <button type="button" onClick={() => setView(fit)}>Fit</button>
        </div>
        {(mode === "new" || mode === "old" || mode === "wipe") && (
          <label class="exposure">
            Exposure
            <input type="range" min="-8" max="8" step="0.5" value={stops} onInput={(event) => setStops(Number(event.currentTarget.value))} />
          </label>
        )}
        {scales[mode] && (
          <div class="scale" aria-hidden="true">
            <i />
            <span>-{scales[mode]}</span>
            <span>0</span>
            <span>+{scales[mode]}</span>
          </div>
        )}
        <p class="quiet">
          {legends[mode]}
          {scales[mode] && painter.window.width * painter.window.height > 1 && " Averaged over the size of the finding."}
          {scales[mode] && painter.z.about.components.length > 1 && ` Component ${painter.component}.`}
          {reduced > 1 && ` Each pixel here is the mean of ${reduced} by ${reduced}. An EXR file beside the record of --report json=FILE has them all.`}
        </p>
        <p class="code pixel">{pixel}</p>
      </div>
    </div>
  );
}

/// A frame around the finding that is seen at any zoom and on any screen.
function Frame({ finding, view, canvas }: { finding: Finding; view: View; canvas: Size }) {
  const middle = (from: number, extent: number, all: number) => `${(100 * (from + extent / 2) * view.scale) / all}%`;
  const part = (extent: number, all: number) => `${(100 * extent * view.scale) / all}%`;
  const left = middle(finding.x - view.x, finding.width, canvas.width);
  const top = middle(finding.y - view.y, finding.height, canvas.height);
  const width = part(finding.width, canvas.width);
  const height = part(finding.height, canvas.height);
  return <div class="frame" style={{ left, top, width, height }} />;
}

/// The cells of a sampler's domain, a number a cell.
export function CellMap({ picture }: { picture: Picture }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { width, height, title, name } = picture.about;
  const difference = name.startsWith("cells_z");
  const plane = picture.components()[0]!;
  const most = plane.reduce((a, b) => Math.max(a, Math.abs(b)), 0) || 1;
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (!context) return;
    const image = context.createImageData(width, height);
    plane.forEach((value, i) => signed(image.data, i, difference ? value / Math.max(most, 4) : -value / most));
    context.putImageData(image, 0, 0);
  }, [picture]);
  return (
    <figure>
      <canvas class="cells map" ref={canvas} width={width} height={height} role="img" aria-label={title} />
      <figcaption>
        {title}. Largest: {Number(most.toPrecision(3))}.
      </figcaption>
    </figure>
  );
}
