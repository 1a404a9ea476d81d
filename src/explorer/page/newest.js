// @ts-check
// Requests of which only the newest matters: whoever waits for an answer is shown what was wanted last.
//
// What follows a pointer goes through `OneAtATime`: while one request is on its way, only the newest other waits. Edits by dragging
// (`state.js`), inverse posing and handles (`handles.js`) do. What is asked for now and then goes at once, and `Newest` tells whether
// something newer was asked for since, so that the answer is dropped: maps, matches, figures, curves, pictures, gestures, commands.
//
// Frames (`frames.js`) are neither. Their next request is on its way before the answer to the last one is drawn, which inverse posing
// could not do, as its next search begins where the last one ended; what they want is wherever the probe is when it is asked for, and
// stays wanted until there is a scene.

/**
 * One request at a time; of those that are wanted meanwhile the newest is next, and the others are never made.
 * @template T
 */
export class OneAtATime {
  /** @param {(what: T) => Promise<void>} work Asks for what is wanted and takes the answer, or says what went wrong. */
  constructor(work) {
    this.work = work;
    /** @type {T | undefined} */
    this.waiting = undefined;
    this.isWaiting = false;
    /** @type {Promise<void> | null} */
    this.working = null;
  }

  /**
   * Asks at once if nothing is on its way. Resolves when nothing is wanted any more.
   * @type {(what: T) => Promise<void>}
   */
  want(what) {
    this.waiting = what;
    this.isWaiting = true;
    return (this.working ??= this.run());
  }

  /** What waits is not wanted any more. */
  forget() {
    this.waiting = undefined;
    this.isWaiting = false;
  }

  async run() {
    try {
      while (this.isWaiting) {
        const what = /** @type {T} */ (this.waiting);
        this.forget();
        await this.work(what);
      }
    } finally {
      this.working = null;
    }
  }
}

/** Requests that are made whenever they are wanted, counted to know the newest. */
export class Newest {
  constructor() {
    this.count = 0;
  }

  /** One more is made, or what is on its way is not wanted any more: its number. */
  begin() {
    return ++this.count;
  }

  /**
   * Whether nothing newer has begun.
   * @type {(number: number) => boolean}
   */
  is(number) {
    return number === this.count;
  }
}
