// SPDX-License-Identifier: BSD-3-Clause
/** The viewer's buttons, sliders and legend. */
class ViewerControls {
  /** @param {CloudViewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.legend = el('div', {class: 'legend'});
    this.when = el('strong', {class: 'when'});
    /** @type {{input: HTMLInputElement, axis: number, side: 'low' | 'high'}[]} */
    this.clips = [];
    this.bar = this.buildBar();
    this.clipping = this.buildClipping();
  }

  /** @param {Record<string, any>} attributes */
  range(attributes) {
    return el('input', {type: 'range', ...attributes});
  }

  buildBar() {
    const {viewer} = this;
    this.slider = this.range({min: 0, max: 1, step: 0.01, id: 'mix', 'aria-label': 'before to after', oninput: () => viewer.setMix(Number(this.slider.value))});
    this.select = el('select', {id: 'colour', onchange: () => viewer.setColour(this.select.value)},
      ...viewer.modes().map(({name, label}) => el('option', {value: name}, label)));
    this.sizes = this.range({min: 1, max: 8, step: 0.5, id: 'size', oninput: () => viewer.change(() => { viewer.size = Number(this.sizes.value); })});
    this.measureButton = el('button', {id: 'measure', onclick: () => viewer.change(() => viewer.picker.toggleMeasuring())}, 'measure');
    const button = (/** @type {string} */ name, /** @type {() => void} */ action) => el('button', {onclick: () => viewer.change(action)}, name);
    return el('div', {class: 'controls'},
      viewer.cloud.hasBefore && el('label', {class: 'mix'}, 'before ', this.slider, ' after'),
      el('label', {}, 'colour ', this.select), el('label', {}, 'size ', this.sizes),
      button('top', () => viewer.look(-Math.PI / 2, Math.PI / 2)), button('front', () => viewer.look(-Math.PI / 2, 0)),
      button('side', () => viewer.look(0, 0)), button('reset', () => viewer.home()), this.measureButton);
  }

  buildClipping() {
    const {viewer} = this;
    const one = (/** @type {number} */ axis, /** @type {'low' | 'high'} */ side) => {
      const input = this.range({min: viewer.box.low[axis], max: viewer.box.high[axis], step: 'any', 'aria-label': `${'xyz'[axis]} ${side}`,
        oninput: () => viewer.change(() => { viewer[side][axis] = Number(input.value); })});
      this.clips.push({input, axis, side});
      return input;
    };
    return fold('clipping box', el('div', {class: 'clips'},
      ...[0, 1, 2].map((axis) => el('div', {}, 'xyz'[axis], one(axis, 'low'), one(axis, 'high'))),
      el('button', {onclick: () => viewer.change(() => viewer.showAll())}, 'all of the cloud')));
  }

  /** @param {{ramp: Rgb[] | null, low: number, high: number}} scale */
  showLegend({ramp, low, high}) {
    this.legend.replaceChildren(...(ramp ? this.scale(ramp, low, high) : this.laserKeys()));
  }

  /**
   * @param {Rgb[]} ramp
   * @param {number} low
   * @param {number} high
   */
  scale(ramp, low, high) {
    const mode = COLOUR_MODES.find(({name}) => name === this.viewer.colour);
    const bar = `linear-gradient(to right, ${ramp.map(css).join(',')})`;
    return [el('span', {}, shortNumber(low)), el('span', {class: 'bar', style: `background:${bar}`}),
            el('span', {}, `${shortNumber(high)} ${mode && mode.unit}`)];
  }

  laserKeys() {
    const {viewer} = this;
    const numbers = [...new Set(viewer.cloud.column('laser'))].sort((a, b) => a - b);
    return numbers.map((laser) => el('label', {},
      el('input', {type: 'checkbox', checked: !viewer.hidden.has(laser), onchange: () => {
        if (!viewer.hidden.delete(laser)) viewer.hidden.add(laser);
        viewer.recolour();
      }}),
      el('span', {class: 'swatch', style: `background:${css(LASER_COLOURS[laser % LASER_COLOURS.length])}`}),
      viewer.laserName(laser)));
  }

  /** Sets the controls to what is shown. */
  sync() {
    const {viewer} = this;
    this.slider.value = String(viewer.mix);
    this.select.value = viewer.colour;
    this.sizes.value = String(viewer.size);
    this.measureButton.setAttribute('aria-pressed', String(viewer.picker.isMeasuring));
    this.clips.forEach(({input, axis, side}) => { input.value = String(viewer[side][axis]); });
    this.when.textContent = !viewer.cloud.hasBefore ? '' : viewer.mix >= 0.5 ? 'after the calibration' : "before: the rig's nominal values";
  }
}
