// SPDX-License-Identifier: BSD-3-Clause
/** @typedef {[number, number, number]} Rgb  0 to 255 */

// Distinguishable by colour-blind people, too (Okabe and Ito), then round again.
/** @type {Rgb[]} */
const LASER_COLOURS = [[86, 180, 233], [230, 159, 0], [0, 200, 140], [240, 228, 66], [204, 121, 167], [213, 94, 0], [60, 110, 230]];
/** @type {Rgb[]} Viridis */
const RAMP = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
/** @type {Rgb[]} */
const DIVERGING = [[40, 110, 255], [130, 175, 255], [235, 235, 235], [255, 160, 120], [240, 50, 40]];
/** @type {Rgb} */
const NO_VALUE = [90, 90, 90];

/**
 * @param {Rgb[]} ramp
 * @param {number} share  0 to 1
 * @returns {Rgb}
 */
function rampColour(ramp, share) {
  const at = Math.min(1, Math.max(0, share)) * (ramp.length - 1);
  const low = Math.min(ramp.length - 2, Math.floor(at));
  const mix = (/** @type {number} */ c) => Math.round(ramp[low][c] + (at - low) * (ramp[low + 1][c] - ramp[low][c]));
  return [mix(0), mix(1), mix(2)];
}

/** @param {Rgb} colour */
function css(colour) {
  return `rgb(${colour.join(',')})`;
}

/** What points may be coloured by. */
const COLOUR_MODES = [
  {name: 'laser', label: 'laser'},
  {name: 'height', label: 'height', unit: 'm'},
  {name: 'remission', label: 'remission', unit: ''},
  {name: 'time', label: 'time', unit: 's'},
  {name: 'distance', label: 'distance to its surface', unit: 'mm'},
  {name: 'incidence', label: 'incidence', unit: '°'},
  {name: 'range', label: 'range', unit: 'm'},
];

/**
 * The values that a mode shows, in the unit of its label.
 * @param {CloudData} cloud
 * @param {string} mode
 * @param {boolean} isAfter
 */
function shownValues(cloud, mode, isAfter) {
  if (mode === 'height') return cloud.column(isAfter || !cloud.hasBefore ? 'z' : 'z_before');
  if (mode !== 'distance') return cloud.column(mode);
  const name = isAfter || !cloud.hasBefore ? 'distance' : 'distance_before';
  return cloud.column(name).map((metres) => 1e3 * metres);
}

/**
 * Colours of all points, 4 bytes each, and what they mean. One scale serves before and after.
 * @param {CloudData} cloud
 * @param {string} mode
 * @param {boolean} isAfter
 */
function pointColours(cloud, mode, isAfter) {
  const rgba = new Uint8Array(4 * cloud.points).fill(255);
  const put = (/** @type {number} */ i, /** @type {Rgb} */ colour) => rgba.set(colour, 4 * i);
  if (mode === 'laser') {
    const lasers = cloud.column('laser');
    for (let i = 0; i < cloud.points; ++i) put(i, LASER_COLOURS[lasers[i] % LASER_COLOURS.length]);
    return {rgba, ramp: null, low: 0, high: 0};
  }
  const values = shownValues(cloud, mode, isAfter);
  const scale = shownValues(cloud, mode, true);
  let low = quantile(scale, 0.01);
  let high = quantile(scale, 0.99);
  const ramp = mode === 'distance' ? DIVERGING : RAMP;
  if (mode === 'distance') {
    high = Math.max(Math.abs(low), Math.abs(high));
    low = -high;
  }
  const steps = Array.from({length: 256}, (_, k) => rampColour(ramp, k / 255));
  const factor = 255 / Math.max(high - low, 1e-9);
  for (let i = 0; i < cloud.points; ++i) {
    const step = Math.round((values[i] - low) * factor);
    put(i, Number.isNaN(step) ? NO_VALUE : steps[Math.min(255, Math.max(0, step))]);
  }
  return {rgba, ramp, low, high};
}
