/**
 * Delivers what was changed here to the service. It knows nothing of the page, so that every way in
 * which a delivery can go is tested without one.
 *
 * @import {DesignDocument, Painted, Strokes} from "../types.js"
 *
 * @typedef {object} Parcel a design with changes that the service has not acknowledged
 * @property {string} id this browser's name for the design; makes a first delivery happen once
 * @property {{id: string, revision: number} | null} remote the service's name for it
 * @property {DesignDocument | null} base what the service has acknowledged last
 * @property {DesignDocument} document what it should have
 * @property {DesignDocument[]} [sent] what left since, and may have arrived although no answer came
 * @property {DesignDocument | null} [posted] what the first delivery sends, every time until it is answered
 *
 * @typedef {object} Kept the design as the service has it
 * @property {string} id
 * @property {number} revision
 * @property {DesignDocument} document
 *
 * @typedef {object} Service
 * @property {(document: DesignDocument, key: string) => Promise<Kept>} create
 * @property {(id: string) => Promise<Kept>} read
 * @property {(id: string, document: DesignDocument, revision: number) => Promise<Kept>} replace
 * @property {(id: string, strokes: Strokes) => Promise<Pick<Painted, "revision">>} paint
 * @property {(id: string) => Promise<Kept>} recover
 *
 * @typedef {{kind: "kept", parcel: Parcel} | {kind: "merged", parcel: Parcel} |
 *   {kind: "conflict", theirs: Kept, parts: import("./merge.js").Part[]}} Outcome
 *   merged: the parcel's document has changes of somebody else in it; `base` is what they left
 */

import { ApiError } from "../api.js";
import { merge, same, strokesBetween } from "./merge.js";

/** The service takes at most this many runs of stitches at once. */
const MAX_RUNS = 2000;

/**
 * @param {Parcel} parcel
 * @param {Service} service
 * @returns {Promise<Outcome>}
 * @throws {ApiError} if the service cannot be reached or refuses; the parcel stays as it is
 */
export async function deliver(parcel, service) {
  const { id, remote, base, document } = parcel;
  if (!remote || !base) {
    return create(parcel, `page-${id}`, parcel.posted ?? document, service);
  }
  if (same(base, document)) return { kind: "kept", parcel };
  try {
    // Strokes clear other stitches where they paint: with such stitches, the whole is sent.
    const strokes =
      !document.other_stitches?.length && same({ ...base, chart: document.chart }, document)
        ? strokesBetween(base.chart, document.chart)
        : null;
    if (strokes && strokes.runs.length <= MAX_RUNS) {
      // Strokes merge at the service; only if somebody else was there do we have to look.
      const { revision } = await service.paint(remote.id, strokes);
      if (revision === remote.revision + 1) return settled(parcel, remote.id, revision, document);
      return combine(parcel, await service.read(remote.id));
    }
    const kept = await service.replace(remote.id, document, remote.revision);
    return settled(parcel, kept.id, kept.revision, document);
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    const { status } = error.problem;
    if (status === 412 || status === 409) return combine(parcel, await service.read(remote.id));
    if (status === 404) return revive(parcel, remote.id, service);
    throw error;
  }
}

/**
 * What is here and what the service has by now, as one. What the service has of our own, since an answer was lost,
 * is no change of somebody else.
 *
 * @param {Parcel} parcel
 * @param {Kept} theirs
 * @returns {Outcome}
 */
export function combine(parcel, theirs) {
  const { document } = parcel;
  const own = parcel.sent?.some((sent) => same(sent, theirs.document));
  const base = own ? null : parcel.base;
  const { document: merged, conflicts } = merge(base ?? theirs.document, document, theirs.document);
  if (conflicts.length) return { kind: "conflict", theirs, parts: conflicts };
  const remote = { id: theirs.id, revision: theirs.revision };
  return {
    kind: own || (same(merged, document) && same(merged, theirs.document)) ? "kept" : "merged",
    parcel: { ...parcel, remote, base: theirs.document, document: merged, sent: [], posted: null },
  };
}

/**
 * Deleted by somebody while it was changed here: the change brings it back.
 *
 * @param {Parcel} parcel
 * @param {string} id
 * @param {Service} service
 * @returns {Promise<Outcome>}
 */
async function revive(parcel, id, service) {
  try {
    return combine(parcel, await service.recover(id));
  } catch (error) {
    if (!(error instanceof ApiError) || error.problem.status !== 404) throw error;
    // Gone for good, as after restoring an older backup: store it as a new design.
    return create(parcel, `page-${parcel.id}-${id}`, parcel.document, service);
  }
}

/**
 * @param {Parcel} parcel
 * @param {string} key
 * @param {DesignDocument} document
 * @param {Service} service
 * @returns {Promise<Outcome>}
 */
async function create(parcel, key, document, service) {
  try {
    const kept = await service.create(document, key);
    return settled(parcel, kept.id, kept.revision, document);
  } catch (error) {
    // Another window began with the same design and was faster: ours becomes one of its own.
    if (!(error instanceof ApiError) || error.problem.field !== "Idempotency-Key") throw error;
    const kept = await service.create(document, `${key}-${Math.random().toString(36).slice(2)}`);
    return settled(parcel, kept.id, kept.revision, document);
  }
}

/**
 * @param {Parcel} parcel
 * @param {string} id
 * @param {number} revision
 * @param {DesignDocument} base
 * @returns {Outcome}
 */
function settled(parcel, id, revision, base) {
  return { kind: "kept", parcel: { ...parcel, remote: { id, revision }, base, sent: [], posted: null } };
}
