// SPDX-License-Identifier: BSD-3-Clause
/** @typedef {{name: string, svg: string}} ShownPlot  svg: a data URI */
/** @typedef {{title: string, source: string, data: PanelData | null}} Panel  source: a picture, for what has no data */

/**
 * @param {any} data
 * @param {string} ending
 * @returns {ShownPlot[]}
 */
function plotsNamed(data, ending) {
  return (data.plots || []).filter((/** @type {ShownPlot} */ plot) => plot.name.endsWith(ending));
}

/**
 * @param {string} uri  base64
 * @returns {string}
 */
function textOfUri(uri) {
  const bytes = Uint8Array.from(atob(uri.slice(uri.indexOf(',') + 1)), (c) => c.charCodeAt(0));
  return new TextDecoder().decode(bytes);
}

/**
 * The text of an element in a piece of SVG, without its entities; empty without such an element.
 * @param {string} svgText
 * @param {RegExp} element  whose first group is the text
 */
function textIn(svgText, element) {
  const found = svgText.match(element);
  return found ? found[1].replace(/&lt;/g, '<').replace(/&gt;/g, '>').replace(/&amp;/g, '&') : '';
}

/**
 * The data of a panel, of which the page draws it; null if the picture has none.
 * @param {string} piece
 * @returns {PanelData | null}
 */
function dataIn(piece) {
  try {
    const data = JSON.parse(textIn(piece, /<metadata>([^<]*)</));
    return data.series.length > 0 && data.series.every((/** @type {any} */ one) => Array.isArray(one.x) && Array.isArray(one.y)) ?
      {...data, kinds: data.kinds || [], marks: data.marks || []} : null;
  } catch {
    return null;
  }
}

/**
 * The panels of a picture that crisp drew (pipeline/plot), each as its data, or as a picture of its own. The picture is
 * cut as text and shown as images, in which no script runs: nothing in it becomes an element of the page. Another
 * picture stays whole.
 * @param {ShownPlot} plot
 * @returns {Panel[]}
 */
function panelsOf(plot) {
  const begin = '<g transform="translate(';
  const pieces = textOfUri(plot.svg).split(begin).slice(1);
  if (pieces.length === 0) return [{title: plot.name, source: plot.svg, data: null}];
  return pieces.map((piece) => {
    const [x, y] = piece.split(')')[0].split(',').map(Number);
    const group = begin + piece.slice(0, piece.lastIndexOf('</g>') + 4);
    const picture = `<svg xmlns="http://www.w3.org/2000/svg" width="640" height="400" viewBox="${x} ${y} 640 400" font-family="sans-serif" font-size="11">` +
      `<rect x="${x}" y="${y}" width="640" height="400" fill="white"/>${group}</svg>`;
    return {title: textIn(piece, /font-size="14">([^<]*)</) || plot.name, source: 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(picture),
            data: dataIn(piece)};
  });
}

/** @param {Panel} panel */
function panelPicture({title, source}) {
  return el('a', {href: source, onclick: (/** @type {Event} */ event) => enlarge(event, title, source)}, el('img', {src: source, alt: title, loading: 'lazy', width: 640, height: 400}));
}

/**
 * Panels beside one another, those of one quantity on one scale unless a switch says otherwise.
 * @param {Panel[]} panels
 */
function panelGrid(panels) {
  const data = panels.flatMap((panel) => (panel.data ? [panel.data] : []));
  /** @type {PanelPlot[]} */
  const plots = [];
  const shown = panels.map((panel) => {
    if (!panel.data) return panelPicture(panel);
    const plot = new PanelPlot(panel.data, commonScale(data, panel.data));
    plots.push(plot);
    return plot.element;
  });
  const setScales = (/** @type {boolean} */ isCommon) => plots.forEach((plot) => plot.setScale(isCommon ? commonScale(data, plot.data) : undefined));
  const choice = plots.length > 1 && el('label', {class: 'hint'}, el('input', {type: 'checkbox', checked: true, class: 'common-scale', onchange: (/** @type {any} */ event) => setScales(event.target.checked)}), ' one scale for all');
  return el('div', {}, choice, el('div', {class: 'panels'}, ...shown));
}

/**
 * Shows a panel as large as the window.
 * @param {Event} event
 * @param {string} title
 * @param {string} source
 */
