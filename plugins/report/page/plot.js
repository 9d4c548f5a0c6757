// SPDX-License-Identifier: BSD-3-Clause
/**
 * Round numbers in a range.
 * @param {number} low
 * @param {number} high
 * @param {number} [most]
 * @returns {number[]}
 */
function ticks(low, high, most = 6) {
  if (!(high > low)) return [low];
  const raw = (high - low) / most;
  const decade = 10 ** Math.floor(Math.log10(raw));
  const step = decade * ([1, 2, 5, 10].find((k) => k * decade >= raw) || 10);
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) list.push(Number((k * step).toPrecision(12)));
  return list;
}

/**
 * Powers of ten in a range of logarithms, and 2 and 5 times these where the range is short.
 * @param {number} low
 * @param {number} high
 * @returns {number[]}
 */
function decades(low, high) {
  const factors = high - low < 3 ? [1, 2, 5] : [1];
  const list = [];
  for (let power = Math.floor(low); power <= high; ++power) {
    for (const factor of factors) {
      const at = power + Math.log10(factor);
      if (at >= low && at <= high) list.push(Number((factor * 10 ** power).toPrecision(3)));
    }
  }
  return list;
}

/** The frame of a plot: from numbers to pixels. */
class PlotFrame {
  /**
   * @param {{x: [number, number], y: [number, number], xLabel: string, yLabel: string, isLogarithmic?: boolean,
   *          isExact?: boolean, kinds?: {at: number, name: string}[]}} axes
   *   y of a logarithmic axis: decimal logarithms; exact: without a margin; kinds: names in place of numbers along x
   */
  constructor({x, y, xLabel, yLabel, isLogarithmic = false, isExact = false, kinds = []}) {
    const margin = (/** @type {[number, number]} */ [low, high]) => {
      const extra = high > low ? 0.04 * (high - low) : Math.max(0.5, 0.04 * Math.abs(low));
      return isExact && high > low ? [low, high] : [low - extra, high + extra];
    };
    // [pixels]
    this.width = 640;
    this.height = 240;
    this.left = 58;
    this.right = 12;
    this.top = 10;
    this.bottom = 42;
    this.x = margin(x);
    this.y = margin(y);
    this.xLabel = xLabel;
    this.yLabel = yLabel;
    this.isLogarithmic = isLogarithmic;
    this.kinds = kinds;
  }

  /** @param {number} value */
  px(value) {
    return this.left + (this.width - this.left - this.right) * (value - this.x[0]) / (this.x[1] - this.x[0]);
  }

  /** @param {number} value */
  py(value) {
    const at = this.isLogarithmic ? Math.log10(Math.max(value, 1e-300)) : value;
    return this.height - this.bottom - (this.height - this.top - this.bottom) * (at - this.y[0]) / (this.y[1] - this.y[0]);
  }

  /**
   * The numbers at a place in pixels, y of a logarithmic axis as a logarithm.
   * @param {number} px
   * @param {number} py
   * @returns {[number, number]}
   */
  numbersAt(px, py) {
    return [this.x[0] + (this.x[1] - this.x[0]) * (px - this.left) / (this.width - this.left - this.right),
            this.y[0] + (this.y[1] - this.y[0]) * (this.height - this.bottom - py) / (this.height - this.top - this.bottom)];
  }

  /** @returns {Child[]} */
  xMarks() {
    const foot = this.height - this.bottom;
    if (this.kinds.length > 0) {
      return this.kinds.filter(({at}) => at >= this.x[0] && at <= this.x[1])
        .map(({at, name}) => svg('text', {x: this.px(at), y: foot + 15, 'text-anchor': 'middle'}, name));
    }
    return ticks(this.x[0], this.x[1], 8).flatMap((at) => [
      svg('path', {class: 'grid', d: `M${this.px(at)} ${this.top}V${foot}`}),
      svg('text', {x: this.px(at), y: foot + 15, 'text-anchor': 'middle'}, at)]);
  }

  /** @returns {Child[]} */
  yMarks() {
    const values = this.isLogarithmic ? decades(this.y[0], this.y[1]) : ticks(this.y[0], this.y[1], 5);
    return values.flatMap((at) => [
      svg('path', {class: 'grid', d: `M${this.left} ${this.py(at)}H${this.width - this.right}`}),
      svg('text', {x: this.left - 5, y: this.py(at) + 4, 'text-anchor': 'end'}, at)]);
  }

  /**
   * @param {...Child} children
   * @returns {SVGElement}
   */
  draw(...children) {
    const middle = (this.left + this.width - this.right) / 2;
    const foot = this.height - this.bottom;
    return svg('svg', {viewBox: `0 0 ${this.width} ${this.height}`, class: 'plot', role: 'img', 'aria-label': `${this.yLabel} over ${this.xLabel}`},
      ...this.xMarks(), ...this.yMarks(),
      svg('text', {x: middle, y: this.height - 6, 'text-anchor': 'middle'}, this.xLabel),
      svg('text', {x: -(this.top + foot) / 2, y: 13, 'text-anchor': 'middle', transform: 'rotate(-90)'}, this.yLabel),
      ...children);
  }
}

/**
 * @param {(number | null)[]} values
 * @returns {[number, number]}
 */
function extentOf(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const v of values) {
    if (v === null || !Number.isFinite(v)) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  return low <= high ? [low, high] : [0, 1];
}

/**
 * A curve that breaks at nulls.
 * @param {(number | null)[]} x
 * @param {(number | null)[]} y
 * @param {string} xLabel
 * @param {string} yLabel
 */
function linePlot(x, y, xLabel, yLabel) {
  const frame = new PlotFrame({x: extentOf(x), y: extentOf(y), xLabel, yLabel});
  let path = '', isDown = false;
  x.forEach((at, i) => {
    const value = y[i];
    if (at === null || value === null) { isDown = false; return; }
    path += `${isDown ? 'L' : 'M'}${frame.px(at).toFixed(1)} ${frame.py(value).toFixed(1)}`;
    isDown = true;
  });
  return frame.draw(svg('path', {class: 'curve', d: path}));
}
