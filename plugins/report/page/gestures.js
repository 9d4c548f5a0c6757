// SPDX-License-Identifier: BSD-3-Clause
/**
 * Mouse, pen and fingers: one turns, two (or with shift, or the other button) pan and zoom, the wheel zooms, a tap
 * picks.
 */
class Gestures {
  /**
   * @param {HTMLElement} element
   * @param {{orbit: (dx: number, dy: number) => void, pan: (dx: number, dy: number) => void,
   *          zoom: (factor: number) => void, tap: (x: number, y: number) => void,
   *          focus: (x: number, y: number) => void}} act  distances in pixels
   */
  constructor(element, act) {
    this.act = act;
    /** @type {Map<number, {x: number, y: number}>} */
    this.down = new Map();
    this.moved = 0;
    element.addEventListener('pointerdown', (event) => this.press(element, event));
    element.addEventListener('pointermove', (event) => this.move(event));
    for (const end of ['pointerup', 'pointercancel']) {
      element.addEventListener(end, (event) => this.release(/** @type {PointerEvent} */ (event)));
    }
    element.addEventListener('wheel', (event) => {
      event.preventDefault();
      act.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(0.25, Math.abs(event.deltaY) / 500)));
    }, {passive: false});
    element.addEventListener('dblclick', (event) => act.focus(event.offsetX, event.offsetY));
    element.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /**
   * @param {HTMLElement} element
   * @param {PointerEvent} event
   */
  press(element, event) {
    element.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, {x: event.offsetX, y: event.offsetY});
    if (this.down.size === 1) this.moved = 0;
  }

  /** Middle of all that press, and how far apart they are. */
  spread() {
    const all = [...this.down.values()];
    const x = all.reduce((sum, p) => sum + p.x, 0) / all.length;
    const y = all.reduce((sum, p) => sum + p.y, 0) / all.length;
    return {x, y, apart: Math.max(1, Math.hypot(all[0].x - x, all[0].y - y))};
  }

  /** @param {PointerEvent} event */
  move(event) {
    if (!this.down.has(event.pointerId)) return;
    const before = this.spread();
    this.down.set(event.pointerId, {x: event.offsetX, y: event.offsetY});
    const now = this.spread();
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    this.moved += Math.abs(dx) + Math.abs(dy);
    if (this.down.size > 1) {
      this.act.pan(dx, dy);
      this.act.zoom(before.apart / now.apart);
    } else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) {
      this.act.pan(dx, dy);
    } else {
      this.act.orbit(dx, dy);
    }
  }

  /** @param {PointerEvent} event */
  release(event) {
    const still = 4;  // [pixels]
    if (this.down.size === 1 && this.moved < still && event.type === 'pointerup' && event.button === 0)
      this.act.tap(event.offsetX, event.offsetY);
    this.down.delete(event.pointerId);
  }
}
