// SPDX-License-Identifier: MIT
'use strict';
(() => {
  const { data, byId, element, look, grouped, counted, short, words, numbers, fillTable, fillAbout, fillMachine, fillSeries,
    drawBarChart, drawChart, drawSweep, linesOf, ticksOf, addPair, toDataset } = report;
  const clocks = [
    { key: 'gpu', name: 'by GPU timestamps', text: 'Time on the device.' },
    { key: 'wall', name: 'by the wall clock', text: 'From the submission to the end of the wait; recording apart.' },
  ];
  const names = data.scenes.map((scene) => scene.name);
  const rowOf = (scene, method) => data.tables.find((row) => row.scene === scene && row.method === method);
  const methods = [...new Set(data.tables.map((row) => row.method))];
  const [least, most] = data.published.overhead_percent;

  function fillHead() {
    document.title = 'voxtact bench --paper';
    byId('subtitle').textContent = `${names.join(', ')}; ${data.width} × ${data.height} pixels. What the paper publishes was ` +
      'measured on its own hardware, by OpenGL: it says how things were there, not how fast they are here';
    byId('tables-text').textContent = 'Median ms over the rounds, a frame a sample; below it the 10th and 90th percentile. Collision is the ' +
      'detection of one pair alone; total is a frame with the detection in the same submission. Collision % is its time over the rendering\'s; ' +
      'overhead % compares frames with and without it, next to each other; below the percents is the confidence interval of the median. ' +
      `The paper publishes an overhead of ${least} to ${most} %.`;
  }

  function fillScenes() {
    const columns = [...words('Scene', 'Volume', 'Voxels'), ...numbers('Opaque'), ...words('Opacity', 'Mesh'),
      ...numbers('Triangles', 'Poses', 'Ray step')];
    fillTable(byId('scenes'), columns, data.scenes.map((s) => [
      s.name, s.volume, `${s.voxels.join(' × ')} ${s.voxel_type}`, `${short(100 * s.opaque_share)} %`, s.opacity, s.mesh,
      grouped(s.triangles), s.poses, `${short(s.step_mm)} mm`,
    ]));
  }

  const ms = (spread) => (spread ? short(spread.median) : '–');
  // The median, and below it where it lies.
  function ranged(spread, low, high) {
    if (!spread) return '–';
    const cell = element('span', short(spread.median));
    if (high !== null) cell.appendChild(element('small', `${short(low)} to ${short(high)}`));
    return cell;
  }
  const ranks = (spread) => ranged(spread, spread?.p10, spread?.p90);
  const interval = (spread) => ranged(spread, spread?.low, spread?.high);
  // Detection adds no less than nothing: below 0 is how much frames differ.
  function overhead(spread) {
    const cell = interval(spread);
    if (!spread) return cell;
    if (spread.median < 0) cell.firstChild.textContent = 'noise';
    if (spread.low === null) cell.appendChild(element('small', 'no interval'));
    return cell;
  }

  function fillTables() {
    const columns = [...words('Scene', 'Method'), ...numbers('Survivors', 'Mesh', 'Volume', 'Collision', 'Total rendering',
      'Total', 'Collision %', 'Overhead %')];
    for (const clock of clocks) {
      const rows = data.tables.filter((row) => row[clock.key]);
      if (rows.length === 0) continue;
      const confidence = rows.map((row) => row[clock.key].overhead_percent?.confidence).find((c) => c);
      const box = element('div', undefined, 'chart');
      box.append(element('h3', `In ms, ${clock.name}`), element('p', clock.text +
        (confidence ? ` Intervals: ${(100 * confidence).toFixed(1)} %.` : '')));
      const table = element('table');
      const scroll = element('div', undefined, 'wide');
      scroll.appendChild(table);
      box.appendChild(scroll);
      byId('tables').appendChild(box);
      fillTable(table, columns, rows.map((row) => {
        const c = row[clock.key];
        return [row.scene, row.method, short(row.survivors), ms(c.mesh_ms), ms(c.volume_ms), ranks(c.collision_ms),
          ranks(c.rendering_ms), ranks(c.total_ms), interval(c.collision_percent), overhead(c.overhead_percent)];
      }));
    }
  }

  function fillPublished() {
    byId('published-text').textContent = 'Average ms per frame, as printed. ' +
      data.published.hardware.map((name, i) => `Table ${i + 1}: ${name}.`).join(' ');
    const columns = [...words('Table', 'Scene'), ...numbers('Mesh', 'Volume', 'Collision', 'Total rendering', 'Total', 'Overhead %')];
    fillTable(byId('published'), columns, data.published.tables.map((row) => [
      row.table, row.scene, row.mesh_ms, row.volume_ms, row.collision_ms, row.rendering_ms, row.total_ms, row.overhead_percent,
    ]));
  }

  function barsBy(label, colour, valueOf) {
    return { label, colour, values: names.map((name) => valueOf(name)) };
  }

  function drawFrames(parent, clock) {
    const parts = [['mesh', 'mesh_ms', '#999999'], ['volume', 'volume_ms', '#0072b2'], ['collision', 'collision_ms', '#d55e00']];
    const first = (name) => data.tables.find((row) => row.scene === name)?.[clock.key];
    if (!names.some((name) => first(name)?.volume_ms)) return;
    drawBarChart(parent, { title: 'What a frame is made of', stacked: true, labels: names, yTitle: 'ms, median',
      text: `Mesh, volume and collision (${methods[0]}) ${clock.name}.`,
      sets: parts.map(([label, key, colour]) => barsBy(label, colour, (name) => first(name)?.[key]?.median ?? null)) });
  }

  // Medians of `key` by each method, with whiskers from `low` to `high` of their spreads.
  function drawSpreads(parent, clock, key, [low, high], chart) {
    const spread = (name, method) => rowOf(name, method)?.[clock.key]?.[key];
    const known = methods.filter((method) => names.some((name) => spread(name, method)));
    if (known.length === 0) return;
    drawBarChart(parent, { ...chart, labels: names, sets: known.map((method) => ({
      ...barsBy(method, look(method).colour, (name) => spread(name, method)?.median ?? null),
      low: names.map((name) => spread(name, method)?.[low]), high: names.map((name) => spread(name, method)?.[high]) })) });
  }

  function drawCharts() {
    const parent = byId('charts');
    const clock = clocks.find((c) => data.tables.some((row) => row[c.key]?.volume_ms)) ?? clocks[1];
    parent.appendChild(element('h2', 'Frames and what detection adds'));
    const pair = addPair(parent);
    drawFrames(pair, clock);
    drawSpreads(pair, clock, 'collision_ms', ['p10', 'p90'], { title: 'Collision', logarithmic: true, yTitle: 'ms per pair, median',
      text: `The detection of one pair by each method, ${clock.name}; the whiskers are the 10th and 90th percentile.` });
    const whiskers = `Medians, ${clock.name}; the whiskers are the confidence interval.`;
    const band = { low: least, high: most, text: `the paper's overhead: ${least} to ${most} %` };
    drawSpreads(parent, clock, 'overhead_percent', ['low', 'high'], { band, title: 'Overhead', yTitle: '(total - rendering) / rendering, %',
      text: `Frames with the detection in them against frames without, round by round. ${whiskers}` });
    drawSpreads(parent, clock, 'collision_percent', ['low', 'high'], { band, title: 'Collision, in percent of the rendering', logarithmic: true,
      yTitle: 'collision / rendering, %',
      text: `The detection alone over the picture alone: the overhead if nothing else differed. ${whiskers}` });
    drawSweep(parent, 'voxels', 'Time against the volume\'s size',
      'The same mesh, poses, camera and viewport; a volume of the same extent and contents from coarse to fine. A fragment takes ' +
      'one sample, however many voxels there are.', 'voxels a side', (s) => Math.round(Math.cbrt(s.voxels.reduce((product, side) => product * side))), true);
    drawSweep(parent, 'triangles', 'Time against triangles',
      'The same shape from coarse to fine, the same poses and viewport.', 'triangles', (s) => s.triangles);
    drawSweep(parent, 'fragments', 'Time against the viewport',
      'The same poses on viewports of several sizes.', 'pixels of the viewport', (s) => s.width * s.height);
    drawRates(parent);
  }

  const rateOf = (s, time) => 1000 * s.batch / time;
  const rates = (series) => linesOf(series, (s) => ({
    x: s.batch, y: rateOf(s, s.wall_ms.median), low: rateOf(s, s.wall_ms.p90), high: rateOf(s, s.wall_ms.p10) }));

  function drawRates(parent) {
    const all = data.series.filter((s) => s.sweep === 'batch');
    if (all.length === 0) return;
    parent.appendChild(element('h2', 'Pairs a second'));
    parent.appendChild(element('p', `In ${names[0]}. The paper publishes ${grouped(data.published.pairs_per_s)} a second, yes or no, on its own hardware.`,
      'muted'));
    drawChart(parent, { title: 'Batches', text: 'One submission a batch, three in flight (cpu: one call a batch); by the wall clock.',
      xTitle: 'pairs in a batch', yTitle: 'pairs a second', xTicks: ticksOf(all.map((s) => s.batch)), sets: rates(all.filter((s) => s.mode === 'pipelined')), unit: 'pairs/s' });
    const alone = all.filter((s) => s.mode === 'sync' && s.batch === 1);
    if (alone.length === 0) return;
    drawBarChart(parent, { title: 'Each pair waited for', logarithmic: true, labels: alone.map((s) => s.method), yTitle: 'pairs a second',
      text: 'One submission and one wait a pair: the paper\'s way.', band: { low: data.published.pairs_per_s, high: data.published.pairs_per_s * 1.02,
        text: 'the paper' },
      sets: [{ label: 'pairs a second', colour: '#0072b2', values: alone.map((s) => rateOf(s, s.wall_ms.median)),
        low: alone.map((s) => rateOf(s, s.wall_ms.p90)), high: alone.map((s) => rateOf(s, s.wall_ms.p10)) }] });
  }

  function fillPolygons() {
    const parent = byId('polygons');
    if (!data.polygons || data.polygons.ways.length === 0) return;
    parent.appendChild(element('h2', 'Which triangles touch'));
    parent.appendChild(element('p', `In ${names[0]}, of ${counted(data.polygons.triangles, 'triangle')}, on ${counted(data.polygons.poses, 'pose')} together: the paper's one query a polygon and one ` +
      'query a leaf of an OBB tree, one pass that writes a mask, and the certified answer, against which the others are held.', 'muted'));
    const table = element('table');
    parent.appendChild(table);
    fillTable(table, [...words('Way'), ...numbers('Queries', 'Found', 'Missed', 'Not certified', 'Wall ms a pair', 'p10', 'p90')],
      data.polygons.ways.map((way) => [way.name, way.queries === null ? '–' : grouped(way.queries),
        ...(way.unchecked ? ['–', '–', '–', way.unchecked, '', ''] : [grouped(way.found), grouped(way.missed), grouped(way.wrong),
          short(way.wall_ms?.median), short(way.wall_ms?.p10), short(way.wall_ms?.p90)])]));
  }

  function fillIntegration() {
    const parent = byId('integration');
    if (!data.integration || data.integration.length === 0) return;
    parent.appendChild(element('h2', 'A new transfer function'));
    const looks = { gpu: { label: 'GPU', colour: '#0072b2', mark: 'circle' }, wall: { label: 'wall', colour: '#d55e00', mark: 'rect' } };
    const sets = Object.entries(looks).map(([key, look]) => toDataset(look.label,
      data.integration.filter((point) => point[`${key}_ms`]).map((point) => {
        const spread = point[`${key}_ms`];
        return { x: point.entries, y: spread.median, low: spread.p10, high: spread.p90 };
      }), look)).filter((set) => set.data.length > 0);
    drawChart(parent, { title: 'The pre-integrated table', xTitle: 'entries a side', yTitle: 'ms, median',
      text: `GPU: the pass that makes it; wall: with the integrals on the host, the submission and the wait. The paper needed ` +
        `${data.published.preintegration_ms} ms for 256 × 256.`,
      xTicks: data.integration.map((point) => point.entries), sets });
  }

  fillHead();
  fillAbout();
  fillMachine();
  fillScenes();
  fillTables();
  fillPublished();
  drawCharts();
  fillPolygons();
  fillIntegration();
  fillSeries();
})();
