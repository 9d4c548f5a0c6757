// SPDX-License-Identifier: BSD-3-Clause
const SERIES_COLOURS = ['var(--series1)', 'var(--series2)', 'var(--series3)', 'var(--series4)', 'var(--series5)'];

/**
 * A curve, its bars and its points.
 * @param {PanelData} data
 * @param {PanelSeries} series
 * @param {number} number
 * @param {PlotFrame} frame
 * @returns {SVGElement[]}
 */
function drawnSeries(data, series, number, frame) {
  const colour = SERIES_COLOURS[number % SERIES_COLOURS.length];
  const isLine = series.joined && data.kinds.length === 0;
  const beside = data.kinds.length > 0 ? 12 * (number - 0.5 * (data.series.length - 1)) : 0;  // [pixels]
  const points = shownPoints(data, series);
  const has = new Set(points.map(({i}) => i));
  let line = '', bars = '';
  const dots = [];
  for (const {i, x, y, error} of points) {
    const [px, py] = [frame.px(x) + beside, frame.py(y)];
    if (error > 0) bars += `M${px.toFixed(1)} ${frame.py(y - error).toFixed(1)}V${frame.py(y + error).toFixed(1)}`;
    if (isLine && (has.has(i - 1) || has.has(i + 1))) line += `${has.has(i - 1) ? 'L' : 'M'}${px.toFixed(1)} ${py.toFixed(1)}`;
    else dots.push(svg('circle', {cx: px, cy: py, r: 2.2, fill: colour}));
  }
  return [line && svg('path', {d: line, fill: 'none', stroke: colour, 'stroke-width': 1.6}),
          bars && svg('path', {d: bars, fill: 'none', stroke: colour, 'stroke-width': 0.8}), ...dots].filter(Boolean);
}

/**
 * @param {{at: number, around: number}} mark
 * @param {PlotFrame} frame
 */
function drawnMark({at, around}, frame) {
  const height = frame.height - frame.bottom - frame.top;
  return [around > 0 && svg('rect', {x: frame.px(at - around), y: frame.top, width: frame.px(at + around) - frame.px(at - around), height, class: 'band'}),
          svg('path', {d: `M${frame.px(at)} ${frame.top}v${height}`, class: 'mark'})];
}

let panelCount = 0;

/** A plot that zooms: drag a rectangle, or use the keys + − 0 and the arrows; a double click shows all again. */
class PanelPlot {
  /**
   * @param {PanelData} data
   * @param {[number, number]} [scale]  of y, in place of what the data have
   */
  constructor(data, scale) {
    this.data = data;
    this.clip = `panel-clip-${panelCount++}`;
    this.whole = panelRange(data);
    this.home = {x: this.whole.x, y: scale || this.whole.y};
    this.frame = this.frameOf(this.home, false);
    this.place = el('div');
    this.element = el('figure', {class: 'panel', tabindex: 0, 'aria-label': `${data.title}: drag or + to zoom, 0 shows all`, onkeydown: (/** @type {KeyboardEvent} */ event) => this.press(event)},
      el('figcaption', {}, data.title, ' ', ...this.legend()), this.place);
    this.show(this.home, false);
  }

  legend() {
    return [...this.data.series.map(({name}, k) => el('span', {class: 'key'}, svg('svg', {width: 12, height: 8}, svg('rect', {width: 12, height: 3, y: 3, fill: SERIES_COLOURS[k % SERIES_COLOURS.length]})), name)),
            ...this.data.marks.map(({name}) => el('span', {class: 'key alarm'}, name))];
  }

  /**
   * Shows all, with this range of y or that of the data.
   * @param {[number, number]} [scale]
   */
  setScale(scale) {
    this.home = {x: this.whole.x, y: scale || this.whole.y};
    this.show(this.home, false);
  }

  /**
   * @param {PanelRange} range
   * @param {boolean} isExact  without a margin
   */
  frameOf(range, isExact) {
    const {data} = this;
    return new PlotFrame({...range, xLabel: data.x_label, yLabel: data.y_label, isLogarithmic: data.logarithmic, isExact, kinds: data.kinds});
  }

