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
  bodies: { name: string; low: [number, number]; high: [number, number]; outline: [number, number][]; path: [number, number][] }[];
}

export interface BodyCheck {
  name: string;
  size_m: [number, number, number];
  mass_kg: number;
  cells_across?: number;
  over_jet_s?: [number, number];
  at_plate_s?: number;
}

/** Commands of the program that are started from the page. */
export type Kind = "run" | "study" | "map" | "sort" | "campaign";

export interface Judgement {
  problems: Problem[];
  values?: Record<string, Value>;
  commands?: Kind[];
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
  /** SI units in one of `units`. */
  factors: number[];
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

export interface Job {
  name: string;
  kind: Kind;
  case: string;
  state: "waiting" | "starting" | "running" | "done" | "stopped" | "diverged" | "failed";
  /** Jobs that wait before it. */
  before?: number;
  fraction?: number;
  time_s?: number;
  eta_s?: number | null;
  wall_time_s?: number;
  progress?: string;
  verdict?: string;
  title?: string;
  report: boolean;
  said?: string;
}

/** The folder as it is. */
export interface FolderState {
  folder: string;
  jobs: Job[];
  cases: string[];
  at_once: number;
  trouble: string;
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

/** The address of a file of a job. */
export const fileOf = (job: string, file: string): string => `/files/${[...job.split("/"), ...file.split("/")].map(encodeURIComponent).join("/")}`;

/** What somebody calls a thing, as the name of a file that the server takes: what it does not take is left out. */
export function fileName(called: string, extension: string): string {
  const stem = called.trim().replace(new RegExp(`\\${extension}$`, "i"), "");
  return stem.replace(/[^\p{L}\p{N} _.-]+/gu, " ").replace(/ +/g, " ").replace(/^[ .-]+| +$/g, "").slice(0, 60) + extension;
}

export const api = {
  schema: () => get<SchemaSection[]>("/api/schema"),
  cases: () => get<{ folder: string; cases: string[] }>("/api/cases"),
  jobs: () => get<Job[]>("/api/jobs"),
  study: <T>(name: string) => get<T>(`/api/study?name=${encodeURIComponent(name)}`),
  json: <T>(job: string, file: string) => get<T>(fileOf(job, file)),
  open: (name: string) => post<{ text: string; digest: string }>("/api/open", { name }),
  create: (name: string) => post<{ text: string; digest: string }>("/api/new", { name }),
  copy: (name: string, copy: string) => post<{ name: string }>("/api/copy", { name, copy }),
  save: (name: string, text: string, digest: string) => post<{ digest: string }>("/api/save", { name, text, digest }),
  check: (name: string, text: string, signal: AbortSignal) => post<Judgement>("/api/check", { name, text }, signal),
  set: (text: string, key: string, value: string) => post<{ text: string }>("/api/set", { text, key, value }),
  unset: (text: string, key: string) => post<{ text: string }>("/api/set", { text, key, remove: true }),
  start: (name: string, kind: Kind) => post<{ job: string }>("/api/start", { case: name, kind }),
  resume: (job: string) => post<object>("/api/resume", { job }),
  stop: (job: string) => post<object>("/api/stop", { job }),
  remove: (job: string) => post<object>("/api/remove", { job }),
  atOnce: (count: number) => post<object>("/api/at-once", { count }),
  /** `extent`: along x, y, z in the unit of the file, which nobody knows. */
  upload: async (file: File, caseName: string) => answered<{ name: string; extent: [number, number, number] }>(
    await fetch(`/api/upload?name=${encodeURIComponent(fileName(file.name, ".stl"))}&case=${encodeURIComponent(caseName)}`, { method: "POST", body: file })),
};

/** Reads a file that grows by whole lines: each call gives those that have come. */
export class GrowingFile {
  private read = 0;
  constructor(private readonly address: string) {}

  /** null: it is another file than before, which begins anew with the next call. */
  async more(): Promise<string[] | null> {
    const response = await fetch(`${this.address}?from=${this.read}`);
    if (response.status === 404) return [];
    if (!response.ok) {
      this.read = 0;
      return null;
    }
    const bytes = new Uint8Array(await response.arrayBuffer());
    const end = bytes.lastIndexOf(10) + 1;
    this.read += end;
    return new TextDecoder().decode(bytes.subarray(0, end)).split("\n").slice(0, -1);
  }
}

interface Event extends Partial<FolderState> {
  jobs: Job[];
  gone: string[];
  all?: boolean;
}

/** Tells of the folder whenever it changes: by events, or by asking where those do not come. */
export function watchFolder(show: (state: FolderState) => void, reachable: (yes: boolean) => void): void {
  const jobs = new Map<string, Job>();
  const state: FolderState = { folder: "", jobs: [], cases: [], at_once: 1, trouble: "" };
  const take = ({ jobs: changed, gone, all, ...rest }: Event): void => {
    if (all) jobs.clear();
    for (const name of gone) jobs.delete(name);
    for (const job of changed) jobs.set(job.name, job);
    Object.assign(state, rest, { jobs: [...jobs.values()] });
    reachable(true);
    show(state);
  };
  const connect = (): void => {
    const events = new EventSource("/api/events");
    events.onmessage = (message) => take(JSON.parse(String(message.data)) as Event);
    events.onopen = () => reachable(true);
    events.onerror = () => {
      reachable(false);
      Promise.all([api.jobs(), api.cases()]).then(([list, { folder, cases }]) => take({ jobs: list, gone: [], all: true, folder, cases }), () => undefined);
      if (events.readyState === EventSource.CLOSED) {
        events.close();
        setTimeout(connect, 2000);
      }
    };
  };
  connect();
}
