// The choices of a reader. They stand in the address, so that a reload or a link shows the same.
import { useEffect, useState } from "preact/hooks";
import type { Standing, Test } from "./record";

export type Choice = "all" | Standing;
export interface State {
  show: Choice;
  find: string;
  open: string[];
}
const choices: Choice[] = ["all", "broken", "no verdict", "undecided", "holds", "caught", "not run"];

function read(): State {
  const given = new URLSearchParams(location.hash.slice(1));
  const show = given.get("show") as Choice;
  return {
    show: choices.includes(show) ? show : "all",
    find: given.get("find") ?? "",
    open: given.getAll("open"),
  };
}

export function link(state: Partial<State>): string {
  const words = new URLSearchParams();
  if (state.show && state.show !== "all") words.set("show", state.show);
  if (state.find) words.set("find", state.find);
  for (const id of state.open ?? []) words.append("open", id);
  return "#" + words.toString();
}

export function useAddress(): [State, (change: Partial<State>) => void] {
  const [state, set] = useState(read);
  useEffect(() => {
    const changed = () => set(read());
    addEventListener("hashchange", changed);
    return () => removeEventListener("hashchange", changed);
  }, []);
  const change = (part: Partial<State>) => {
    const next = { ...read(), ...part };
    history.replaceState(null, "", link(next));
    set(next);
  };
  return [state, change];
}

export function matches(test: Test, state: State): boolean {
  if (state.show !== "all" && test.display.standing !== state.show) return false;
  const words = state.find.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return true;
  const text = [
    test.id,
    test.claim,
    ...test.tags,
    ...test.samples.map((sample) => sample.estimator),
  ]
    .join(" ")
    .toLowerCase();
  return words.every((word) => text.includes(word));
}
