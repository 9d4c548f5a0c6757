// SPDX-License-Identifier: BSD-3-Clause
/**
 * The cloud from above without WebGL: as many brightness levels as points fall on a pixel.
 * @param {CloudData} cloud
 * @param {number} mix
 */
function pictureFromAbove(cloud, mix) {
  const width = 800;
  const low = [quantile(cloud.column('x'), 0.005), quantile(cloud.column('y'), 0.005)];
  const high = [quantile(cloud.column('x'), 0.995), quantile(cloud.column('y'), 0.995)];
  const scale = width / Math.max(high[0] - low[0], 1e-3);
  const height = Math.max(1, Math.min(1600, Math.round(scale * (high[1] - low[1]))));
  const canvas = el('canvas', {width, height, class: 'picture', 'aria-label': 'the cloud from above'});
  const context = canvas.getContext('2d');
  const image = context.createImageData(width, height);
  image.data.fill(255);
  const light = new Float32Array(3 * width * height);
  const lasers = cloud.column('laser');
  for (let i = 0; i < cloud.points; ++i) {
    const [x, y] = cloud.at(i, mix);
    const column = Math.floor(scale * (x - low[0]));
    const row = Math.floor(height - scale * (y - low[1]));
    if (column < 0 || column >= width || row < 0 || row >= height) continue;
    LASER_COLOURS[lasers[i] % LASER_COLOURS.length].forEach((c, k) => { light[3 * (row * width + column) + k] += c / 3; });
  }
  for (let p = 0; p < width * height; ++p) {
    for (let k = 0; k < 3; ++k) image.data[4 * p + k] = Math.min(255, 12 + light[3 * p + k]);
  }
  context.putImageData(image, 0, 0);
  return canvas;
}
