// SPDX-License-Identifier: BSD-3-Clause
const VERTEX_SHADER = `
attribute vec3 before;
attribute vec3 after;
attribute vec4 colour;
uniform mat4 matrix;
uniform float mixture;
uniform float size;
uniform vec3 low;
uniform vec3 high;
varying vec4 shown;
void main() {
  vec3 point = mix(before, after, mixture);
  bool outside = any(lessThan(point, low)) || any(greaterThan(point, high)) || colour.a < 0.5;
  gl_Position = outside ? vec4(2.0, 2.0, 2.0, 1.0) : matrix * vec4(point, 1.0);
  gl_PointSize = size;
  shown = colour;
}`;
const FRAGMENT_SHADER = `
precision mediump float;
varying vec4 shown;
void main() { gl_FragColor = vec4(shown.rgb, 1.0); }`;

/** Draws points by WebGL. */
class PointRenderer {
  /**
   * @param {HTMLCanvasElement} canvas
   * @throws where there is no WebGL
   */
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext('webgl', {antialias: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error('this browser has no WebGL, or has switched it off');
    this.gl = gl;
    this.program = this.link();
    this.count = 0;
    gl.useProgram(this.program);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0.05, 0.06, 0.08, 1);
  }

  link() {
    const gl = this.gl;
    const program = /** @type {WebGLProgram} */ (gl.createProgram());
    for (const [kind, source] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, VERTEX_SHADER], [gl.FRAGMENT_SHADER, FRAGMENT_SHADER]])) {
      const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) || 'WebGL cannot link');
    return program;
  }

  /**
   * @param {string} name
   * @param {Float32Array | Uint8Array} data
   * @param {number} size  numbers a point
   */
  attribute(name, data, size) {
    const gl = this.gl;
    const at = gl.getAttribLocation(this.program, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(at);
    const isByte = data instanceof Uint8Array;
    gl.vertexAttribPointer(at, size, isByte ? gl.UNSIGNED_BYTE : gl.FLOAT, isByte, 0, 0);
  }

  /** @param {CloudData} cloud */
  load(cloud) {
    this.count = cloud.points;
    this.attribute('before', cloud.before, 3);
    this.attribute('after', cloud.after, 3);
  }

  /** @param {Uint8Array} rgba */
  colour(rgba) {
    const gl = this.gl;
    if (!this.colours) {
      this.attribute('colour', rgba, 4);
      this.colours = gl.getParameter(gl.ARRAY_BUFFER_BINDING);
      return;
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colours);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, rgba);
  }

  /** @param {{matrix: Float32Array, mix: number, size: number, low: Vector, high: Vector}} view */
  draw(view) {
    const gl = this.gl;
    const uniform = (/** @type {string} */ name) => gl.getUniformLocation(this.program, name);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(uniform('matrix'), false, view.matrix);
    gl.uniform1f(uniform('mixture'), view.mix);
    gl.uniform1f(uniform('size'), view.size);
    gl.uniform3fv(uniform('low'), view.low);
    gl.uniform3fv(uniform('high'), view.high);
    gl.drawArrays(gl.POINTS, 0, this.count);
  }
}