function enlarge(event, title, source) {
  event.preventDefault();
  const dialog = el('dialog', {class: 'large', onclick: () => dialog.close(), onclose: () => dialog.remove()}, el('img', {src: source, alt: title}));
  document.body.append(dialog);
  dialog.showModal();
}

/**
 * The panel of a departure: "laser2 against plate angle: …".
 * @param {Panel[]} panels
 * @param {any} departure
 */
function panelOfDeparture(panels, {scope, covariate}) {
  return panels.find(({title}) => title.startsWith(`${scope} against ${covariate}:`));
}

const METRIC_UNITS = {m: {factor: 1e3, name: 'mm'}, nat: {factor: 1, name: 'nat'}};

/** @param {any[]} gains */
function gainTable(gains) {
  if (!gains || gains.length === 0) return null;
  return table(['on held-out data', 'before', 'after', '', 'change, 95 % interval'], gains.map((gain) => {
    const unit = METRIC_UNITS[/** @type {keyof typeof METRIC_UNITS} */ (gain.unit)] || {factor: 1, name: gain.unit};
    const width = Math.abs(unit.factor * (gain.ci95[1] - gain.ci95[0])) || 1;
    const shown = (/** @type {number} */ v) => withError(unit.factor * v, width / 4);
    return [gain.metric, numberCell(shown(gain.before)), numberCell(shown(gain.after)), unit.name,
            numberCell(`${shown(gain.ci95[0])} to ${shown(gain.ci95[1])}`)];
  }));
}

/**
 * In mm, degrees and ms.
 * @param {any} parameter
 */
function shownParameter({name, value, unit, std_error: error}) {
  const shown = {m: [1e3, ' mm'], rad: [180 / Math.PI, '°'], s: [1e3, ' ms']}[/** @type {string} */ (unit)] || [1, unit === '1' ? '' : ` ${unit}`];
  const factor = Number(shown[0]);
  if (error === null || error === undefined) return `${name} = ${shortNumber(factor * value, 4)}${shown[1]}`;
  return `${name} = (${withError(factor * value, factor * error)} ± ${errorText(factor * error)})${shown[1]}`;
}

/**
 * @param {any} finding
 * @returns {[string, Child][]}
 */
function findingFacts(finding) {
  /** @type {[string, Child][]} */
  const facts = [['size', finding.parameters.map(shownParameter).join(', ')],
                 ['explains', `${shortNumber(100 * finding.explained_fraction, 2)} % of the departure`],
                 ['p-value', probability(finding.p_value)]];
  const next = (finding.alternatives || [])[0];
  const odds = finding.log10_bayes_factor;
  if (Number.isFinite(odds) && next) facts.push(['odds', `${powerOfTen(Math.round(odds))} against ${next.cause} of ${next.scope}, the next cause`]);
  if ((finding.confounded_with || []).length > 0) facts.push(['not distinguished from', finding.confounded_with.join(', ')]);
  const needs = finding.resolvable_by || [];
  if (needs.length > 0) facts.push(['resolvable by', needs.join('; ')]);
  if (!finding.accepted && finding.rejection_reason) facts.push(['rejected because', finding.rejection_reason]);
  return facts;
}

/** Over which covariate a family of causes shows. */
const COVARIATE_OF_FAMILY = {mirror: 'mirror angle', mount: 'mirror angle', encoder: 'plate angle', plate: 'plate angle', base: 'plate angle', range: 'range', clock: 'time', timing: 'plate rate'};

/**
 * The panel that shows a cause best.
 * @param {any} finding
 * @param {any} all  findings
 * @param {Panel[]} panels
 */
function panelOfFinding(finding, all, panels) {
  const covariate = COVARIATE_OF_FAMILY[/** @type {keyof typeof COVARIATE_OF_FAMILY} */ (finding.cause.split('.')[0])];
  const byFit = (/** @type {any} */ d) => (d.covariate === covariate ? 0 : 1);
  return (all.departures || []).filter((/** @type {any} */ d) => d.scope === finding.scope || finding.scope === 'plate')
    .sort((/** @type {any} */ a, /** @type {any} */ b) => byFit(a) - byFit(b) || a.p_value - b.p_value)
    .map((/** @type {any} */ d) => panelOfDeparture(panels, d)).find(Boolean);
}

