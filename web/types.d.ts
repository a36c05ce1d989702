/**
 * What the server sends and what the store holds, for the type checker and for whoever reads the code.
 * From JSDoc: `@typedef {import("../types").Tick} Tick`. Nothing of this reaches a browser.
 */

// Numbers carry their unit in the name; null is "not known".

export type Point = [number, number];

export interface Pose { x_mm: number; y_mm: number; heading_deg: number }

/** server/api/ticks.py: GET /state, and a telemetry message up to 30 times a second. */
export interface Tick {
  type?: "tick";
  rig: RigState;
  reason: string;
  faults: { code: string; message: string; since_s: number }[];
  simulated: boolean;
  tick: number;
  time_s: number;
  captured_s: number | null;
  tracking: "locked" | "predicted" | "lost";
  tracking_reason: string;
  tracking_age_s: number;
  error_mm: number | null;
  saturated: boolean;
  limited_by: string;
  refused: { frames: number; sightings: number; reports: number };
  body_tilt_deg: number | null;
  pose: Pose | null;
  pose_sigma: { x_mm: number | null; y_mm: number | null; heading_deg: number | null };
  reference: { x_mm: number; y_mm: number } | null;
  measurement: (Pose & { centre_px: Point; corners_px: Point[] }) | null;
  /** Left, top, right and bottom of what is searched. */
  window_px: [number, number, number, number] | null;
  rivals_px: Point[];
  currents_A: number[];
  measured_currents_A: number[];
  field_mT: number[];
  coil_heat: number[];
  command: {
    controller: string; pivot: number; rate_deg_s: number; heading_goal_deg: number; tilt_deg: number; field_mT: number;
  };
  run: RunProgress | null;
  camera: { latency_ms: number | null; rate_Hz: number | null };
  loop: {
    rate_Hz: number | null; period_p99_ms: number | null;
    latency_p50_ms: number | null; latency_p99_ms: number | null; dropped_frames: number;
  };
  link: Link;
  recording: {
    state: string; run: string | null; size_bytes: number; ticks_waiting: number; frames_left_out: number; failure: string;
  };
  operator: { id: string; name: string; note: string } | null;
}

export type RigState = "disarmed" | "armed" | "running" | "held" | "fault";

export interface RunProgress {
  id: string; elapsed_s: number; duration_s: number | null; passes: number; passes_done: number; paused: boolean;
  mean_error_mm: number | null; steps: number; sweeps: number; reversals: number;
}

export interface Link {
  state: string; port: string; firmware: string; boot_id: number | null;
  round_trip_ms: number | null; round_trip_median_ms: number | null; round_trip_p99_ms: number | null;
  bad_frames: number; bad_share: number; counts: Record<string, any>;
  board_state: string; board_faults: string[]; supply_V: number | null;
}

/** GET /rig: the values of the rig file, and where the file is. */
export interface Rig {
  name: string;
  robot: { length_mm: number; body_length_mm: number; body_width_mm: number; body_height_mm: number; lift_ratio: number };
  limits: { workspace_mm: number; field_mT: number; rate_deg_s: number; current_A: number[]; [name: string]: any };
  file?: any;
  [section: string]: any;
}

/** GET /camera; the model is that of OpenCV: px, and mm from the workspace to the camera. */
export interface Camera { size: Point; rate_Hz?: number; calibrated?: boolean; model: CameraModel }

export interface CameraModel {
  fx: number; fy: number; cx: number; cy: number;
  /** k1, k2, p1, p2, k3. */
  distortion: number[];
  /** Row-major. */
  rotation: number[];
  translation_mm: number[];
  body_height_mm: number;
}

/** A controller, a trajectory or a plant that can be chosen. */
export interface Choice { name: string; title: string; summary: string; parameters: Schema; saved?: boolean }

/** A JSON schema with units, as server/ makes it of pydantic models. */
export interface Schema { properties?: Record<string, any>; $defs?: Record<string, any>; [word: string]: any }

