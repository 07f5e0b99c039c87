/** Long computations: started, followed by events, given up. */

import { ApiError, api } from "../api.js";

/** @import {JobStatus, Problem} from "../types.js" */

/**
 * The result of a computation in the background.
 *
 * @template T
 * @param {string} kind
 * @param {unknown} request
 * @param {{signal: AbortSignal, onProgress?: (status: JobStatus) => void}} options giving up the signal
 *   cancels the job
 * @returns {Promise<T>}
 */
export async function runJob(kind, request, { signal, onProgress }) {
  const job = await api.startJob(kind, request);
  const cancel = () => void api.cancelJob(job.id).catch(() => {}); // it may have ended by itself
  if (signal.aborted) {
    cancel();
    throw signal.reason;
  }
  const ended = await followed(job, signal, onProgress, cancel);
  if (ended.state !== "done") throw new ApiError(ended.problem ?? interrupted(ended));
  return api.jobResult(job.id, signal);
}

/**
 * @param {JobStatus} job
 * @param {AbortSignal} signal
 * @param {((status: JobStatus) => void) | undefined} onProgress
 * @param {() => void} cancel
 * @returns {Promise<JobStatus>} its last state
 */
function followed(job, signal, onProgress, cancel) {
  return new Promise((resolve, reject) => {
    const events = new EventSource(`/api/v1/jobs/${job.id}/events`);
    const end = () => events.close();
    signal.addEventListener("abort", () => {
      end();
      cancel();
      reject(signal.reason);
    });
    events.addEventListener("status", ({ data }) => {
      /** @type {JobStatus} */
      const status = JSON.parse(data);
      onProgress?.(status);
      if (["waiting", "running"].includes(status.state)) return;
      end();
      resolve(status);
    });
    events.onerror = () => {
      // While the service is unreachable the browser reconnects by itself; a refusal is final.
      if (events.readyState === EventSource.CLOSED) reject(new ApiError(interrupted(job)));
    };
  });
}

/** @param {JobStatus} job @returns {Problem} */
function interrupted({ state }) {
  return {
    type: "interrupted",
    status: 503,
    title: state === "cancelled" ? "It was cancelled" : "It was interrupted",
    detail: "The service stopped the computation before it was done.",
    remedy: "Run it again.",
  };
}
