// SPDX-License-Identifier: BSD-3-Clause
/** Finds the point under the pointer, shows its data, and measures the distance of two points. */
class Picker {
  /** @param {CloudViewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.info = el('dl', {class: 'facts', 'aria-live': 'polite'});
    this.isMeasuring = false;
    /** @type {number | null} */
    this.picked = null;
    /** @type {number[]} what is measured between */
    this.ends = [];
  }

  /**
   * The foremost of the points near a place on the screen.
   * @param {number} x
   * @param {number} y
   * @returns {number | null}
   */
  pointAt(x, y) {
    const near = 8;  // [pixels]
    const {viewer} = this;
    const {cloud, camera, mix, low, high, hidden} = viewer;
    const {back} = camera.axes();
    const eye = camera.eye();
    const lasers = cloud.column('laser');
    let best = null, least = Infinity;
    for (let i = 0; i < cloud.points; ++i) {
      const p = cloud.at(i, mix);
      if (p.some((v, axis) => v < low[axis] || v > high[axis])) continue;
      if (hidden.has(lasers[i])) continue;
      const at = viewer.project(p);
      if (!at) continue;
      const off = Math.hypot(at[0] - x, at[1] - y);
      if (off > near) continue;
      // A pixel aside counts as much as half a hundredth of the depth.
      const cost = dot(plus(eye, p, -1), back) * (1 + 0.005 * off);
      if (cost < least) [best, least] = [i, cost];
    }
    return best;
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  tap(x, y) {
    const found = this.pointAt(x, y);
    if (this.isMeasuring && found !== null) this.ends = this.ends.length === 1 ? [this.ends[0], found] : [found];
    this.picked = found;
    this.describe();
    this.viewer.show();
  }

  /** What is known of the point that was picked. */
  describe() {
    const facts = this.picked === null ? [] : this.facts(this.picked);
    if (this.ends.length === 2) {
      const [a, b] = this.ends.map((i) => this.viewer.cloud.at(i, this.viewer.mix));
      const apart = b.map((v, axis) => (v - a[axis]).toFixed(3));
      facts.push(['measured', `${distanceBetween(a, b).toFixed(3)} m (${apart.join(', ')})`]);
    }
    this.info.replaceChildren(...facts.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, value)]));
  }

  /**
   * @param {number} i
   * @returns {[string, string][]}
   */
  facts(i) {
    const value = (/** @type {string} */ name) => this.viewer.cloud.column(name)[i];
    /** @type {[string, string, number, string][]} */
    const numbers = [['range', 'range', 3, 'm'], ['incidence', 'incidence', 0, '°'], ['time', 'time', 3, 's'], ['remission', 'remission', 0, '']];
    /** @type {[string, string][]} */
    const facts = [['laser', this.viewer.laserName(value('laser'))], ['beam', String(value('beam'))]];
    for (const [name, column, digits, unit] of numbers) {
      const number = value(column);
      if (number === undefined) continue;
      facts.push([name, Number.isNaN(number) ? 'no flat surface' : `${number.toFixed(digits)} ${unit}`]);
    }
    const distance = shownValues(this.viewer.cloud, 'distance', this.viewer.mix >= 0.5)[i];
    facts.push(['off its surface', Number.isFinite(distance) ? `${distance.toFixed(0)} mm` : 'no flat surface']);
    facts.push(['at', this.viewer.cloud.at(i, this.viewer.mix).map((v) => v.toFixed(3)).join(', ') + ' m']);
    return facts;
  }

  toggleMeasuring() {
    this.isMeasuring = !this.isMeasuring;
    this.ends = [];
    this.describe();
  }

  clear() {
    this.ends = [];
    this.picked = null;
    this.describe();
  }
}
