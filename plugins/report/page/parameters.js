// SPDX-License-Identifier: BSD-3-Clause
/** What a parameter's last name means. */
const PARAMETER_MEANINGS = {
  lambda: 'azimuth of the laser on the plate', tau: 'distance from the spin axis',
  alpha: "rotation of the scan plane about the plate's normal", eta: 'lag of its clock against the plate',
};

/**
 * A change as a bar to the scale of the largest of its unit, with two standard errors.
 * @param {ShownParameter} parameter
 * @param {number} most
 */
function changeBar({value, nominal, std_error: error}, most) {
  if (nominal === undefined || most <= 0) return null;
  const width = 120, middle = width / 2, scale = 0.92 * middle / most;
  const end = middle + scale * (value - nominal);
  const around = Math.max(0.75, scale * 2 * (error || 0));
  return svg('svg', {viewBox: `0 0 ${width} 14`, class: 'change', 'aria-hidden': true},
    svg('path', {class: 'grid', d: `M${middle} 0V14`}),
    svg('rect', {class: 'bar', x: Math.min(middle, end), y: 4, width: Math.abs(end - middle), height: 6}),
    svg('path', {class: 'error', d: `M${end - around} 7H${end + around}M${end - around} 3V11M${end + around} 3V11`}));
}

/**
 * The largest change in each unit, with two standard errors.
 * @param {ShownParameter[]} parameters
 * @returns {Map<string, number>}
 */
function largestChanges(parameters) {
  const most = new Map();
  for (const {unit, value, nominal, std_error: error} of parameters) {
    if (nominal !== undefined) most.set(unit, Math.max(most.get(unit) || 0, Math.abs(value - nominal) + 2 * (error || 0)));
  }
  return most;
}

/**
 * @param {number} change
 * @param {number | undefined} error
 */
function signedChange(change, error) {
  return (change > 0 ? '+' : change < 0 ? '−' : '') + withError(Math.abs(change), error);
}

/**
 * How many standard errors of both lie between a value and an earlier one.
 * @param {ShownParameter} p
 */
function sigmasApart(p) {
  const error = Math.hypot(p.std_error || 0, p.against_std_error || 0);
  return error > 0 ? Math.abs(p.value - Number(p.against)) / error : NaN;
}

/**
 * @param {ShownParameter} p
 * @param {Map<string, number>} most
 * @param {boolean} hasEarlier
 */
function parameterRow(p, most, hasEarlier) {
  const meaning = PARAMETER_MEANINGS[/** @type {keyof typeof PARAMETER_MEANINGS} */ (p.name.split('.').pop() || '')];
  const apart = sigmasApart(p);
  const limit = 4;  // standard errors, that one of a dozen parameters hardly exceeds by chance
  return [
    el('span', {title: meaning}, p.name), numberCell(withError(p.value, p.std_error)),
    numberCell(p.free ? `± ${errorText(p.std_error || 0)}` : 'from the rig', {class: p.free ? 'number' : 'number faint'}), p.unit === 'deg' ? '°' : p.unit,
    numberCell(p.nominal === undefined ? '–' : shortNumber(p.nominal, 6)),
    numberCell(p.nominal === undefined ? '–' : signedChange(p.value - p.nominal, p.std_error)),
    changeBar(p, most.get(p.unit) || 0),
    ...(hasEarlier ? [numberCell(p.against === undefined ? '–' : signedChange(p.value - p.against, p.std_error)),
                      numberCell(Number.isFinite(apart) ? `${apart.toFixed(1)} σ` : '–', {class: apart > limit ? 'number alarm' : 'number'})] : []),
  ];
}

/**
 * Blue: negative, orange: positive.
 * @param {number} r
 */
function correlationColour(r) {
  return r < 0 ? `rgba(30,110,220,${Math.abs(r)})` : `rgba(230,120,0,${Math.abs(r)})`;
}

/** @param {ShownCalibration} calibration */
function correlationMatrix({order, correlations}) {
  const cell = 16, left = 8 + 6.4 * Math.max(...order.map((name) => name.length));
  const size = cell * order.length;
  const labels = order.flatMap((name, i) => [
    svg('text', {x: left - 4, y: cell * i + 12, 'text-anchor': 'end'}, name),
    svg('text', {x: 0, y: 0, transform: `translate(${left + cell * i + 12},${size + 6}) rotate(-90)`, 'text-anchor': 'end'}, name)]);
  const cells = correlations.flatMap((row, i) => row.map((r, j) =>
    svg('rect', {x: left + cell * j, y: cell * i, width: cell - 1, height: cell - 1, fill: correlationColour(r)},
      svg('title', {}, `${order[i]} and ${order[j]}: ${r.toFixed(3)}`))));
  return svg('svg', {viewBox: `0 0 ${left + size} ${size + left}`, class: 'matrix', style: `max-width:${left + size}px`, role: 'img', 'aria-label': 'correlations'}, ...labels, ...cells);
}

/**
 * Pairs whose estimates depend on each other.
 * @param {ShownCalibration} calibration
 */
function strongCorrelations({order, correlations}) {
  const strong = 0.7;
  const pairs = [];
  for (let i = 0; i < order.length; ++i) {
    for (let j = 0; j < i; ++j) {
      if (Math.abs(correlations[i][j]) >= strong) pairs.push({names: `${order[j]} and ${order[i]}`, r: correlations[i][j]});
    }
  }
  return pairs.sort((a, b) => Math.abs(b.r) - Math.abs(a.r)).slice(0, 12);
}

/** @param {any} data */
function parametersSection(data) {
  /** @type {ShownCalibration | undefined} */
  const calibration = data.calibration;
  if (!calibration) return null;
  const hasEarlier = calibration.parameters.some((p) => p.against !== undefined);
  const most = largestChanges(calibration.parameters);
  const fixed = calibration.parameters.filter((p) => !p.free).map((p) => p.name);
  const strong = strongCorrelations(calibration);
  return section('parameters', 'The scanner',
    table(['parameter', 'value', 'standard error', '', 'nominal', 'change', 'to scale', ...(hasEarlier ? ['since the last', ''] : [])],
      calibration.parameters.map((p) => parameterRow(p, most, hasEarlier)), {class: 'parameters'}),
    el('p', {class: 'hint'}, 'Bars: change from nominal, to the scale of the largest of the same unit; whiskers: two standard errors.'),
    fixed.length > 0 && el('p', {}, el('b', {}, 'Known from the rig only: '), fixed.join(', '), '.'),
    calibration.unobservable.length > 0 && el('p', {}, el('b', {}, 'Not determined by this recording: '),
      calibration.unobservable.map((one) => `${one.parameter} (${one.reason})`).join('; '), '.'),
    calibration.correlations.length > 1 && fold(el('b', {}, 'Correlations'),
      el('div', {class: 'columns'}, correlationMatrix(calibration),
        strong.length > 0 ? el('div', {}, el('p', {}, 'Estimates that depend on each other most:'),
          table(['parameters', 'correlation'], strong.map(({names, r}) => [names, numberCell(minus(r.toFixed(2)))])))
          : el('p', {}, 'No two estimates are correlated by 0.7 or more.'))));
}
