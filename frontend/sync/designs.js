/**
 * The designs that the service keeps.
 *
 * @import {DesignDocument, DesignPage, NewShare, Painted, SharedDesign, ShareMode, Shares, Strokes, Version,
 *   Versions, VersionSummary} from "../types.js"
 * @import {Kept} from "./delivery.js"
 */

import { call } from "../api.js";

/** @param {string} id @param {string} [rest] */
const at = (id, rest = "") => `/designs/${encodeURIComponent(id)}${rest}`;
/** @param {number} revision */
const made = (revision) => ({ "If-Match": `"${revision}"` });
/** Bodies beyond this size may not outlive the page that sends them. */
const KEEPALIVE_BYTES = 50_000;

export const designs = {
  /**
   * @param {{cursor?: string | null, deleted?: boolean}} [options]
   * @returns {Promise<DesignPage>}
   */
  list: ({ cursor, deleted = false } = {}) =>
    call(`/designs?limit=60&deleted=${deleted}${cursor ? `&cursor=${encodeURIComponent(cursor)}` : ""}`),

  /** @type {(document: DesignDocument, key: string) => Promise<Kept>} */
  create: (document, key) => call("/designs", { method: "POST", body: document, headers: { "Idempotency-Key": key } }),

  /** @type {(id: string) => Promise<Kept>} */
  read: (id) => call(at(id)),

  /**
   * The design, if it is another revision by now.
   *
   * @type {(id: string, revision: number) => Promise<Kept | undefined>}
   */
  newer: (id, revision) => call(at(id), { headers: { "If-None-Match": `"${revision}"` } }),

  /** @type {(id: string, document: DesignDocument, revision: number) => Promise<Kept>} */
  replace: (id, document, revision) => call(at(id), { method: "PUT", body: document, headers: made(revision) }),

  /** @type {(id: string, strokes: Strokes) => Promise<Painted>} */
  paint: (id, strokes) =>
    call(at(id, "/strokes"), {
      method: "POST",
      body: strokes,
      keepalive: JSON.stringify(strokes).length < KEEPALIVE_BYTES,
    }),

  /** @type {(id: string, name: string, revision: number) => Promise<Kept>} */
  rename: (id, name, revision) => call(at(id), { method: "PATCH", body: { name }, headers: made(revision) }),

  /** @type {(id: string) => Promise<Kept>} */
  duplicate: (id) => call(at(id, "/duplicate"), { method: "POST" }),

  /** @type {(id: string) => Promise<void>} */
  remove: (id) => call(at(id), { method: "DELETE" }),

  /** @type {(id: string) => Promise<Kept>} */
  recover: (id) => call(at(id, "/recover"), { method: "POST" }),

  /** @type {(id: string) => Promise<Versions>} */
  versions: (id) => call(at(id, "/versions")),

  /** @type {(id: string, number: number) => Promise<Version>} */
  version: (id, number) => call(at(id, `/versions/${number}`)),

  /** @type {(id: string, name: string) => Promise<VersionSummary>} */
  keepVersion: (id, name) => call(at(id, "/versions"), { method: "POST", body: { name } }),

  /** @type {(id: string, number: number, revision: number) => Promise<Kept>} */
  restore: (id, number, revision) =>
    call(at(id, `/versions/${number}/restore`), { method: "POST", headers: made(revision) }),

  /** @type {(id: string) => Promise<Shares>} */
  shares: (id) => call(at(id, "/shares")),

  /** @type {(id: string, mode: ShareMode) => Promise<NewShare>} */
  share: (id, mode) => call(at(id, "/shares"), { method: "POST", body: { mode } }),

  /** @type {(id: string, share: string) => Promise<void>} */
  unshare: (id, share) => call(at(id, `/shares/${share}`), { method: "DELETE" }),

  /** @type {(token: string) => Promise<SharedDesign>} */
  shared: (token) => call(`/shared/${encodeURIComponent(token)}`),

  /** @type {(token: string) => Promise<Kept>} */
  copyShared: (token) => call(`/shared/${encodeURIComponent(token)}/copy`, { method: "POST" }),
};
