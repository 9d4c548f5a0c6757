// SPDX-License-Identifier: BSD-3-Clause
/** An orbit camera around a target. */
class OrbitCamera {
  constructor() {
    /** @type {Vector} */
    this.target = [0, 0, 0];
    this.distance = 10;
    this.yaw = -Math.PI / 2;  // [rad] azimuth of the eye seen from the target
    this.pitch = 1;  // [rad] its elevation
    this.angle = 0.8;  // [rad] of view, along the shorter side of the screen
    this.aspect = 1;  // of the screen: width over height
  }

  /** Unit vectors to the right, upwards and towards the eye. */
  axes() {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    /** @type {Vector} */
    const back = [cp * cy, cp * sy, sp];
    /** @type {Vector} */
    const right = [-sy, cy, 0];
    return {right, up: cross(back, right), back};
  }

  eye() {
    return plus(this.target, this.axes().back, this.distance);
  }

  /** [rad] of view, from top to bottom. */
  verticalAngle() {
    return this.aspect < 1 ? 2 * Math.atan(Math.tan(this.angle / 2) / this.aspect) : this.angle;
  }

  /** From the world to the screen, −1 to 1. */
  matrix() {
    const {right, up, back} = this.axes();
    const projection = perspective(this.verticalAngle(), this.aspect, this.distance / 200, this.distance * 200);
    return multiply(projection, viewMatrix(this.eye(), right, up, back));
  }

  /**
   * [m] of a pixel at the target.
   * @param {number} height  of the screen [pixels]
   */
  pixelSize(height) {
    return 2 * this.distance * Math.tan(this.verticalAngle() / 2) / height;
  }

  /**
   * @param {number} yaw
   * @param {number} pitch [rad]
   */
  orbit(yaw, pitch) {
    this.yaw += yaw;
    const most = Math.PI / 2 - 1e-3;
    this.pitch = Math.min(most, Math.max(-most, this.pitch + pitch));
  }

  /**
   * @param {number} right
   * @param {number} up [m]
   */
  pan(right, up) {
    const axes = this.axes();
    this.target = plus(plus(this.target, axes.right, right), axes.up, up);
  }

  /** @param {number} factor  by which the distance grows */
  zoom(factor) {
    this.distance = Math.min(1e5, Math.max(0.05, this.distance * factor));
  }
}
