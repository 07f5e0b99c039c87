/**
 * Keeps the design on show: in this browser after every step, and at the service a moment later. What
 * others change meanwhile is merged; what cannot be merged is asked.
 *
 * @import {DesignDocument, Problem, ShareMode} from "../types.js"
 * @import {Kept, Parcel} from "./delivery.js"
 * @import {Part} from "./merge.js"
 * @import {Studio} from "../state/studio.js"
 *
 * @typedef {{theirs: Kept, parts: Part[]}} Conflict
 * @typedef {{kind: "new" | "waiting" | "sending" | "kept" | "offline"}
 *   | {kind: "refused", problem: Problem}
 *   | {kind: "conflict", conflict: Conflict}
 *   | {kind: "shared", mode: ShareMode, token: string}} KeepState
 *   new: nothing was changed yet, so there is nothing to keep
 */

import { ApiError } from "../api.js";
import { DESIGN_NAME, shortName } from "../core/names.js";
import { forgetDesign, newIdentifier, saveDesign } from "../design/store.js";
import { Signal } from "../core/signal.js";
import { combine, deliver } from "./delivery.js";
import { designs } from "./designs.js";
import { drafts } from "./drafts.js";
import { same } from "./merge.js";
import { Windows } from "./windows.js";

const SAVE_MS = 250;
/** Strokes follow each other: they are sent together. */
const SEND_MS = 900;
/** Unless another window waits to show them. */
const SEND_SEEN_MS = 100;
const RETRY_MS = 4000;
/** Unanswered deliveries that are remembered. */
const MAX_SENT = 4;
/** How often the service is asked what others did. */
const LOOK_MS = 4000;

export class Keeper {
  /** @type {Signal<KeepState>} */
  state = new Signal(/** @type {KeepState} */ ({ kind: "new" }));
  /** @type {Parcel} */ #parcel;
  /** Number of the last change here; delivered ones are known by it. */
  #change = 0;
  #sentChange = 0;
  #following = false;
  /** @type {Promise<void> | null} */ #sending = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #saveTimer;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #sendTimer;
  #warned = false;
  #over = false;
  /** The service's name of the design on show while it is deleted there. @type {string | null} */ #deleted = null;
  /** Other windows of this browser. */ windows = new Windows();

  /**
   * @param {Studio} studio with the design already open
   * @param {Parcel["remote"]} remote what the service calls it, if it has it
   */
  constructor(studio, remote) {
    this.studio = studio;
    this.#parcel = this.#parcelOf(studio.designId, remote);
    const changed = () => this.#changed();
    studio.document.onSettle(changed);
    for (const signal of [studio.name, studio.materialId, studio.note, studio.machine]) {
      signal.listen(changed);
    }
    const leaving = () => {
      this.save();
      if (this.#change !== this.#sentChange) void this.#send();
    };
    window.addEventListener("pagehide", leaving);
    document.addEventListener("visibilitychange", () => {
      if (document.visibilityState === "hidden") leaving();
      else void this.look();
    });
    studio.online.listen((online) => {
      if (online) void this.catchUp();
    });
    this.windows.onChanged = (revision) => {
      if (revision > this.revision) void this.look();
    };
    this.windows.onNamed = (before, design) => void this.#adopt(before, design);
    setInterval(() => {
      const { kind } = this.state.value;
      const idle = kind === "kept" && this.#deleted !== this.remoteId;
      if (idle && studio.online.value && document.visibilityState === "visible") void this.look();
    }, LOOK_MS);
    this.windows.show(this.remoteId);
    this.save();
  }

  /** The service's name for the design on show, if it has one. */
  get remoteId() {
    return this.#parcel.remote?.id ?? null;
  }

  get revision() {
    return this.#parcel.remote?.revision ?? 0;
  }

  // --- opening ----------------------------------------------------------------------------------

  /**
   * Open a design that is not at the service yet.
   *
   * @param {DesignDocument} design
   * @param {{keep?: boolean}} [options] whether to keep it at once, and not only when it is changed
   */
  openNew(design, { keep = true } = {}) {
    this.#leave();
    const id = newIdentifier();
    this.#show({ id, remote: null, base: null, document: design }, keep);
  }

  /** Open a design of the service, with what was changed here and not delivered yet. @param {Kept} kept */
  openKept(kept) {
    this.#leave();
    const remote = { id: kept.id, revision: kept.revision };
    const unsent = drafts.get(kept.id);
    const outcome = unsent && combine(unsent, kept);
    const document = outcome?.kind === "conflict" ? unsent?.document : outcome?.parcel.document;
    const parcel = { id: kept.id, remote, base: kept.document, document: document ?? kept.document };
    this.#show({ ...parcel, sent: unsent?.sent }, !!unsent); // what left before may arrive only now
    if (outcome?.kind === "conflict") this.#clash(outcome);
  }

  /**
   * Show what a link leads to. It is nobody's to change here.
   *
   * @param {string} token
   * @param {{mode: ShareMode, document: DesignDocument}} shared
   */
  openShared(token, { mode, document }) {
    this.#leave();
    this.#follow(() => this.studio.open(document, newIdentifier()));
    this.#parcel = this.#parcelOf(this.studio.designId, null);
    this.windows.show(null);
    this.state.value = { kind: "shared", mode, token };
  }

  /** The service has changed the design on show at our request, as by restoring a version. @param {Kept} kept */
  takeOver(kept) {
    if (kept.id !== this.remoteId) return; // another design was opened meanwhile
    this.#follow(() => this.studio.follow(kept.document));
    this.#parcel = { ...this.#parcel, remote: { id: kept.id, revision: kept.revision }, base: kept.document };
    this.#acknowledged(kept.document);
  }

  /** Leave the design on show as it is; what was not delivered is kept and delivered later. */
  #leave() {
    this.save();
    clearTimeout(this.#sendTimer);
    const left = this.#parcel;
    if (this.state.value.kind !== "shared" && drafts.get(left.id)) void this.deliverOthers([left.id]);
  }

  /** @param {Parcel} parcel @param {boolean} unsent */
  #show(parcel, unsent) {
    this.#follow(() => this.studio.open(parcel.document, parcel.id));
    this.#parcel = parcel;
    this.#sentChange = this.#change;
    this.state.value = { kind: parcel.remote ? "kept" : "new" };
    this.showAddress();
    if (unsent) this.#changed();
    this.save();
  }