export interface Chosen { name: string; parameters: Record<string, any> }

/** GET /selection. */
export interface Selection { controller: Chosen; trajectory: Chosen; gait: Record<string, any> }

/** POST /trajectories/preview. */
export interface Path { points_mm: Point[]; length_mm: number; duration_s: number }

/** A row of GET /runs; what is known only of a whole one (GET /runs/{id}) may be missing. */
export interface Run { id: string; state: string; started_at: string; [fact: string]: any }

/** GET /studies and GET /studies/{id}. */
export interface Study { id: string; name: string; state: string; [fact: string]: any }

/** One axis of a study along which its sets lie. */
export interface Axis { name: string; values: any[]; [fact: string]: any }

/** One set of parameter values of a study, with the figures of its runs so far. */
export interface StudySet { values: Record<string, any>; [fact: string]: any }

/** A line of GET /events; number counts up through a session of the server, at is ISO 8601. */
export interface RigEvent {
  number: number; at: string; time_s: number; severity: string; code: string; message: string; run_id: string | null;
}

/** One field of a form (forms/schema.js). */
export interface FormField {
  name: string; title: string; description: string; unit: string;
  kind: "choice" | "switch" | "points" | "number" | "text";
  integer: boolean; optional: boolean; initial: any; choices: any[];
  low?: number; high?: number; above?: number; below?: number;
  [more: string]: any;
}

// What the features keep in the store.

export interface Connection {
  status: "connecting" | "open" | "silent" | "lost";
  cause: string;
  /** performance.now() of the next try, ms. */
  retryAt: number | null;
  /** How much older than new what comes is. */
  late_ms: number;
}

/** GET /operator, and what is told of it since; heardAt: performance.now() then, ms. */
export interface Operator {
  you: string;
  you_may: "view" | "operate" | "administer";
  holder: { id: string; name: string; note: string; kind: "page" | "script"; since_s: number; silent_s: number } | null;
  asking: { id: string; name: string; note: string; since_s: number } | null;
  lease_s: number; take_over_after_s: number;
  heardAt: number;
}

export interface Message {
  id: number; text: string; severity: string;
  action: { words: string; act: () => void } | null;
}

/** calibration/setup.js. */
export interface Setup {
  step: string;
  cameras: any; vision: any; calibration: any; star: any; latency: any;
  working: { place: string; words: string } | null;
  found: any; taking: any; board: string | null;
  errors: Record<string, string>; done: Record<string, string>; saved: any;
  [more: string]: any;
}

/** replay/replay.js. */
export interface Replay {
  ids: string[];
  status: "loading" | "open" | "lost"; cause: string; session: string | null;
  runs: Recording[]; duration_s: number;
  playing: boolean; speed: number;
  /** From, to, s. */
  loop: Point | null; zoom: Point | null;
  closer: Columns[] | null;
  second: any;
}

/** Column name -> one value a tick. */
export type Columns = Record<string, any>;

/** One recorded run (replay/recording.js). */
export interface Recording {
  id: string; run: Run; series: Columns; name: string; parts: string; started: string; duration_s: number;
  ticks: number | null; frames: number | null; events: any[]; isWhole: boolean;
  paths: { time_s: number; points_mm: Point[] }[];
  half_mm: number; length_mm?: number; camera: Camera;
}

/** runs/listing.js. */
export interface Listing {
  filter: Record<string, string>;
  runs: Run[] | null; next: string | null;
  total: number | null; totals: any;
  loading: boolean; error: string;
  ticked: string[];
}

/** runs/inspected.js. */
export interface Inspected { id: string; run: Run | null; error: string; working: string; restarted: any }

/** studies/listing.js. */
export interface StudiesShown {
  studies: Study[] | null; error: string;
  open: string | null; study: Study | null; trouble: string; working: string;
  metric: string;
}

