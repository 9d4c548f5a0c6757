// SPDX-License-Identifier: BSD-3-Clause
/**
 * @typedef {{name: string, bytes: number, delta: boolean, gaps: boolean, offset: number, step: number}} Column
 * @typedef {{points: number, of: number, error: number, columns: Column[]}} CloudHeader
 */

/**
 * @param {string} base64
 * @returns {Promise<Uint8Array>} what zlib packed
 */
async function inflated(base64) {
  const text = atob(base64);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  // @ts-ignore TypeScript 4.8 does not know it yet
  const unpack = new DecompressionStream('deflate');
  const stream = new Blob([packed]).stream().pipeThrough(unpack);
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * Undoes what EncodedCloud (encoded_cloud.hpp) describes.
 * @param {Column} column
 * @param {Uint8Array} bytes  of all columns
 * @param {number} begin  of this one
 * @param {number} n  values
 */
function decodeColumn(column, bytes, begin, n) {
  const values = new Float32Array(n);
  const modulus = 2 ** (8 * column.bytes);
  let number = 0;
  for (let i = 0; i < n; ++i) {
    let stored = 0;
    for (let b = column.bytes - 1; b >= 0; --b) stored = 256 * stored + bytes[begin + b * n + i];
    number = column.delta ? (number + stored) % modulus : stored;
    values[i] = column.gaps && number === modulus - 1 ? NaN : column.offset + column.step * number;
  }
  return values;
}

/** The cloud's columns by name. */
class CloudData {
  /**
   * @param {CloudHeader} header
   * @param {Map<string, Float32Array>} columns
   */
  constructor(header, columns) {
    this.header = header;
    this.points = header.points;
    this.columns = columns;
    this.after = this.packed('');
    this.before = columns.has('x_before') ? this.packed('_before') : this.after;
  }

  get hasBefore() {
    return this.columns.has('x_before');
  }

  /**
   * x, y, z of point after point.
   * @param {string} suffix
   */
  packed(suffix) {
    const points = new Float32Array(3 * this.points);
    ['x', 'y', 'z'].forEach((axis, a) => {
      const values = this.column(axis + suffix);
      for (let i = 0; i < this.points; ++i) points[3 * i + a] = values[i];
    });
    return points;
  }

  /**
   * @param {string} name
   * @returns {Float32Array} empty where there is none
   */
  column(name) {
    return this.columns.get(name) || new Float32Array(0);
  }

  /**
   * Where a point is, on the way from before (0) to after (1).
   * @param {number} i
   * @param {number} mix
   * @returns {Vector}
   */
  at(i, mix) {
    const along = (/** @type {number} */ axis) =>
      this.before[3 * i + axis] + mix * (this.after[3 * i + axis] - this.before[3 * i + axis]);
    return [along(0), along(1), along(2)];
  }
}

/**
 * @param {CloudHeader} header
 * @param {string} base64
 */
async function decodeCloud(header, base64) {
  const bytes = await inflated(base64);
  const columns = new Map();
  let begin = 0;
  for (const column of header.columns) {
    columns.set(column.name, decodeColumn(column, bytes, begin, header.points));
    begin += column.bytes * header.points;
  }
  return new CloudData(header, columns);
}