  /**
   * @param {PanelRange} range
   * @param {boolean} isExact
   */
  show(range, isExact) {
    const {data} = this;
    const frame = this.frame = this.frameOf(range, isExact);
    const [width, height] = [frame.width - frame.left - frame.right, frame.height - frame.top - frame.bottom];
    const picture = frame.draw(
      svg('clipPath', {id: this.clip}, svg('rect', {x: frame.left, y: frame.top, width, height})),
      svg('g', {'clip-path': `url(#${this.clip})`}, ...data.series.flatMap((series, k) => drawnSeries(data, series, k, frame)),
        ...data.marks.flatMap((mark) => drawnMark(mark, frame))),
      svg('rect', {x: frame.left, y: frame.top, width, height, class: 'frame'}));
    this.listen(picture);
    this.place.replaceChildren(picture);
  }

  /**
   * @param {SVGElement} picture
   * @param {PointerEvent} event
   * @returns {[number, number]}  in the plot's own pixels, within the frame
   */
  placeOf(picture, event) {
    const {left, top, width} = picture.getBoundingClientRect();
    const {frame} = this;
    const factor = frame.width / width;
    return [Math.min(frame.width - frame.right, Math.max(frame.left, factor * (event.clientX - left))),
            Math.min(frame.height - frame.bottom, Math.max(frame.top, factor * (event.clientY - top)))];
  }

  /** @param {SVGElement} picture */
  listen(picture) {
    /** @type {[number, number] | null} */
    let begin = null;
    const chosen = svg('rect', {class: 'chosen'});
    picture.addEventListener('pointerdown', (event) => {
      if (event.pointerType === 'touch' || event.button !== 0) return;  // a finger scrolls the page
      begin = this.placeOf(picture, event);
      picture.setPointerCapture(event.pointerId);
    });
    picture.addEventListener('pointermove', (event) => {
      if (!begin) return;
      const [x, y] = this.placeOf(picture, event);
      furnish(chosen, {x: Math.min(x, begin[0]), y: Math.min(y, begin[1]), width: Math.abs(x - begin[0]), height: Math.abs(y - begin[1])}, []);
      picture.append(chosen);
    });
    picture.addEventListener('pointerup', (event) => {
      if (!begin) return;
      const [first, last] = [begin, this.placeOf(picture, event)];
      begin = null;
      chosen.remove();
      const least = 6;  // [pixels]
      if (Math.abs(first[0] - last[0]) > least && Math.abs(first[1] - last[1]) > least) this.zoomTo(first, last);
    });
    picture.addEventListener('dblclick', () => this.show(this.home, false));
  }

  /**
   * @param {[number, number]} one  a corner in pixels
   * @param {[number, number]} other
   */
  zoomTo(one, other) {
    const [x0, y0] = this.frame.numbersAt(Math.min(one[0], other[0]), Math.max(one[1], other[1]));
    const [x1, y1] = this.frame.numbersAt(Math.max(one[0], other[0]), Math.min(one[1], other[1]));
    this.show({x: [x0, x1], y: [y0, y1]}, true);
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    const {x, y} = this.frame;
    const part = (/** @type {number[]} */ [low, high], /** @type {number} */ shift, /** @type {number} */ factor) => {
      const middle = (low + high) / 2 + shift * (high - low);
      return /** @type {[number, number]} */ ([middle - factor * (high - low) / 2, middle + factor * (high - low) / 2]);
    };
    /** @type {Record<string, [number, number, number]>} */
    const moves = {'+': [0, 0, 0.5], '-': [0, 0, 2], ArrowLeft: [-0.25, 0, 1], ArrowRight: [0.25, 0, 1], ArrowUp: [0, 0.25, 1], ArrowDown: [0, -0.25, 1]};
    if (event.key === '0') this.show(this.home, false);
    else if (moves[event.key]) this.show({x: part(x, moves[event.key][0], moves[event.key][2]), y: part(y, moves[event.key][1], moves[event.key][2])}, true);
    else return;
    event.preventDefault();
  }
}
