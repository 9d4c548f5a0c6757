// SPDX-License-Identifier: BSD-3-Clause
/** @typedef {{name: string, x: (number | null)[], y: (number | null)[], joined: boolean, error?: (number | null)[]}} PanelSeries */
/**
 * What pipeline/plot/plot_json.hpp writes.
 * @typedef {{title: string, x_label: string, y_label: string, logarithmic: boolean, series: PanelSeries[],
 *            kinds: {at: number, name: string}[], marks: {at: number, around: number, name: string}[]}} PanelData
 */
/** @typedef {{x: [number, number], y: [number, number]}} PanelRange  y of a logarithmic axis: decimal logarithms */

/**
 * The points of a series that have a place in the plot.
 * @param {PanelData} data
 * @param {PanelSeries} series
 * @returns {{i: number, x: number, y: number, error: number}[]}
 */
function shownPoints(data, series) {
  const points = [];
  for (let i = 0; i < Math.min(series.x.length, series.y.length); ++i) {
    const x = series.x[i], y = series.y[i];
    if (x === null || y === null || (data.logarithmic && y <= 0)) continue;
    points.push({i, x, y, error: (series.error || [])[i] || 0});
  }
  return points;
}

/**
 * The range in which all of a panel shows.
 * @param {PanelData} data
 * @returns {PanelRange}
 */
function panelRange(data) {
  const all = data.series.flatMap((series) => shownPoints(data, series));
  const x = [...all.map((p) => p.x), ...data.kinds.flatMap(({at}) => [at - 0.5, at + 0.5]),
             ...data.marks.flatMap(({at, around}) => [at - around, at + around])];
  // For small counts the logarithm's bar would reach far below all points.
  const y = data.logarithmic ? all.map((p) => Math.log10(p.y)) : all.flatMap((p) => [p.y - p.error, p.y + p.error]);
  return {x: extentOf(x), y: extentOf(y)};
}

/**
 * The range of y in which all of several panels show that have the same label.
 * @param {PanelData[]} panels
 * @param {PanelData} like
 * @returns {[number, number]}
 */
function commonScale(panels, like) {
  const same = panels.filter((data) => data.y_label === like.y_label && data.logarithmic === like.logarithmic);
  return extentOf(same.flatMap((data) => panelRange(data).y));
}
