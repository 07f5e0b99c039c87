/**
 * The service's REST API, typed. Every failure is an {@link ApiError} that says what, why and what
 * to do, or the browser's own AbortError if the call was given up.
 *
 * @import {MaterialDetail, ParsedChart, PredictResult, Problem, StretchResult, StretchRequest, ViewResult,
 *   ViewRequest} from "./types.js"
 */

/** A refused or failed call. */
export class ApiError extends Error {
  /**
   * @param {Problem} problem
   * @param {boolean} [passing] whether the service asks to try again later
   */
  constructor(problem, passing = false) {
    super(problem.detail || problem.title);
    this.name = "ApiError";
    this.problem = problem;
    this.passing = passing;
  }

  /** Whether the service could not be reached at all. */
  get offline() {
    return this.problem.status === 0;
  }
}

/** @param {unknown} error */
export function isAbort(error) {
  return error instanceof DOMException && error.name === "AbortError";
}

/** @type {Problem} */
const UNREACHABLE = {
  type: "offline",
  title: "The service cannot be reached",
  status: 0,
  detail: "No answer came from the service.",
  remedy: "Your chart is saved in this browser. Continue painting; the numbers return when the service does.",
};

/**
 * @param {Response} response
 * @returns {Promise<Problem>}
 */
async function problemOf(response) {
  /** @type {Problem} */
  const plain = {
    type: "http",
    title: `The service answered ${response.status}`,
    status: response.status,
    detail: response.statusText,
  };
  try {
    return { ...plain, .../** @type {Partial<Problem>} */ (await response.json()) };
  } catch {
    return plain; // not JSON: the status must be enough
  }
}

/**
 * @template T
 * @param {string} path below /api/v1
 * @param {{method?: string, body?: unknown, signal?: AbortSignal, headers?: Record<string, string>,
 *   keepalive?: boolean}} [options]
 * @returns {Promise<T>} undefined where the service has nothing to say (204, 304)
 */
export async function call(path, options) {
  const response = await fetched(path, options);
  if (response.status === 204 || response.status === 304) {
    return /** @type {T} */ (undefined);
  }
  return /** @type {Promise<T>} */ (response.json());
}

/**
 * The same, for answers that are not JSON.
 *
 * @param {string} path below /api/v1
 * @param {{method?: string, body?: unknown, signal?: AbortSignal, headers?: Record<string, string>,
 *   keepalive?: boolean}} [options]
 */
export async function fetched(path, { method = "GET", body, signal, headers = {}, keepalive } = {}) {
  /** @type {Response} */
  let response;
  try {
    response = await fetch(`/api/v1${path}`, {
      method,
      signal,
      keepalive,
      headers: body === undefined ? headers : { ...headers, "Content-Type": "application/json" },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch (error) {
    if (isAbort(error)) throw error;
    throw new ApiError(UNREACHABLE);
  }
  if (!response.ok && response.status !== 304) {
    throw new ApiError(await problemOf(response), response.headers.has("Retry-After"));
  }
  return response;
}

export const api = {
  /** @type {() => Promise<import("./types.js").SignedIn>} */
  session: () => call("/session"),

  /** @type {() => Promise<void>} */
  signOut: () => call("/session", { method: "DELETE" }),

  /** @type {(id: string) => Promise<void>} */
  endSession: (id) => call(`/sessions/${encodeURIComponent(id)}`, { method: "DELETE" }),

  /** @type {() => Promise<import("./types.js").VersionResult>} */
  version: () => call("/version"),

  /** @type {() => Promise<{materials: import("./types.js").MaterialSummary[]}>} */
  materials: () => call("/materials"),

  /**
   * @param {string} id
   * @param {AbortSignal} [signal]
   * @returns {Promise<MaterialDetail>}
   */
  material: (id, signal) => call(`/materials/${encodeURIComponent(id)}`, { signal }),

  /** @type {() => Promise<{patterns: import("./types.js").PatternResult[]}>} */
  patterns: () => call("/patterns"),

  /**
   * @param {string} text
   * @returns {Promise<ParsedChart>}
   */
  parse: (text) => call("/charts/parse", { method: "POST", body: { text } }),

  /**
   * @param {import("./types.js").PredictRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<PredictResult>}
   */
  predict: (body, signal) => call("/predict", { method: "POST", body, signal }),

  /**
   * @param {StretchRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<StretchResult>}
   */
  stretch: (body, signal) => call("/stretch", { method: "POST", body, signal }),

  /**
   * @param {string} design
   * @param {ViewRequest} body
   * @returns {Promise<ViewResult>}
   */
  view: (design, body) => call(`/views/${encodeURIComponent(design)}`, { method: "PUT", body }),

  /**
   * Outline stitches in the 3D view, or none.
   *
   * @param {string} design
   * @param {import("./grid/grid.js").Box | null} box
   * @returns {Promise<void>}
   */
  mark: (design, box) => call(`/views/${encodeURIComponent(design)}/mark`, { method: "PUT", body: { box } }),

  /**
   * @param {string} design
   * @param {import("./types.js").CameraSide} side
   * @returns {Promise<void>}
   */
  look: (design, side) => call(`/views/${encodeURIComponent(design)}/camera`, { method: "PUT", body: { side } }),

  /**
   * @param {import("./types.js").CurveRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").CurveResult>}
   */
  curve: (body, signal) => call("/curve", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").PressureRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").PressureResult>}
   */
  pressure: (body, signal) => call("/pressure", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").CurlRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").CurlResult>}
   */
  curl: (body, signal) => call("/curl", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").LimbRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").LimbResult>}
   */
  limb: (body, signal) => call("/limb", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").GloveRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").GloveResult>}
   */
  glove: (body, signal) => call("/glove", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").HangRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").HangResult>}
   */
  hang: (body, signal) => call("/hang", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").OverhangRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").OverhangResult>}
   */
  overhang: (body, signal) => call("/overhang", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").DrapeRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").DrapeResult>}
   */
  drape: (body, signal) => call("/drape", { method: "POST", body, signal }),

  /**
   * @param {import("./types.js").BorderRequest} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<import("./types.js").BorderResult>}
   */
  border: (body, signal) => call("/border", { method: "POST", body, signal }),

  /**
   * Run something in the background.
   *
   * @param {string} kind
   * @param {unknown} request
   * @returns {Promise<import("./types.js").JobStatus>}
   */
  startJob: (kind, request) => call("/jobs", { method: "POST", body: { kind, request } }),

  /**
   * @template T
   * @param {string} id
   * @param {AbortSignal} [signal]
   * @returns {Promise<T>}
   */
  jobResult: (id, signal) => call(`/jobs/${id}/result`, { signal }),

  /** @type {(id: string) => Promise<void>} */
  cancelJob: (id) => call(`/jobs/${id}`, { method: "DELETE" }),
};
