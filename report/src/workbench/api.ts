/** What the page asks of the server (src/serve). */

export interface Problem {
  severity: "error" | "warning";
  key: string;
  what: string;
  expected?: string;
  nearest?: string;
  example?: string;
  line?: number;
}

export interface Value {
  text: string;
  given: boolean;
}

export interface Drawing {
  box?: [[number, number], [number, number]];
  nozzle?: [number, number];
  plate?: [number, number];
  bodies: { name: string; low: [number, number]; high: [number, number]; path: [number, number][] }[];
}

export interface BodyCheck {
  name: string;
  size_m: [number, number, number];
  mass_kg: number;
  cells_across?: number;
  over_jet_s?: [number, number];
  at_plate_s?: number;
}

export interface Judgement {
  problems: Problem[];
  values?: Record<string, Value>;
  check?: {
    title: string;
    cells?: number;
    expected_wall_time_s?: number;
    bodies: BodyCheck[];
    assumptions: { key: string; value: string; what: string; reason: string }[];
  };
  drawing?: Drawing;
}

export interface Key {
  name: string;
  help: string;
  takes: string;
  default: string;
  example: string;
  units: string[];
  source?: string;
  words?: Record<string, string>;
  yes_or_no?: boolean;
}

export interface SchemaSection {
  name: string;
  help: string;
  repeated: boolean;
  keys: Key[];
}

export interface RunState {
  name: string;
  case: string;
  state: "starting" | "running" | "done" | "stopped" | "diverged" | "failed";
  fraction?: number;
  time_s?: number;
  eta_s?: number | null;
  wall_time_s?: number;
  verdict?: string;
  title?: string;
  report: boolean;
  said?: string;
}

async function answered<T>(response: Response): Promise<T> {
  const answer: unknown = await response.json();
  if (!response.ok) throw new Error((answer as { error: string }).error);
  return answer as T;
}

async function get<T>(path: string): Promise<T> {
  return answered<T>(await fetch(path));
}

async function post<T>(path: string, body: object, signal?: AbortSignal): Promise<T> {
  const request: RequestInit = { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  if (signal) request.signal = signal;
  return answered<T>(await fetch(path, request));
}

export const api = {
  schema: () => get<SchemaSection[]>("/api/schema"),
  cases: () => get<{ folder: string; cases: string[] }>("/api/cases"),
  runs: () => get<RunState[]>("/api/runs"),
  open: (name: string) => post<{ text: string; digest: string }>("/api/open", { name }),
  create: (name: string) => post<{ text: string; digest: string }>("/api/new", { name }),
  save: (name: string, text: string, digest: string) => post<{ digest: string }>("/api/save", { name, text, digest }),
  check: (name: string, text: string, signal: AbortSignal) => post<Judgement>("/api/check", { name, text }, signal),
  set: (text: string, key: string, value: string) => post<{ text: string }>("/api/set", { text, key, value }),
  unset: (text: string, key: string) => post<{ text: string }>("/api/set", { text, key, remove: true }),
  start: (name: string) => post<{ run: string }>("/api/start", { case: name }),
  resume: (run: string) => post<object>("/api/resume", { run }),
  stop: (run: string) => post<object>("/api/stop", { run }),
  upload: async (file: File) =>
    answered<{ name: string }>(await fetch(`/api/upload?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file })),
};

/** Tells of the runs whenever they change: by events, or by asking where those do not come. */
export function watchRuns(show: (runs: RunState[]) => void, reachable: (yes: boolean) => void): void {
  const events = new EventSource("/api/events");
  events.onmessage = (message) => {
    reachable(true);
    show(JSON.parse(String(message.data)) as RunState[]);
  };
  events.onopen = () => reachable(true);
  events.onerror = () => {
    reachable(false);
    api.runs().then((runs) => {
      reachable(true);
      show(runs);
    }, () => undefined);
    if (events.readyState === EventSource.CLOSED) {
      events.close();
      setTimeout(() => watchRuns(show, reachable), 2000);
    }
  };
}
