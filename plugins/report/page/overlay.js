// SPDX-License-Identifier: BSD-3-Clause
/** What is drawn over the points: the scanner's axes, a scale bar, what was picked and measured. */
class Overlay {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  }

  /**
   * @param {{project: (p: Vector) => [number, number] | null, pixelSize: number, ratio: number,
   *          picked: Vector | null, measured: Vector[]}} view
   */
  draw(view) {
    const {width, height} = this.canvas;
    const context = this.context;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    context.scale(view.ratio, view.ratio);
    context.font = 'bold 13px sans-serif';
    this.axes(view);
    this.scaleBar(view, height / view.ratio);
    if (view.picked) this.ring(view.project(view.picked), '#fff');
    this.measure(view);
  }

  /**
   * @param {[number, number] | null} from
   * @param {[number, number] | null} to
   * @param {string} colour
   * @param {string} name
   */
  arrow(from, to, colour, name) {
    if (!from || !to) return;
    const context = this.context;
    context.fillStyle = colour;
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...to);
    for (const [width, ink] of /** @type {[number, string][]} */ ([[6, '#000'], [3, colour]])) {
      context.lineWidth = width;
      context.strokeStyle = ink;
      context.stroke();
    }
    this.label(name, to[0] + 5, to[1] - 5);
  }

  /**
   * A text that is read on any ground.
   * @param {string} text
   * @param {number} x
   * @param {number} y
   */
  label(text, x, y) {
    this.context.lineWidth = 3;
    this.context.strokeStyle = '#000';
    this.context.strokeText(text, x, y);
    this.context.fillText(text, x, y);
  }

  /**
   * The scanner's frame: z is the axis that the plate spins about.
   * @param {{project: (p: Vector) => [number, number] | null}} view
   */
  axes(view) {
    const length = 0.5;  // [m]
    const origin = view.project([0, 0, 0]);
    this.arrow(origin, view.project([length, 0, 0]), '#ff5a4f', 'x');
    this.arrow(origin, view.project([0, length, 0]), '#4fd06a', 'y');
    this.arrow(origin, view.project([0, 0, length]), '#5aa2ff', 'z');
  }

  /**
    * A round length at the distance of the target.
   * @param {{pixelSize: number}} view
   * @param {number} height
   */
  scaleBar(view, height) {
    const most = 140 * view.pixelSize;  // [m]
    const decade = 10 ** Math.floor(Math.log10(most));
    const length = decade * ([5, 2, 1].find((k) => k * decade <= most) || 1);
    const pixels = length / view.pixelSize;
    const context = this.context;
    context.strokeStyle = context.fillStyle = '#fff';
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(16, height - 22);
    context.lineTo(16, height - 16);
    context.lineTo(16 + pixels, height - 16);
    context.lineTo(16 + pixels, height - 22);
    context.stroke();
    this.label(length >= 1 ? `${length} m` : `${shortNumber(100 * length)} cm`, 20, height - 24);
  }

  /**
   * @param {[number, number] | null} at
   * @param {string} colour
   */
  ring(at, colour) {
    if (!at) return;
    this.context.strokeStyle = colour;
    this.context.lineWidth = 2;
    this.context.beginPath();
    this.context.arc(at[0], at[1], 7, 0, 2 * Math.PI);
    this.context.stroke();
  }

  /** @param {{project: (p: Vector) => [number, number] | null, measured: Vector[]}} view */
  measure(view) {
    const ends = view.measured.map(view.project);
    ends.forEach((end) => this.ring(end, '#ffd84f'));
    if (ends.length < 2 || !ends[0] || !ends[1]) return;
    const text = `${distanceBetween(view.measured[0], view.measured[1]).toFixed(3)} m`;
    this.arrow(ends[0], ends[1], '#ffd84f', '');
    this.label(text, (ends[0][0] + ends[1][0]) / 2 + 8, (ends[0][1] + ends[1][1]) / 2 - 8);
  }
}
