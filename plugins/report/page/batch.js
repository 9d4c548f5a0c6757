// SPDX-License-Identifier: BSD-3-Clause
/** @typedef {{label: string, value: (row: any) => any, show?: (row: any) => Child}} BatchColumn */

/**
 * A path in the batch's folder as an address, whatever is in it.
 * @param {string} path
 */
function addressOf(path) {
  return './' + path.split('/').map(encodeURIComponent).join('/');
}

/** @param {any} row */
function rowName(row) {
  return row.report ? el('a', {href: addressOf(row.report)}, row.name) : row.name;
}

/**
 * @param {any[]} rows
 * @returns {BatchColumn[]}
 */
function batchColumns(rows) {
  const qualities = [...new Set(rows.flatMap((row) => Object.keys(row.quality || {})))].sort();
  return [
    {label: 'recording', value: (row) => row.name, show: rowName},
    {label: 'status', value: (row) => row.status, show: (row) => el('span', {class: row.status === 'done' ? 'badge good' : 'badge bad'}, row.status)},
    {label: 'recorded', value: (row) => row.begin || 0, show: (row) => (row.begin ? new Date(1000 * row.begin).toISOString().slice(0, 19).replace('T', ' ') : '–')},
    {label: 'points', value: (row) => row.points || 0, show: (row) => (row.points ? grouped(row.points) : '–')},
    {label: 'time', value: (row) => row.seconds, show: (row) => duration(row.seconds)},
    ...qualities.map((name) => ({label: name, value: (/** @type {any} */ row) => (row.quality || {})[name], show: (/** @type {any} */ row) => shortNumber((row.quality || {})[name])})),
    {label: 'stands out in', value: (row) => (row.stands_out || []).join(', '), show: (row) => el('span', {class: 'alarm'}, (row.stands_out || []).join(', '))},
    {label: 'causes', value: (row) => (row.causes || []).join(', ')},
    {label: 'reasons', value: (row) => (row.reasons || []).join('; '), show: (row) => el('div', {class: 'reasons'}, (row.reasons || []).join('; '))},
  ];
}

/**
 * Numbers by size, texts by letters, what is missing last.
 * @param {any} a
 * @param {any} b
 */
function compareValues(a, b) {
  const missing = (/** @type {any} */ v) => v === undefined || v === null || v === '';
  if (missing(a) || missing(b)) return Number(missing(a)) - Number(missing(b));
  return typeof a === 'number' && typeof b === 'number' ? a - b : String(a).localeCompare(String(b), undefined, {numeric: true});
}

/**
 * A table that sorts by a click on its head, and filters.
 * @param {any[]} rows
 */
function batchTable(rows) {
  const columns = batchColumns(rows).filter(({value}) => rows.some((row) => value(row) !== undefined && value(row) !== ''));
  let sorted = 0, direction = 1;
  const body = el('tbody');
  const filter = el('input', {type: 'search', placeholder: 'filter: name, status, cause …', 'aria-label': 'filter', oninput: () => show()});
  const shown = el('span', {class: 'hint'});
  const heads = columns.map(({label}, k) => el('th', {}, el('button', {onclick: () => {
    direction = sorted === k ? -direction : 1;
    sorted = k;
    show();
  }}, label)));
  const show = () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const isWanted = (/** @type {any} */ row) => {
      const text = columns.map(({value}) => String(value(row))).join(' ').toLowerCase();
      return words.every((/** @type {string} */ word) => text.includes(word));
    };
    const wanted = rows.filter(isWanted).sort((a, b) => direction * compareValues(columns[sorted].value(a), columns[sorted].value(b)));
    heads.forEach((head, k) => head.setAttribute('aria-sort', k === sorted ? (direction > 0 ? 'ascending' : 'descending') : 'none'));
    body.replaceChildren(...wanted.map((row) => el('tr', {}, ...columns.map(({value, show: as}) => {
      const isNumber = typeof value(row) === 'number';
      return el('td', {class: isNumber ? 'number' : null}, as ? as(row) : value(row));
    }))));
    shown.textContent = `${wanted.length} of ${counted(rows.length, 'recording')}`;
  };
  show();
  return el('div', {}, el('p', {}, filter, ' ', shown), el('div', {class: 'scroll'}, el('table', {class: 'batch'}, el('thead', {}, el('tr', {}, ...heads)), body)));
}

