// SPDX-License-Identifier: BSD-3-Clause
/**
 * @typedef {{name: string, unit: string, value: number, free: boolean, std_error?: number, nominal?: number,
 *            against?: number, against_std_error?: number}} ShownParameter
 * @typedef {{lasers: string[], parameters: ShownParameter[], order: string[], correlations: number[][],
 *            quality: Record<string, number>, unobservable: {parameter: string, reason: string, combination: string}[],
 *            caveats: string[], provenance: Record<string, string>}} ShownCalibration
 * @typedef {{tag: string, stage: string, seconds: number, options: any, counts: Record<string, number>,
 *            warnings: string[], caveats: string[], outputs: string[], report: any}} StageRecord
 */

/**
 * @param {any} summary
 * @returns {StageRecord[]}
 */
function stagesOf(summary) {
  return summary.stages || [];
}

/**
 * The largest standard error in each unit: "0.08 mm, 0.03°".
 * @param {ShownParameter[]} free
 */
function largestErrors(free) {
  const units = new Map();
  for (const {unit, std_error: error} of free) units.set(unit, Math.max(units.get(unit) || 0, error || 0));
  return [...units].map(([unit, error]) => `${errorText(error)} ${unit === 'deg' ? '°' : unit}`.replace(' °', '°')).join(', ');
}

/**
 * @param {any} data
 * @returns {string}
 */
function trustedSentence(data) {
  /** @type {ShownCalibration | undefined} */
  const calibration = data.calibration;
  if (!calibration) return 'The run came to its end, and no stage has a caveat.';
  const free = calibration.parameters.filter((p) => p.free);
  if (free.length === 0) return 'The run came to its end, and no stage has a caveat. The calibration was given, not estimated.';
  return `The calibration is trusted: ${counted(free.length, 'parameter')} of ${counted(calibration.lasers.length, 'laser')}, ` +
    `with standard errors of at most ${largestErrors(free)}.`;
}

/**
 * Causes that a diagnosis found and took into the model.
 * @param {any} data
 * @returns {string}
 */
function causesSentence(data) {
  const accepted = ((data.findings || {}).findings || []).filter((/** @type {any} */ f) => f.accepted);
  if (accepted.length === 0) return data.findings ? ' The diagnosis found no cause that would improve the model.' : '';
  return ` The diagnosis extended the model by ${accepted.map((/** @type {any} */ f) => `${f.cause} of ${f.scope}`).join(' and ')}.`;
}

/**
 * Whether the result is trusted, in a sentence, with its caveats and advice.
 * @param {any} data
 * @returns {{state: 'good' | 'bad', badge: string, sentence: string, reasons: string[], todo: string[]}}
 */
function verdictOf(data) {
  const {summary} = data;
  if (summary.error) {
    return {state: 'bad', badge: 'failed', sentence: 'The run stopped at an error. Its results are not complete.',
            reasons: [summary.error], todo: ['Correct what the error names, and run the pipeline again.']};
  }
  const reasons = stagesOf(summary).flatMap((stage) => stage.caveats.map((caveat) => `${stage.tag}: ${caveat}`));
  if (!summary.trusted) {
    return {state: 'bad', badge: 'untrusted', sentence: 'The run ended, but its result is untrusted.' + causesSentence(data), reasons,
            todo: ['Do not measure in this cloud, and do not use this calibration for other recordings.',
                   'Remedy what is listed above, and record again.', ...recordingsThatWouldHelp(data)]};
  }
  return {state: 'good', badge: 'trusted', sentence: trustedSentence(data) + causesSentence(data), reasons: [],
          todo: [...(data.calibration ? ['Use calibration.yaml for recordings of this scanner until something on it is moved: crisp run configs/assemble.yaml --set calibration=calibration.yaml'] : []),
                 ...recordingsThatWouldHelp(data)]};
}

/**
 * Recordings that would resolve what this one could not.
 * @param {any} data
 * @returns {string[]}
 */
function recordingsThatWouldHelp(data) {
  const list = new Set();
  for (const finding of (data.findings || {}).findings || []) {
    for (const need of finding.resolvable_by || [])
      list.add(`To distinguish ${finding.cause} of ${finding.scope} from ${(finding.confounded_with || []).join(' and ')}, record ${need}.`);
  }
  for (const one of (data.calibration || {}).unobservable || [])
    list.add(`${one.parameter} stays at its prior: ${one.reason}.${one.combination ? ` Known instead: ${one.combination}.` : ''}`);
  return [...list];
}

/**
  * The most important figures.
 * @param {any} data
 * @returns {[string, string, string][]} figure, what it is, what is expected
 */
function keyFigures(data) {
  /** @type {[string, string, string][]} */
  const figures = [];
  const quality = (data.calibration || {}).quality || {};
  if (Number.isFinite(quality.cross_validation))
    figures.push([shortNumber(quality.cross_validation, 2), 'cross-validation', 'two halves of the recording, calibrated apart, differ by so many times what the standard errors allow; about 1 or less is good']);
  if (Number.isFinite(quality.rqe_before) && Number.isFinite(quality.rqe_after))
    figures.push([`${shortNumber(quality.rqe_before)} → ${shortNumber(quality.rqe_after)}`, 'Rényi quadratic entropy', 'of the cloud, before and after; less is sharper']);
  const p = (data.findings || {}).goodness_of_fit || {};
  if (Number.isFinite(p.after_p))
    figures.push([`${probability(p.before_p)} → ${probability(p.after_p)}`, 'p-value of the residuals', 'that they are those of the simulation, before and after; above 0.01 nothing but noise is left']);
  if (data.cloud) figures.push([grouped(data.cloud.of), 'points', `of which ${grouped(data.cloud.points)} are shown below`]);
  return figures;
}

/** @param {any} data */
function verdictSection(data) {
  const verdict = verdictOf(data);
  const warnings = stagesOf(data.summary).flatMap((stage) => stage.warnings.map((text) => `${stage.tag}: ${text}`));
  return el('section', {id: 'verdict', class: verdict.state},
    el('p', {class: 'sentence'}, el('span', {class: 'badge'}, verdict.badge), ' ', verdict.sentence),
    verdict.reasons.length > 0 && el('div', {}, el('h3', {}, 'Why'), el('ul', {class: 'reasons'}, ...verdict.reasons.map((text) => el('li', {}, text)))),
    verdict.todo.length > 0 && el('div', {}, el('h3', {}, 'What to do'), el('ul', {}, ...verdict.todo.map((text) => el('li', {}, text)))),
    warnings.length > 0 && fold(counted(warnings.length, 'warning'), el('ul', {}, ...warnings.map((text) => el('li', {}, text)))),
    el('div', {class: 'figures'}, ...keyFigures(data).map(([figure, name, meaning]) =>
      el('div', {class: 'figure'}, el('b', {}, figure), el('span', {}, name), el('small', {}, meaning)))));
}
