import { createContext } from "preact";
import type { Page } from "./record";

export const PageContext = createContext<Page>(null as unknown as Page);
