// SPDX-License-Identifier: BSD-3-Clause
/** The cloud in 3D, with its controls. */
class CloudViewer {
  /**
   * @param {CloudData} cloud
   * @param {string[]} lasers  their names
   */
  constructor(cloud, lasers) {
    this.cloud = cloud;
    this.lasers = lasers;
    this.camera = new OrbitCamera();
    this.mix = 1;
    this.colour = 'laser';
    this.size = 2;
    this.hidden = new Set();
    this.picker = new Picker(this);
    this.frames = 0;
    this.isDue = false;
    /** Where all points are, and where the clipping box is. */
    this.box = this.extent();
    /** @type {Vector} */
    this.low = [...this.box.low];
    /** @type {Vector} */
    this.high = [...this.box.high];
    this.canvas = el('canvas', {class: 'points'});
    this.renderer = new PointRenderer(this.canvas);
    this.renderer.load(cloud);
    this.overlay = new Overlay(el('canvas', {class: 'overlay'}));
    this.controls = new ViewerControls(this);
    this.stage = el('div', {class: 'stage', tabindex: 0, 'aria-label': 'the cloud in 3D', onkeydown: (/** @type {KeyboardEvent} */ event) => this.key(event)},
      this.canvas, this.overlay.canvas, this.controls.when, this.picker.info);
    this.element = el('div', {class: 'viewer'}, this.controls.bar, this.controls.legend, this.stage, this.controls.clipping,
      el('p', {class: 'hint'}, 'Drag turns, shift or two fingers pan, the wheel zooms, a click picks a point, a double click goes there. Keys: b before and after, 1 to ',
        this.modes().length, ' colours, t f s views, m measure, r reset, arrows + −. The address in the browser keeps the view.'));
    this.home();
    this.restore();
    new Gestures(this.overlay.canvas, {
      orbit: (dx, dy) => this.change(() => this.camera.orbit(-0.006 * dx, 0.006 * dy)),
      pan: (dx, dy) => this.change(() => this.pan(dx, dy)),
      zoom: (factor) => this.change(() => this.camera.zoom(factor)),
      tap: (x, y) => this.picker.tap(x, y),
      focus: (x, y) => this.focus(x, y),
    });
    new ResizeObserver(() => this.resize()).observe(this.stage);
    addEventListener('hashchange', () => this.restore());
  }

  extent() {
    const all = (/** @type {string} */ axis) => [this.cloud.column(axis), this.cloud.column(axis + '_before')].filter((c) => c.length > 0);
    const low = [], high = [];
    for (const axis of ['x', 'y', 'z']) {
      low.push(Math.min(...all(axis).map((column) => column.reduce((a, b) => Math.min(a, b), Infinity))));
      high.push(Math.max(...all(axis).map((column) => column.reduce((a, b) => Math.max(a, b), -Infinity))));
    }
    return {low: /** @type {Vector} */ (low), high: /** @type {Vector} */ (high)};
  }

  /** All of it from above, without what is uppermost: ceilings and roofs hide the rest. */
  home() {
    const middle = (/** @type {string} */ axis) => (quantile(this.cloud.column(axis), 0.02) + quantile(this.cloud.column(axis), 0.98)) / 2;
    const span = (/** @type {string} */ axis) => quantile(this.cloud.column(axis), 0.98) - quantile(this.cloud.column(axis), 0.02);
    this.showAll();
    this.high[2] = quantile(this.cloud.column('z'), 0.02) + 0.8 * span('z');
    Object.assign(this.camera, {yaw: -Math.PI / 2 - 0.4, pitch: 0.95, target: [middle('x'), middle('y'), middle('z')]});
    this.camera.distance = 1.15 * Math.max(span('x'), span('y'), span('z'), 0.5);
    this.change(() => {});
  }

  /** Clips nothing. */
  showAll() {
    this.low = [...this.box.low];
    this.high = [...this.box.high];
  }

  /** @returns {ViewState} */
  state() {
    const {yaw, pitch, distance, target} = this.camera;
    return {yaw, pitch, distance, target, mix: this.mix, colour: this.colour, size: this.size,
            low: this.low, high: this.high};
  }

  /** Restores the view of the URL's fragment. */
  restore() {
    const state = fromFragment(location.hash, this.state());
    Object.assign(this.camera, {yaw: state.yaw, pitch: state.pitch, distance: state.distance, target: state.target});
    Object.assign(this, {size: state.size, low: [...state.low], high: [...state.high]});
    this.mix = this.cloud.hasBefore ? Math.min(1, Math.max(0, state.mix)) : 1;
    this.colour = state.colour;
    this.recolour();
    this.show();
  }

