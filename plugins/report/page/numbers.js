// SPDX-License-Identifier: BSD-3-Clause
/**
 * With a minus sign in place of the hyphen.
 * @param {string} number
 */
function minus(number) {
  return number.replace(/^-/, '−');
}

/**
 * A number with so many digits that two of its error show.
 * @param {number} value
 * @param {number | null | undefined} error
 */
function withError(value, error) {
  const digits = error && error > 0 ? 1 - Math.floor(Math.log10(error)) : 3;
  return minus(value.toFixed(Math.min(Math.max(digits, 0), 8)));
}

/**
 * Two digits that count.
 * @param {number} error
 */
function errorText(error) {
  return error > 0 ? withError(error, error) : '0';
}

/**
 * @param {number | null | undefined} value
 * @param {number} [digits]
 */
function shortNumber(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  return minus(String(Number(value.toPrecision(digits))));
}

const SUPERSCRIPTS = {'-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹'};

/**
 * A power of ten with its exponent raised.
 * @param {number} exponent
 */
function powerOfTen(exponent) {
  const raised = [...String(exponent)].map((c) => SUPERSCRIPTS[/** @type {keyof typeof SUPERSCRIPTS} */ (c)]);
  return '10' + raised.join('');
}

/** @param {number | null | undefined} p */
function probability(p) {
  if (p === null || p === undefined || !Number.isFinite(p)) return '–';
  if (p >= 1e-3 || p === 0) return shortNumber(p, 2);
  const exponent = Math.floor(Math.log10(p));
  return `${(p / 10 ** exponent).toFixed(1)}·${powerOfTen(exponent)}`;
}

/** @param {number} seconds */
function duration(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  if (seconds < 1e-3) return `${shortNumber(1e6 * seconds, 2)} µs`;
  if (seconds < 1) return `${shortNumber(1e3 * seconds, 3)} ms`;
  if (seconds < 120) return `${shortNumber(seconds, 3)} s`;
  if (seconds < 7200) return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
  return `${Math.floor(seconds / 3600)} h ${Math.round((seconds % 3600) / 60)} min`;
}

/** @param {number} bytes */
function fileSize(bytes) {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let unit = 0;
  for (; bytes >= 1000 && unit + 1 < units.length; ++unit) bytes /= 1000;
  return `${shortNumber(bytes, 3)} ${units[unit]}`;
}

/**
 * Groups of three digits.
 * @param {number} count
 */
function grouped(count) {
  return String(Math.round(count)).replace(/\B(?=(\d{3})+$)/g, '\u202f');
}

/**
 * "3 lasers".
 * @param {number} count
 * @param {string} what
 */
function counted(count, what) {
  return `${grouped(count)} ${what}${count === 1 ? '' : 's'}`;
}

/**
 * The q-quantile of values that are numbers.
 * @param {ArrayLike<number>} values
 * @param {number} q
 */
function quantile(values, q) {
  const step = Math.max(1, Math.floor(values.length / 20000));
  const some = [];
  for (let i = 0; i < values.length; i += step) {
    if (Number.isFinite(values[i])) some.push(values[i]);
  }
  some.sort((a, b) => a - b);
  return some.length > 0 ? some[Math.min(some.length - 1, Math.floor(q * some.length))] : NaN;
}
