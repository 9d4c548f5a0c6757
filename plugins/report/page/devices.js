// SPDX-License-Identifier: BSD-3-Clause
/**
  * Merges the reports and findings of each device.
 * @param {any} data
 * @returns {Record<string, any>[]}
 */
function devicesOf(data) {
  const lists = stagesOf(data.summary).map((stage) => (stage.report || {}).devices).filter(Array.isArray);
  if (data.findings) lists.push(data.findings.devices || []);
  /** @type {Map<string, Record<string, any>>} */
  const all = new Map();
  for (const facts of lists.flat()) {
    const name = facts.name || facts.device;
    if (name) all.set(name, {...all.get(name), ...facts, name});
  }
  return [...all.values()];
}

/**
 * The losses of a device that stages counted.
 * @param {any} data
 * @param {string} name
 * @returns {[string, number][]}
 */
function lossesOf(data, name) {
  return stagesOf(data.summary).flatMap((stage) => Object.entries(stage.counts || {}))
    .filter(([what, n]) => n > 0 && what.startsWith(`${name}: `))
    .map(([what, n]) => [what.slice(name.length + 2), n]);
}

/**
 * @param {any} data
 * @param {Record<string, any>} device
 */
function deviceRow(data, device) {
  const losses = lossesOf(data, device.name);
  const skew = Number.isFinite(device.skew_ppm) ? `${withError(device.skew_ppm, device.skew_std_error_ppm)} ± ${errorText(device.skew_std_error_ppm || 0)}` : '–';
  return [
    device.name, [device.ip, device.port].filter(Boolean).join(':') || '–', (device.serial_numbers || []).join(', ') || '–',
    numberCell(grouped(device.items || device.received || device.stamps || 0)),
    numberCell(Number.isFinite(device.rate) ? `${device.rate.toFixed(2)} Hz` : '–'),
    numberCell(Number.isFinite(device.longest_silence) ? duration(device.longest_silence) : '–'),
    numberCell(skew), numberCell(duration(device.delay_median)), numberCell(duration(device.delay_95)),
    losses.length > 0 ? el('span', {class: 'alarm'}, losses.map(([what, n]) => `${grouped(n)} ${what}`).join('; ')) : 'none',
  ];
}

/**
 * How the plate turned.
 * @param {any} motion
 */
function motionPlots(motion) {
  if (!motion || motion.time.length < 2) return null;
  const within = motion.turns.map((/** @type {number | null} */ t, /** @type {number} */ i) => {
    if (t === null) return null;
    const before = i > 0 ? motion.turns[i - 1] : null;
    return before !== null && Math.floor(before) !== Math.floor(t) ? null : 360 * (t - Math.floor(t));
  });
  return el('div', {class: 'columns'},
    el('figure', {}, linePlot(motion.time, motion.rate, 'time [s]', "plate's rate [Hz]")),
    el('figure', {}, linePlot(motion.time, within, 'time [s]', "plate's angle [°]")));
}

/**
  * Coverage of a laser: the darker a cell, the fewer beams.
 * @param {{laser: string, counts: number[][]}} coverage
 */
function coverageMap({laser, counts}) {
  const cell = 8, left = 44, foot = 34;
  const most = Math.max(1, ...counts.flat());
  const rows = counts.length, columns = counts[0].length;
  const cells = counts.flatMap((row, i) => row.map((n, j) => svg('rect', {
    x: left + cell * j, y: cell * (rows - 1 - i), width: cell, height: cell,
    fill: n === 0 ? 'rgba(128,128,128,0.15)' : css(rampColour(RAMP, Math.sqrt(n / most)))},
    svg('title', {}, `mirror ${10 * i - 180}° to ${10 * i - 170}°, plate ${10 * j}° to ${10 * j + 10}°: ${counted(n, 'beam')}`))));
  const x = [0, 90, 180, 270, 360].map((a) => svg('text', {x: left + cell * columns * a / 360, y: cell * rows + 13, 'text-anchor': 'middle'}, `${a}°`));
  const y = [-180, -90, 0, 90, 180].map((a) => svg('text', {x: left - 4, y: cell * rows * (180 - a) / 360 + (a === 180 ? 10 : 4), 'text-anchor': 'end'}, `${a}°`));
  return el('figure', {}, el('figcaption', {}, laser),
    svg('svg', {viewBox: `0 0 ${left + cell * columns + 12} ${cell * rows + foot}`, class: 'coverage', role: 'img', 'aria-label': `coverage of ${laser}`}, ...cells, ...x, ...y,
      svg('text', {x: left + cell * columns / 2, y: cell * rows + 29, 'text-anchor': 'middle'}, "plate's angle"),
      svg('text', {x: -cell * rows / 2, y: 10, transform: 'rotate(-90)', 'text-anchor': 'middle'}, "mirror's angle")));
}

/** @param {any} data */
function devicesSection(data) {
  const devices = devicesOf(data);
  const clocks = plotsNamed(data, '_stamps');
  if (devices.length === 0 && !data.motion) return null;
  return section('devices', 'Devices',
    devices.length > 0 && table(['device', 'address', 'serial number', 'telegrams', 'rate', 'longest silence', 'clock skew [ppm]', 'delay, median', 'delay, 95 %', 'losses'],
      devices.map((device) => deviceRow(data, device))),
    devices.length > 0 && el('p', {class: 'hint'}, 'Delays are beyond the shortest one of each device: half of the telegrams, and 95 of 100, came no later.'),
    motionPlots(data.motion),
    data.coverage && el('div', {}, el('h3', {}, 'Coverage'), el('p', {class: 'hint'}, 'How many echoes each laser had by the angles of its mirror and of the plate; grey: none.'),
      el('div', {class: 'columns'}, ...data.coverage.map(coverageMap))),
    clocks.length > 0 && fold(el('b', {}, 'Clocks: delays against time, and mirrors'), ...clocks.map((plot) => panelGrid(panelsOf(plot)))));
}
