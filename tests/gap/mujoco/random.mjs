// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Random numbers of a seed: the same on every machine. Source: mulberry32, T. Ettinger (public domain).
export class Random {
  #state;

  constructor(seed) {
    this.#state = seed >>> 0;
  }
  /** From 0 to below 1. */
  share() {
    this.#state = (this.#state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(this.#state ^ (this.#state >>> 15), 1 | this.#state);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  }
  between(low, high) {
    return low + (high - low) * this.share();
  }
  sign() {
    return this.share() < 0.5 ? -1 : 1;
  }
  normal() {
    return Math.sqrt(-2 * Math.log(1 - this.share())) * Math.cos(2 * Math.PI * this.share());
  }
  one(list) {
    return list[Math.floor(this.share() * list.length)];
  }
  shuffled(list) {
    const order = list.map((item) => [this.share(), item]);
    return order.sort((a, b) => a[0] - b[0]).map(([, item]) => item);
  }
}