  /**
   * Does something to the view, and has it drawn and kept in the URL.
   * @param {() => void} action
   */
  change(action) {
    action();
    clearTimeout(this.saving);
    this.saving = setTimeout(() => history.replaceState(null, '', toFragment(this.state())), 300);
    this.show();
  }

  /**
   * @param {number} dx
   * @param {number} dy [pixels]
   */
  pan(dx, dy) {
    const size = this.camera.pixelSize(this.stage.clientHeight);
    this.camera.pan(-dx * size, dy * size);
  }

  /** @param {number} mix  0: before, 1: after */
  setMix(mix) {
    const wasAfter = this.mix >= 0.5;
    this.change(() => { this.mix = mix; });
    if (wasAfter !== mix >= 0.5 && (this.colour === 'distance' || this.colour === 'height')) this.recolour();
  }

  /** @param {string} mode */
  setColour(mode) {
    this.change(() => { this.colour = mode; });
    this.recolour();
  }

  recolour() {
    const {rgba, ...scale} = pointColours(this.cloud, this.colour, this.mix >= 0.5);
    const lasers = this.cloud.column('laser');
    if (this.hidden.size > 0) {
      for (let i = 0; i < this.cloud.points; ++i) rgba[4 * i + 3] = this.hidden.has(lasers[i]) ? 0 : 255;
    }
    this.renderer.colour(rgba);
    this.controls.showLegend(scale);
    this.show();
  }

  /** @param {number} laser */
  laserName(laser) {
    return this.lasers[laser] || `laser ${laser + 1}`;
  }

  resize() {
    const ratio = Math.min(2, devicePixelRatio || 1);
    for (const canvas of [this.canvas, this.overlay.canvas]) {
      canvas.width = Math.round(ratio * this.stage.clientWidth);
      canvas.height = Math.round(ratio * this.stage.clientHeight);
    }
    this.ratio = ratio;
    this.show();
  }

  /** Draws with the next frame. */
  show() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.draw();
    });
  }

  draw() {
    if (this.canvas.width === 0 || !this.ratio) return;
    ++this.frames;
    this.camera.aspect = this.canvas.width / this.canvas.height;
    this.matrix = this.camera.matrix();
    this.renderer.draw({matrix: this.matrix, mix: this.mix, size: this.size * this.ratio, low: this.low, high: this.high});
    this.overlay.draw({
      project: (p) => this.project(p), pixelSize: this.camera.pixelSize(this.stage.clientHeight), ratio: this.ratio,
      picked: this.picker.picked === null ? null : this.cloud.at(this.picker.picked, this.mix),
      measured: this.picker.ends.map((i) => this.cloud.at(i, this.mix))});
    this.controls.sync();
  }

  /**
   * Where a point is on the screen [pixels]; null: behind the eye.
   * @param {Vector} p
   * @returns {[number, number] | null}
   */
  project(p) {
    const m = this.matrix || this.camera.matrix();
    const w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
    if (w <= 0) return null;
    const x = (m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12]) / w;
    const y = (m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13]) / w;
    return [(x + 1) / 2 * this.stage.clientWidth, (1 - y) / 2 * this.stage.clientHeight];
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  focus(x, y) {
    const found = this.picker.pointAt(x, y);
    if (found === null) return;
    this.change(() => {
      this.camera.target = this.cloud.at(found, this.mix);
      this.camera.zoom(0.6);
    });
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement) return;
    const turn = 0.08;
    /** @type {Record<string, () => void>} */
    const actions = {
      b: () => this.cloud.hasBefore && this.setMix(this.mix >= 0.5 ? 0 : 1),
      m: () => this.picker.toggleMeasuring(),
      r: () => this.home(),
      t: () => this.look(-Math.PI / 2, Math.PI / 2),
      f: () => this.look(-Math.PI / 2, 0),
      s: () => this.look(0, 0),
      '+': () => this.camera.zoom(0.85),
      '-': () => this.camera.zoom(1 / 0.85),
      ArrowLeft: () => this.camera.orbit(-turn, 0),
      ArrowRight: () => this.camera.orbit(turn, 0),
      ArrowUp: () => this.camera.orbit(0, turn),
      ArrowDown: () => this.camera.orbit(0, -turn),
      Escape: () => this.picker.clear(),
    };
    const modes = this.modes();
    modes.forEach((mode, k) => { actions[String(k + 1)] = () => this.setColour(mode.name); });
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    this.change(action);
  }

  modes() {
    return COLOUR_MODES.filter(({name}) => name === 'height' || this.cloud.column(name).length > 0);
  }

  /**
   * @param {number} yaw
   * @param {number} pitch
   */
  look(yaw, pitch) {
    this.camera.yaw = yaw;
    this.camera.pitch = 0;
    this.camera.orbit(0, pitch);
  }
}