/**
 * A parameter over the recordings, in the order of their time.
 * @param {{parameter: string, unit: string, median: number}} trend
 * @param {any[]} rows
 */
function trendPlot({parameter: name, unit, median}, rows) {
  /** @type {Record<string, {factor: number, name: string}>} */
  const units = {m: {factor: 1e3, name: 'mm'}, rad: {factor: 180 / Math.PI, name: '°'}, s: {factor: 1e3, name: 'ms'}};
  const shown = units[unit] || {factor: 1, name: ''};
  const points = rows.map((row, i) => ({row, x: i + 1, p: (row.parameters || {})[name]}))
    .filter(({row, p}) => p && Number.isFinite(p.value) && row.status === 'done')
    .map(({row, x, p}) => ({row, x, y: shown.factor * p.value, error: 2 * shown.factor * (p.std_error || 0)}));
  if (points.length === 0) return null;
  const centre = shown.factor * median;
  const frame = new PlotFrame({x: [1, Math.max(2, rows.length)], y: extentOf([centre, ...points.flatMap(({y, error}) => [y - error, y + error])]), xLabel: 'recording', yLabel: `${name} [${shown.name}]`});
  return el('figure', {}, frame.draw(
    svg('path', {class: 'centre', d: `M${frame.left} ${frame.py(centre)}H${frame.width - frame.right}`}),
    ...points.map(({row, x, y, error}) => svg('g', {class: (row.stands_out || []).includes(name) ? 'outlier' : 'point'},
      svg('title', {}, `${row.name}: ${shortNumber(y, 6)} ${shown.name}`),
      svg('path', {d: `M${frame.px(x)} ${frame.py(y - error)}V${frame.py(y + error)}`}),
      svg('circle', {cx: frame.px(x), cy: frame.py(y), r: 3.5})))));
}

/**
 * Whether the whole batch is trusted.
 * @param {any} batch
 */
function batchVerdict(batch) {
  const counts = batch.counts || {};
  const parts = Object.entries(counts).filter(([, n]) => n > 0).map(([status, n]) => `${n} ${status}`);
  const odd = batch.rows.filter((/** @type {any} */ row) => (row.stands_out || []).length > 0);
  const isGood = (counts.done || 0) === batch.rows.length && odd.length === 0;
  const sentence = `${counted(batch.rows.length, 'recording')}: ${parts.join(', ')}. ` +
    (odd.length > 0 ? `${counted(odd.length, 'recording')} ${odd.length === 1 ? 'stands' : 'stand'} out from the others by more than the errors allow.` : 'No recording stands out from the others.');
  return el('section', {id: 'verdict', class: isGood ? 'good' : 'bad'},
    el('p', {class: 'sentence'}, el('span', {class: 'badge'}, isGood ? 'trusted' : 'untrusted'), ' ', sentence),
    odd.length > 0 && el('ul', {}, ...odd.slice(0, 20).map((/** @type {any} */ row) => el('li', {}, rowName(row), ': ', row.stands_out.join(', ')))));
}

/**
 * @param {any} data
 * @returns {Child[]}
 */
function batchSections(data) {
  const {batch} = data;
  const ordered = [...batch.rows].sort((a, b) => compareValues(a.begin, b.begin) || compareValues(a.name, b.name));
  const plots = (batch.trend || []).map((/** @type {any} */ trend) => trendPlot(trend, ordered)).filter(Boolean);
  return [batchVerdict(batch), section('recordings', 'Recordings', batchTable(batch.rows)),
    plots.length > 0 && section('trends', 'Trends', el('p', {class: 'hint'}, 'Recordings in the order of their time; bars: two standard errors; line: the weighted median; red: stands out.'), el('div', {class: 'columns'}, ...plots)),
    section('origin', 'Origin', el('dl', {class: 'facts'}, el('dt', {}, 'crisp'), el('dd', {}, batch.crisp), el('dt', {}, 'pipeline'), el('dd', {}, batch.pipeline), el('dt', {}, 'page written'), el('dd', {}, data.written)))];
}
