// SPDX-License-Identifier: BSD-3-Clause
/**
 * The text of one of the page's data elements.
 * @param {string} id
 */
function dataText(id) {
  const element = document.getElementById(id);
  return element ? element.textContent || '' : '';
}

/**
 * @param {CloudData} cloud
 * @param {string[]} lasers
 * @returns {Element}
 */
function viewerOrPicture(cloud, lasers) {
  try {
    const viewer = new CloudViewer(cloud, lasers);
    Object.assign(window, {crispViewer: viewer});
    return viewer.element;
  } catch (error) {
    return el('div', {}, el('p', {class: 'alarm'}, `The cloud cannot be shown in 3D: ${/** @type {Error} */ (error).message}. This is its view from above.`), pictureFromAbove(cloud, 1));
  }
}

/** @param {any} data */
function cloudSection(data) {
  if (!data.cloud) return null;
  const place = el('div', {}, 'The cloud is being unpacked …');
  const header = data.cloud;
  const share = header.points < header.of ? `, chosen evenly over the surfaces from ${grouped(header.of)}` : '';
  decodeCloud(header, dataText('report-cloud')).then(
    (cloud) => place.replaceChildren(viewerOrPicture(cloud, data.laser_names || [])),
    (error) => place.replaceChildren(el('p', {class: 'alarm'}, `This browser cannot unpack the cloud: ${error.message}. A browser of 2023 or later can; cloud.pcd holds all points.`)));
  return section('cloud', 'The cloud', place,
    el('p', {class: 'hint'}, `${counted(header.points, 'point')}${share}; coordinates are off by ${shortNumber(1e3 * header.error, 2)} mm at most.`));
}

/**
 * @param {any} data
 * @returns {Child[]}
 */
function runSections(data) {
  return [verdictSection(data), parametersSection(data), cloudSection(data), devicesSection(data), findingsSection(data), originSection(data)];
}

/**
 * Links to the sections that there are.
 * @param {Element} page
 */
function contents(page) {
  return el('nav', {}, ...[...page.querySelectorAll('section')].filter((s) => s.querySelector('h2')).map((s) => el('a', {href: `#${s.id}`}, (s.querySelector('h2') || s).textContent)));
}

function main() {
  const page = /** @type {Element} */ (document.getElementById('page'));
  try {
    const data = JSON.parse(dataText('report-data'));
    const isBatch = data.kind === 'batch';
    furnish(page, {}, [el('header', {}, el('h1', {}, data.title), el('p', {class: 'hint'}, isBatch ? 'a batch of crisp' : `a run of crisp, ${data.summary.started || ''}`)),
      ...(isBatch ? batchSections(data) : runSections(data))]);
    (page.firstElementChild || page).append(contents(page));
  } catch (error) {
    page.append(el('p', {class: 'alarm'}, `The page cannot be shown: ${/** @type {Error} */ (error).message}`));
    throw error;
  }
}