/** studies/composing.js: a definition as its form holds it. */
export interface Draft { rest: Record<string, any>; axes: any[] }
export interface Composing extends Draft {
  version: number; preview: any; problems: Record<string, string>; error: string; asking: boolean; starting: boolean;
}

/** rig/settings.js. */
export interface RigPage {
  section: string; search: string;
  schema: any; about: any; ports: any; cameras: any;
  draft: Record<string, any>;
  working: string; error: string; done: { words: string; undo: boolean } | null;
  file: { name: string; text: string; differences: { field: string; from: any; to: any }[] | null; error: string } | null;
  tested: any;
}

/** log/listing.js: next is the cursor of the lines before those that are known; seen the number of the newest seen line. */
export interface Log {
  next: number | null; loaded: boolean; loading: boolean; error: string; severity: string; text: string; seen: number;
}

/** jog/jog.js: who holds what down, and why it has stopped. */
export interface Jog {
  on: boolean;
  rate_deg_s: number;
  held: { by: string; swing: { pivot: 1 | -1; rate_deg_s: number; tilt_deg?: number } } | null;
  refusal: string;
}

/** GET /simulation/faults: one kind, what is in of it, what the rig promises and what it did. */
export interface FaultKind {
  name: string; row: number; family: string; title: string; what: string; mends: string; happens_once: boolean;
  parameters: Schema;
  injected: { parameters: Record<string, any>; since_s: number; until_s: number | null; is_on: boolean } | null;
  promise: {
    sees: string; states: RigState[]; noticed_ms: number | null; gone_ms: number | null; go_on: string;
    parameters: Record<string, any>;
  };
  reaction: {
    since_s: number; was: RigState; became: RigState | null; reason: string; noticed_ms: number | null;
    gone_ms: number | null; verdict: "watching" | "kept" | "broken" | "open" | "at_rest";
  } | null;
}

export interface State {
  connection: Connection;
  operator: Operator;
  tick: Tick | null;
  rig: Rig | null;
  camera: Camera | null;
  controllers: Choice[];
  trajectories: Choice[];
  gaitSchema: Schema | null;
  selection: Selection | null;
  elsewhere: { taken: string[]; kept: string[] } | null;
  outdated: boolean;
  passes: number;
  path: Path | null;
  runPath: Path | null;
  walked: Run | null;
  applying: Record<string, "pending" | "applied">;
  nextRun: { label: string; tags: string[]; unattended: boolean };
  draftErrors: Record<string, string>;
  serverErrors: Record<string, string>;
  tool: "draw" | "measure" | null;
  drawing: import("./draw/drawing.js").Drawing | null;
  setup: Setup | null;
  replay: Replay | null;
  consentAsked: boolean;
  jog: Jog;
  faults: FaultKind[] | null;
  busy: string | null;
  messages: Message[];
  listing: Listing | null;
  inspected: Inspected | null;
  studies: StudiesShown | null;
  composing: Composing | null;
  plants: Choice[];
  help: { of: string; name: string; title: string; at: { left: number; top: number; right: number; bottom: number } } | null;
  tour: number | null;
  scene: { layers: string[]; watching: boolean | null; full_field_mT: number | null; follows: boolean };
  large: string | null;
  charts: { window_s: number; held: Point | null; zoom: Point | null; hidden: string[]; folded: string[] };
  tab: string;
  rigPage: RigPage | null;
  calibrations: { calibration: any; star: any; latency: any; vision: any; error: string } | null;
  notify: { on: boolean; sound: boolean; permission: string };
  events: RigEvent[];
  log: Log;
}

/** preact's, but what starts empty may be filled with anything. */
export interface UseState {
  (initial: null): [any, (next: any) => void];
  (initial: []): [any[], (next: any[] | ((before: any[]) => any[])) => void];
  <S>(initial: S | (() => S)): [S, (next: S | ((before: S) => S)) => void];
}

/** preact's, but a reference is filled by the renderer before anybody looks at it. */
export interface UseRef {
  (initial?: null): { current: any };
  <T>(initial: T): { current: T };
}
