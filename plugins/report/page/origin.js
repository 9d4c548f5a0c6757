// SPDX-License-Identifier: BSD-3-Clause
/** @param {StageRecord} stage */
function stageRow(stage) {
  const counts = Object.entries(stage.counts || {}).filter(([, n]) => n > 0);
  const options = Object.entries(stage.options || {});
  return [stage.tag, numberCell(duration(stage.seconds)),
    options.length > 0 ? fold(counted(options.length, 'option'), el('dl', {class: 'facts'}, ...options.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, JSON.stringify(value))]))) : 'none',
    counts.length > 0 ? counts.map(([what, n]) => `${grouped(n)} ${what}`).join('; ') : '–',
    el('span', {}, ...(stage.outputs || []).flatMap((file, i) => [i > 0 && ', ', el('span', {title: file}, file.split('/').pop() || file)]))];
}

/** @param {any} data */
function originSection(data) {
  const {summary} = data;
  /** @type {[string, Child][]} */
  const facts = [['crisp', summary.crisp], ['pipeline', summary.pipeline], ['rig', summary.rig], ['started', summary.started],
                 ['took', duration(summary.seconds)], ['seed', summary.seed], ['threads', summary.threads], ['exit status', summary.exit_status], ['page written', data.written]];
  if (summary.command) facts.splice(1, 0, ['command', el('code', {}, summary.command)]);
  return section('origin', 'Origin',
    el('dl', {class: 'facts'}, ...facts.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, value)])),
    table(['input', 'size', 'SHA-256'], (summary.inputs || []).map((/** @type {any} */ input) => [input.file, numberCell(fileSize(input.bytes)), el('code', {class: 'hash'}, input.sha256)])),
    table(['stage', 'time', 'options', 'counted', 'wrote'], stagesOf(summary).map(stageRow)));
}
