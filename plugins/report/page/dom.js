// SPDX-License-Identifier: BSD-3-Clause
/** @typedef {Node | string | number | null | undefined | false} Child */

/**
 * Gives an element its attributes, listeners (`onclick: …`) and children. Texts become text nodes: nothing that
 * comes from data is ever read as markup.
 * @template {Element} E
 * @param {E} element
 * @param {Record<string, any>} attributes  null and false are left out
 * @param {Child[]} children
 * @returns {E}
 */
function furnish(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === 'function') element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  for (const child of children) {
    if (child !== null && child !== undefined && child !== false)
      element.append(child instanceof Node ? child : String(child));
  }
  return element;
}

/**
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...Child} children
 * @returns {any}
 */
function el(tag, attributes = {}, ...children) {
  return furnish(document.createElement(tag), attributes, children);
}

/**
 * The same of SVG.
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...Child} children
 * @returns {any}
 */
function svg(tag, attributes = {}, ...children) {
  return furnish(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
}

/**
 * A table with a head, that scrolls sideways where it is too wide.
 * @param {Child[]} head
 * @param {Child[][]} rows
 * @param {Record<string, any>} [attributes]
 */
function table(head, rows, attributes = {}) {
  const cell = (/** @type {Child} */ child) => (child instanceof HTMLTableCellElement ? child : el('td', {}, child));
  const isNumber = (/** @type {number} */ k) => rows.length > 0 && rows[0][k] instanceof HTMLTableCellElement;
  return el('div', {class: 'scroll'}, el('table', attributes,
    el('thead', {}, el('tr', {}, ...head.map((name, k) => el('th', {class: isNumber(k) && 'number'}, name)))),
    el('tbody', {}, ...rows.map((row) => el('tr', {}, ...row.map(cell))))));
}

/**
 * A cell of a table that holds a number.
 * @param {Child} child
 * @param {Record<string, any>} [attributes]
 */
function numberCell(child, attributes = {}) {
  return el('td', {class: 'number', ...attributes}, child);
}

/**
 * A section of the page.
 * @param {string} id
 * @param {string} title
 * @param {...Child} children
 */
function section(id, title, ...children) {
  return el('section', {id}, el('h2', {}, title), ...children);
}

/**
 * What is shown on demand.
 * @param {Child} summary
 * @param {...Child} children
 */
function fold(summary, ...children) {
  return el('details', {}, el('summary', {}, summary), ...children);
}
