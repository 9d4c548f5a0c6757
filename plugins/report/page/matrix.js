// SPDX-License-Identifier: BSD-3-Clause
// Vectors are arrays of three; matrices are 4 × 4, column by column, as WebGL takes them.
/** @typedef {[number, number, number]} Vector */

/**
 * @param {Vector} a
 * @param {Vector} b
 * @param {number} [factor]
 * @returns {Vector} a + factor · b
 */
function plus(a, b, factor = 1) {
  return [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
}

/**
 * @param {Vector} a
 * @param {Vector} b
 */
function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/**
 * @param {Vector} a
 * @param {Vector} b
 * @returns {Vector}
 */
function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/**
 * @param {Vector} a
 * @param {Vector} b
 */
function distanceBetween(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/**
 * @param {Float32Array} a
 * @param {Float32Array} b
 * @returns {Float32Array} a · b
 */
function multiply(a, b) {
  const product = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + row] * b[4 * column + k];
      product[4 * column + row] = sum;
    }
  }
  return product;
}

/**
 * @param {number} angle  of view, from top to bottom [rad]
 * @param {number} aspect  width over height
 * @param {number} near
 * @param {number} far
 */
function perspective(angle, aspect, near, far) {
  const f = 1 / Math.tan(angle / 2);
  const m = new Float32Array(16);
  m[0] = f / aspect;
  m[5] = f;
  m[10] = (far + near) / (near - far);
  m[11] = -1;
  m[14] = 2 * far * near / (near - far);
  return m;
}

/**
 * From the world's frame into the eye's.
 * @param {Vector} eye
 * @param {Vector} right
 * @param {Vector} up
 * @param {Vector} back
 */
function viewMatrix(eye, right, up, back) {
  return new Float32Array([
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1]);
}
