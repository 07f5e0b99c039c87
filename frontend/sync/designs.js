/**
 * The designs that the service keeps.
 *
 * @import {DesignDocument} from "../types.js"
 * @import {Kept} from "./delivery.js"
 *
 * @typedef {object} Summary
 * @property {string} id
 * @property {string} name
 * @property {string} material
 * @property {number} rows
 * @property {number} columns
 * @property {number} revision
 * @property {string} changed_at
 * @property {string | null} deleted_at
 *
 * @typedef {{number: number, name: string, automatic: boolean, revision: number, created_at: string}} Version
 * @typedef {"read" | "copy"} ShareMode
 * @typedef {{id: string, mode: ShareMode, created_at: string}} Share
 * @typedef {{mode: ShareMode, document: DesignDocument, revision: number}} Shared
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
   * @returns {Promise<{designs: Summary[], next_cursor: string | null}>}
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

  /** @type {(id: string, strokes: object) => Promise<{revision: number}>} */
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

  /** @type {(id: string) => Promise<{versions: Version[]}>} */
  versions: (id) => call(at(id, "/versions")),

  /** @type {(id: string, number: number) => Promise<Version & {document: DesignDocument}>} */
  version: (id, number) => call(at(id, `/versions/${number}`)),

  /** @type {(id: string, name: string) => Promise<Version>} */
  keepVersion: (id, name) => call(at(id, "/versions"), { method: "POST", body: { name } }),

  /** @type {(id: string, number: number, revision: number) => Promise<Kept>} */
  restore: (id, number, revision) =>
    call(at(id, `/versions/${number}/restore`), { method: "POST", headers: made(revision) }),

  /** @type {(id: string) => Promise<{shares: Share[]}>} */
  shares: (id) => call(at(id, "/shares")),

  /** @type {(id: string, mode: ShareMode) => Promise<Share & {token: string}>} */
  share: (id, mode) => call(at(id, "/shares"), { method: "POST", body: { mode } }),

  /** @type {(id: string, share: string) => Promise<void>} */
  unshare: (id, share) => call(at(id, `/shares/${share}`), { method: "DELETE" }),

  /** @type {(token: string) => Promise<Shared>} */
  shared: (token) => call(`/shared/${encodeURIComponent(token)}`),

  /** @type {(token: string) => Promise<Kept>} */
  copyShared: (token) => call(`/shared/${encodeURIComponent(token)}/copy`, { method: "POST" }),
};
