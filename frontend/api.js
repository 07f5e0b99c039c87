/**
 * The service's REST API, typed. Every failure is an {@link ApiError} that says what, why and what
 * to do, or the browser's own AbortError if the call was given up.
 *
 * @import {CameraSide, Extensions, JobStatus, MarkRequest, MaterialDetail, Operations, Problem, SignedIn, VersionResult, ViewRequest,
 *   ViewResult} from "./types.js"
 */

import { plainly } from "./core/plainly.js";

/**
 * @typedef {{method?: string, body?: unknown, signal?: AbortSignal, headers?: Record<string, string>,
 *   keepalive?: boolean}} CallOptions
 */

/** A refused or failed call. */
export class ApiError extends Error {
  /** @param {Problem} problem @param {boolean} [passing] whether the service asks to try again later */
  constructor(problem, passing = false) {
    super(problem.detail || problem.title);
    this.name = "ApiError";
    this.problem = plainly(problem);
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
  detail: "The service cannot be reached",
  remedy: "Your chart is saved in this browser. Continue painting; the numbers return when the service does.",
};

/** What is said of a file that cannot be imported. @param {string} detail @param {string | null} [remedy] @returns {Problem} */
export const refusal = (detail, remedy) => ({
  type: "input",
  title: "This chart cannot be imported",
  status: 422,
  detail: detail.replace(/^(Chart|Knitout|Rows): (line )?/, (_, __, line) => (line ? "Line " : "")),
  remedy,
});

/** @param {Response} response @returns {Promise<Problem>} */
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
 * @param {CallOptions} [options]
 * @returns {Promise<T>} undefined where the service has nothing to say (204, 304)
 */
export async function call(path, options) {
  const response = await fetched(path, options);
  if (response.status === 204 || response.status === 304) {
    return /** @type {T} */ (undefined);
  }
  return /** @type {Promise<T>} */ (response.json());
}

/** The same, for answers that are not JSON. @param {string} path below /api/v1 @param {CallOptions} [options] */
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
  /**
   * Run an operation of the service: its request and result are those of its address.
   *
   * @template {keyof Operations} T
   * @param {T} operation address of the operation, without the first slash
   * @param {Operations[T]["request"]} body
   * @param {AbortSignal} [signal]
   * @returns {Promise<Operations[T]["result"]>}
   */
  run: (operation, body, signal) => call(`/${operation}`, { method: "POST", body, signal }),

  /** @type {() => Promise<SignedIn>} */
  session: () => call("/session"),

  /** @type {() => Promise<void>} */
  signOut: () => call("/session", { method: "DELETE" }),

  /** @type {(id: string) => Promise<void>} */
  endSession: (id) => call(`/sessions/${encodeURIComponent(id)}`, { method: "DELETE" }),

  /** @type {() => Promise<VersionResult>} */
  version: () => call("/version"),

  /** @type {() => Promise<import("./types.js").Machines>} */
  machines: () => call("/machines"),

  /** @type {(design: string) => Promise<import("./types.js").KnittingPlaces>} */
  places: (design) => call(`/designs/${encodeURIComponent(design)}/places`),

  /** @type {(design: string, way: string, body: import("./types.js").PlaceRequest) => Promise<void>} */
  keepPlace: (design, way, body) =>
    call(`/designs/${encodeURIComponent(design)}/places/${encodeURIComponent(way)}`, {
      method: "PUT",
      body,
      keepalive: true,
    }),

  /** @type {() => Promise<Extensions>} */
  extensions: () => call("/extensions"),

  /** @type {() => Promise<{materials: import("./types.js").MaterialSummary[]}>} */
  materials: () => call("/materials"),

  /** @type {(id: string, signal?: AbortSignal) => Promise<MaterialDetail>} */
  material: (id, signal) => call(`/materials/${encodeURIComponent(id)}`, { signal }),

  /** @type {() => Promise<{patterns: import("./types.js").PatternResult[]}>} */
  patterns: () => call("/patterns"),

  /** @type {(design: string, body: ViewRequest) => Promise<ViewResult>} */
  view: (design, body) => call(`/views/${encodeURIComponent(design)}`, { method: "PUT", body }),

  /** Outline stitches in the 3D view. @type {(design: string, body: MarkRequest) => Promise<void>} */
  mark: (design, body) => call(`/views/${encodeURIComponent(design)}/mark`, { method: "PUT", body }),

  /** @type {(design: string, side: CameraSide) => Promise<void>} */
  look: (design, side) => call(`/views/${encodeURIComponent(design)}/camera`, { method: "PUT", body: { side } }),

  /** Run something in the background. @type {(kind: string, request: unknown) => Promise<JobStatus>} */
  startJob: (kind, request) => call("/jobs", { method: "POST", body: { kind, request } }),

  /** @type {<T>(id: string, signal?: AbortSignal) => Promise<T>} */
  jobResult: (id, signal) => call(`/jobs/${id}/result`, { signal }),

  /** @type {(id: string) => Promise<void>} */
  cancelJob: (id) => call(`/jobs/${id}`, { method: "DELETE" }),
};