  // --- keeping ----------------------------------------------------------------------------------

  #changed() {
    if (this.#following || this.state.value.kind === "shared") return;
    this.#change++;
    document.documentElement.dataset.unsaved = "";
    // Writing a large chart takes as long as a stroke may: it waits for a pause in the painting.
    this.#saveTimer ??= setTimeout(() => requestIdleCallback(() => this.save(), { timeout: SAVE_MS }), SAVE_MS);
    if (this.state.value.kind === "conflict") return; // the choice comes first
    if (this.state.value.kind !== "offline") this.state.value = { kind: "waiting" };
    this.#sendLater(this.windows.others.value ? SEND_SEEN_MS : SEND_MS);
  }

  /** Keep nothing from here on: the user signs out. */
  end() {
    this.#over = true;
    forgetDesign();
  }

  /** Keep the design in this browser, now. */
  save() {
    clearTimeout(this.#saveTimer);
    this.#saveTimer = undefined;
    delete document.documentElement.dataset.unsaved;
    if (this.#over || this.state.value.kind === "shared") return;
    const { studio } = this;
    const design = studio.toDocument();
    const { id, remote } = this.#parcel;
    let safe = saveDesign({ ...design, id, remote }, studio.document.history);
    if (this.#change !== this.#sentChange) safe = drafts.put({ ...this.#parcel, document: design }) && safe;
    if (!safe && !this.#warned) {
      this.#warned = true;
      studio.tellProblem({
        type: "storage",
        status: 0,
        title: "The design cannot be saved in this browser",
        detail: "The browser's storage is full, or closed to this page.",
        remedy: "The service saves it while it can be reached; export it before you leave.",
      });
    }
  }

  /** @param {number} delay */
  #sendLater(delay) {
    clearTimeout(this.#sendTimer);
    this.#sendTimer = setTimeout(() => {
      if (this.studio.document.painting) this.#sendLater(SEND_MS);
      else void this.#send();
    }, delay);
  }

  /** Resolves once the changes made here are at the service, or delivery has failed. */
  async flushChanges() {
    if (this.#change !== this.#sentChange) await this.flush();
  }

  /**
   * Resolves once the service has the design as it is now, even an unchanged one.
   *
   * @returns {Promise<boolean>} whether it has
   */
  async flush() {
    this.save();
    if (this.#parcel.remote === null) this.#change++;
    for (let tries = 0; tries < 3 && this.#change !== this.#sentChange; tries++) await this.#send();
    return this.#change === this.#sentChange && this.#parcel.remote !== null;
  }

  async #send() {
    clearTimeout(this.#sendTimer);
    if (this.#sending) await this.#sending;
    // In a conflict the choice comes first.
    if (this.#change === this.#sentChange || ["shared", "conflict"].includes(this.state.value.kind)) return;
    this.#sending = this.#deliver().finally(() => (this.#sending = null));
    await this.#sending;
  }

  async #deliver() {
    const change = this.#change;
    const sent = this.studio.toDocument();
    const parcel = { ...this.#parcel, document: sent };
    if (parcel.remote)
      parcel.sent = [...(parcel.sent ?? []).filter((other) => !same(other, sent)), sent].slice(-MAX_SENT);
    if (!parcel.remote) parcel.posted ??= sent;
    this.#parcel = parcel;
    drafts.put(parcel); // before it leaves, so that an answer that is lost does no harm
    this.state.value = { kind: "sending" };
    try {
      const outcome = await deliver(parcel, designs);
      // Changes of others are applied between strokes, never within one.
      await this.studio.document.rested();
      if (this.#parcel.id !== parcel.id) return; // another design was opened meanwhile
      if (outcome.kind === "conflict") this.#clash(outcome);
      else this.#delivered(outcome, change, sent);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (this.#parcel.id !== parcel.id) return;
      this.#failed(error);
    }
  }

  /**
   * @param {{kind: "kept" | "merged", parcel: Parcel}} outcome
   * @param {number} change
   * @param {DesignDocument} sent
   */
  #delivered({ kind, parcel }, change, sent) {
    if (this.#parcel.remote === null && parcel.remote) {
      drafts.drop(parcel.id);
      this.windows.named(parcel.id, parcel.remote.id);
      parcel = { ...parcel, id: parcel.remote.id }; // from now on it goes by the service's name
    }
    this.#parcel = parcel;
    this.showAddress();
    if (kind === "merged") {
      this.#merge(parcel.document, sent);
      return;
    }
    this.#sentChange = change;
    const base = parcel.base ?? sent;
    // The first delivery of all may have been of an older state, sent again for its answer.
    if (!same(base, parcel.document)) this.#sentChange = change - 1;
    if (this.#sentChange === this.#change) this.#acknowledged(base);
    else {
      this.state.value = { kind: "waiting" };
      this.#sendLater(0);
    }
  }

  /**
   * Show what others changed, and deliver what is only here.
   *
   * @param {DesignDocument} merged of `sent` and theirs
   * @param {DesignDocument} sent
   */
  #merge(merged, sent) {
    const now = this.studio.toDocument();
    const outcome = combine(
      { ...this.#parcel, base: sent, document: now },
      { id: this.#parcel.remote?.id ?? "", revision: this.revision, document: merged },
    );
    // What changed here during the delivery stays; where it cannot, it wins, and theirs is a version.
    const document = outcome.kind === "conflict" ? now : outcome.parcel.document;
    this.#follow(() => this.studio.follow(document));
    this.#change++;
    this.save();
    this.studio.tell("Changes from another window or person are now in this design, too.");
    this.#sendLater(0);
  }

  /** @param {DesignDocument} document */
  #acknowledged(document) {
    this.#parcel = { ...this.#parcel, base: document, document, sent: [] };
    this.#sentChange = this.#change;
    drafts.drop(this.#parcel.id);
    this.save();
    this.state.value = { kind: "kept" };
    this.#deleted = null;
    this.windows.delivered(this.revision);
  }

  /** @param {ApiError} error */
  #failed(error) {
    if (error.offline) {
      this.state.value = { kind: "offline" };
      this.#sendLater(RETRY_MS);
    } else if (error.problem.status >= 500 || error.passing) {
      this.state.value = { kind: "waiting" };
      this.#sendLater(RETRY_MS);
    } else {
      this.state.value = { kind: "refused", problem: error.problem };
      this.studio.tellProblem({ ...error.problem, title: "The service does not save this design" });
    }
  }

  // --- others -----------------------------------------------------------------------------------

  /** After a start or an absence: see what others did, and deliver what was left. */
  async catchUp() {
    await this.look();
    await this.deliverOthers();
  }

  /**
   * Another window has delivered the design that this one shows, too: unless it was changed here meanwhile, it
   * is the same design, and not another one with the next stroke.
   *
   * @param {string} before
   * @param {string} id
   */
  async #adopt(before, id) {
    if (this.#parcel.id !== before || this.remoteId || this.#change !== this.#sentChange) return;
    const document = this.studio.toDocument();
    this.#parcel = { id, remote: { id, revision: 0 }, base: document, document }; // of no revision yet: look for it
    this.showAddress();
    await this.look();
  }

  /** See whether somebody else has changed the design. */
  async look() {
    const { id, remote } = this.#parcel;
    const { kind } = this.state.value;
    if (this.#change !== this.#sentChange) {
      if (kind !== "conflict" && kind !== "shared") await this.#send();
      return;
    }
    if (!remote || this.#sending || this.studio.document.painting) return;
    try {
      const theirs = await designs.newer(remote.id, remote.revision);
      const { painting } = this.studio.document;
      if (this.#parcel.id !== id || this.#change !== this.#sentChange || painting) return;
      if (theirs) this.takeOver(theirs);
      else this.state.value = { kind: "kept" };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // Deleted elsewhere: it stays here, and the next change brings it back.
      if (error.problem.status !== 404) this.#failed(error);
      else this.#deleted = remote.id;
    }
  }

  /** Deliver designs that were left before the service had them. @param {string[]} [only] */
  async deliverOthers(only) {
    for (let parcel of drafts.all()) {
      if (parcel.id === this.#parcel.id || (only && !only.includes(parcel.id))) continue;
      try {
        for (let tries = 0; tries < 3; tries++) {
          if (!parcel.remote) drafts.put({ ...parcel, posted: (parcel.posted ??= parcel.document) });
          const outcome = await deliver(parcel, designs);
          if (outcome.kind === "conflict") {
            // Nobody is looking at it now: keep both.
            const name = shortName(parcel.document.name, DESIGN_NAME, " (changed here)");
            await designs.create({ ...parcel.document, name }, newIdentifier());
            break;
          }
          parcel = outcome.parcel;
          if (parcel.base && same(parcel.base, parcel.document)) break;
        }
        drafts.drop(parcel.id);
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        return; // it stays in this browser and is tried again
      }
    }
  }

  /** @param {Conflict} conflict */
  #clash({ theirs, parts }) {
    this.save();
    this.state.value = { kind: "conflict", conflict: { theirs, parts } };
  }

  /**
   * Settle a conflict. Nothing is lost in any way of it.
   *
   * @param {"mine" | "theirs" | "both"} choice mine: theirs stays as a version; theirs: mine goes to
   *   the deleted designs; both: mine becomes a design of its own
   */
  async resolve(choice) {
    const { state } = this;
    if (state.value.kind !== "conflict") return;
    const { theirs } = state.value.conflict;
    const mine = this.studio.toDocument();
    const remote = { id: theirs.id, revision: theirs.revision };
    if (choice === "mine") {
      await designs.keepVersion(theirs.id, "Before another copy replaced it");
      this.#parcel = { ...this.#parcel, remote, base: theirs.document };
      state.value = { kind: "waiting" };
      this.#change++;
      await this.#send();
      return;
    }
    const copy = await designs.create({ ...mine, name: shortName(mine.name, DESIGN_NAME, " (mine)") }, newIdentifier());
    drafts.drop(this.#parcel.id);
    this.#sentChange = this.#change;
    if (choice === "theirs") {
      await designs.remove(copy.id);
      state.value = { kind: "kept" };
      this.takeOver(theirs);
    } else this.openKept(copy);
  }

  // --- small things -----------------------------------------------------------------------------

  /** Changes that come from the service are not delivered back to it. @param {() => void} change */
  #follow(change) {
    this.#following = true;
    try {
      change();
    } finally {
      this.#following = false;
    }
  }

  /** @param {string} id @param {Parcel["remote"]} remote @returns {Parcel} */
  #parcelOf(id, remote) {
    const unsent = drafts.get(id);
    const document = this.studio.toDocument();
    if (unsent) {
      this.#change++; // the service has not acknowledged it
      this.state.value = { kind: "waiting" };
      return { ...unsent, document };
    }
    if (remote) this.state.value = { kind: "kept" };
    // Without an entry of its own, what this browser has is what the service acknowledged.
    // A new design is delivered as it was opened first, and its strokes after that: another window that opened
    // the same one does likewise, so that both mean one design.
    return { id, remote, base: remote && document, document, posted: remote ? null : document };
  }

  /** So that a reload and a bookmark lead to the design again. */
  showAddress() {
    this.windows.show(this.remoteId);
    const hash = this.remoteId ? `#design/${this.remoteId}` : "";
    if (location.hash !== hash) history.replaceState(null, "", location.pathname + location.search + hash);
  }
}
