// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the viewer shows, as it stands in the URL's fragment.
 * @typedef {{yaw: number, pitch: number, distance: number, target: Vector, mix: number, colour: string, size: number,
 *            low: Vector, high: Vector}} ViewState
 */

/**
 * @param {ViewState} state
 * @returns {string} "#view&yaw=…"
 */
function toFragment(state) {
  const short = (/** @type {number} */ v) => String(Number(v.toFixed(4)));
  const parts = Object.entries(state).map(([name, value]) => {
    if (Array.isArray(value)) return `${name}=${value.map(short).join(',')}`;
    return `${name}=${typeof value === 'number' ? short(value) : encodeURIComponent(value)}`;
  });
  return '#view&' + parts.join('&');
}

/**
  * Parses a URL fragment; values that are missing or no numbers stay as in `state`.
 * @param {string} fragment
 * @param {ViewState} state
 * @returns {ViewState}
 */
function fromFragment(fragment, state) {
  if (!fragment.startsWith('#view&')) return state;
  const given = new URLSearchParams(fragment.slice(6));
  /** @type {any} */
  const result = {...state};
  for (const [name, old] of Object.entries(state)) {
    const text = given.get(name);
    if (text === null) continue;
    const numbers = text.split(',').map(Number);
    const isWhole = numbers.every(Number.isFinite);
    if (Array.isArray(old) && isWhole && numbers.length === old.length) result[name] = numbers;
    if (typeof old === 'number' && isWhole && numbers.length === 1) result[name] = numbers[0];
    if (name === 'colour' && COLOUR_MODES.some((mode) => mode.name === text)) result[name] = text;
  }
  return result;
}