/**
 * @param {any} finding
 * @param {any} all  findings
 * @param {Panel[]} panels
 */
function findingCard(finding, all, panels) {
  const panel = panelOfFinding(finding, all, panels);
  return el('article', {class: finding.accepted ? 'finding accepted' : 'finding'},
    el('h3', {}, `${finding.cause} of ${finding.scope}`, ' ', el('span', {class: 'badge'}, finding.accepted ? 'in the model' : 'rejected')),
    el('div', {class: 'columns'},
      el('div', {}, el('dl', {class: 'facts'}, ...findingFacts(finding).flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, value)])), gainTable(finding.gain)),
      panel && panelGrid([panel])));
}

/**
 * @param {any} all  findings
 * @param {Panel[]} panels
 */
function departuresPart(all, panels) {
  const departures = all.departures || [];
  const significant = departures.map((/** @type {any} */ d) => panelOfDeparture(panels, d)).filter(Boolean);
  const others = panels.filter((panel) => !significant.includes(panel));
  return [
    departures.length > 0 && table(['residuals against', 'of', 'before [mm]', 'p', 'after [mm]', 'p'], departures.map((/** @type {any} */ d) => [
      d.covariate, d.scope, numberCell(shortNumber(1e3 * d.amplitude, 2)), numberCell(probability(d.p_value)),
      numberCell(Number.isFinite(d.amplitude_after) ? shortNumber(1e3 * d.amplitude_after, 2) : '–'),
      numberCell(probability(d.p_value_after), {class: d.p_value_after < 0.01 ? 'number alarm' : 'number'})])),
    significant.length > 0 && fold(`${counted(significant.length, 'panel')} of what departs from the simulation`, panelGrid(significant)),
    others.length > 0 && fold(`${counted(others.length, 'panel')} without a significant departure`, panelGrid(others)),
  ];
}

/** @param {any} all  findings */
function unresolvedPart(all) {
  const list = all.unobservable || [];
  if (list.length === 0) return null;
  return el('div', {}, el('h3', {}, 'What this recording could not resolve'),
    table(['cause', 'why, and what would'], list.map((/** @type {any} */ one) => [one.cause, `${one.reason}${one.combination ? ` (known: ${one.combination})` : ''}`])));
}

/**
 * @param {any} data
 * @param {any} all  findings
 */
function noisePart(data, all) {
  const plots = plotsNamed(data, '_noise');
  if ((all.noise || []).length === 0 && plots.length === 0) return null;
  return el('div', {}, el('h3', {}, 'Noise'),
    table(['laser', 'ranges', 'standard deviation [mm]'], (all.noise || []).map((/** @type {any} */ n) => [n.laser, numberCell(grouped(n.ranges)), numberCell((1e3 * n.sigma).toFixed(2))])),
    plots.length > 0 && fold('how ranges scatter', ...plots.map((plot) => panelGrid(panelsOf(plot)))));
}

/** @param {any} data */
function findingsSection(data) {
  const all = data.findings;
  if (!all) return null;
  const panels = plotsNamed(data, '_residuals').flatMap(panelsOf);
  const named = (all.findings || []).map((/** @type {any} */ finding) => findingCard(finding, all, panels));
  const unnamed = (all.unnamed || []).map((/** @type {any} */ one) => [one.quantity, one.covariate, one.scope, numberCell(shortNumber(1e3 * one.amplitude, 2)), numberCell(probability(one.p_value)), one.accepted ? 'in the model' : 'not']);
  return section('findings', 'What the simulation gets wrong',
    named.length === 0 && unnamed.length === 0 && el('p', {}, 'Nothing that is significant: measured residuals are those of the simulation.'),
    ...named,
    unnamed.length > 0 && el('div', {}, el('h3', {}, 'Departures without a known cause'), table(['quantity', 'against', 'of', 'size [mm]', 'p', 'model'], unnamed)),
    (all.gain || []).length > 0 && el('div', {}, el('h3', {}, 'What all of it brings'), gainTable(all.gain)),
    el('h3', {}, 'Residuals'), ...departuresPart(all, panels), unresolvedPart(all), noisePart(data, all));
}
