// SPDX-License-Identifier: MIT
// What the pages of reports share: tables, charts, the machine.
'use strict';
const report = (() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const byId = (id) => document.getElementById(id);

  // Okabe and Ito's palette: told apart by colour-blind readers too; the shape of the mark says the same once more.
  const looks = {
    query: { colour: '#0072b2', mark: 'circle' },
    'query-any': { colour: '#56b4e9', mark: 'triangle' },
    atomic: { colour: '#d55e00', mark: 'rect' },
    subgroup: { colour: '#b8860b', mark: 'rectRot' },
    compute: { colour: '#cc79a7', mark: 'star' },
    cpu: { colour: '#009e73', mark: 'crossRot' },
  };
  const look = (method) => looks[method] || { colour: '#444444', mark: 'circle' };

  function element(tag, text, className) {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    return made;
  }

  const grouped = (value) => Math.round(value).toLocaleString('en-US');
  const counted = (count, one) => `${grouped(count)} ${one}${count === 1 ? '' : 's'}`;
  function short(value) {
    if (value === null || value === undefined) return '–';
    if (value === 0) return '0';
    const size = Math.abs(value);
    if (size >= 1e9) return Number((value / 1e9).toPrecision(3)) + ' G';
    if (size >= 1e6) return Number((value / 1e6).toPrecision(3)) + ' M';
    if (size >= 1000) return grouped(Number(value.toPrecision(3)));
    return String(Number(value.toPrecision(3)));
  }

  function fillTable(table, columns, rows) {
    const head = table.createTHead().insertRow();
    for (const column of columns) head.appendChild(element('th', column.name, column.number ? 'n' : ''));
    const body = table.createTBody();
    for (const row of rows) {
      const line = body.insertRow();
      columns.forEach((column, i) => {
        const cell = line.insertCell();
        if (column.number) cell.className = 'n';
        if (row[i] instanceof Node) cell.appendChild(row[i]);
        else cell.textContent = row[i] ?? '–';
      });
    }
  }
  const words = (...names) => names.map((name) => ({ name }));
  const numbers = (...names) => names.map((name) => ({ name, number: true }));

  function fillMachine() {
    const on = data.machine;
    const cards = [
      ['Device', on.device, `${on.device_type}, Vulkan ${on.api}`],
      ['Driver', on.driver, on.driver_version],
      ['CPU', on.cpu, `${on.cpu_threads} threads`],
      ['Filter', 'hardware: query, query-any, atomic, subgroup', on.hardware_filter],
      ['Filter', 'exact: compute, cpu', 'fp32 in a written order, the same bits everywhere'],
      ['Program', `voxtact ${on.voxtact}`, `revision ${on.git_revision}`],
    ];
    for (const [name, value, more] of cards) {
      const card = element('div', undefined, 'card');
      card.append(element('b', name), element('span', value), element('small', more));
      byId('machine').appendChild(card);
    }
  }

  function fillAbout() {
    byId('verdict').textContent = data.agrees ? 'The methods agree.' : 'The methods do not agree.';
    if (!data.agrees) document.querySelector('.summary').classList.add('failed');
    byId('command').textContent = data.command;
    for (const note of data.notes) byId('notes').appendChild(element('li', note));
  }

  function fillSeries() {
    const columns = [...words('Sweep', 'Method', 'Mode'),
      ...numbers('Batch', 'Viewport', 'Triangles', 'Voxels', 'Fragments a pair', 'Samples', 'Wall ms', 'p10', 'p90', 'min', 'max', 'GPU ms',
        'Pairs/s', 'Fragments/s')];
    fillTable(byId('series'), columns, data.series.map((s) => [
      s.sweep, s.method, s.mode, grouped(s.batch), `${s.width}×${s.height}`, grouped(s.triangles),
      s.voxels.join('×'), short(s.fragments_a_pair), s.wall_ms.samples.length, short(s.wall_ms.median), short(s.wall_ms.p10),
      short(s.wall_ms.p90), short(s.wall_ms.min), short(s.wall_ms.max), s.gpu_ms ? short(s.gpu_ms.median) : '–',
      short(s.pairs_per_s), short(s.fragments_per_s),
    ]));
  }

  // Spread, 10th to 90th percentile, as a whisker on each point.
  const whiskers = {
    id: 'whiskers',
    beforeDatasetsDraw(chart) {
      const { ctx, scales: { y } } = chart;
      ctx.save();
      chart.data.datasets.forEach((set, i) => {
        ctx.strokeStyle = set.whiskerColor ?? set.borderColor;
        ctx.lineWidth = 1.5;
        chart.getDatasetMeta(i).data.forEach((point, k) => {
          const low = set.low ? set.low[k] : set.data[k]?.low;
          const high = set.high ? set.high[k] : set.data[k]?.high;
          if (!Number.isFinite(low) || !Number.isFinite(high) || (y.type === 'logarithmic' && low <= 0)) return;
          const top = y.getPixelForValue(high);
          const bottom = y.getPixelForValue(low);
          ctx.beginPath();
          for (const at of [top, bottom]) {
            ctx.moveTo(point.x - 4, at);
            ctx.lineTo(point.x + 4, at);
          }
          ctx.moveTo(point.x, top);
          ctx.lineTo(point.x, bottom);
          ctx.stroke();
        });
      });
      ctx.restore();
    },
  };

  const whiskersOver = { id: 'whiskersOver', afterDatasetsDraw: whiskers.beforeDatasetsDraw };

  // The name of each line at its right end, moved apart where they would cover each other.
  const endLabels = {
    id: 'endLabels',
    afterDatasetsDraw(chart) {
      const { ctx, chartArea } = chart;
      const labels = chart.data.datasets.map((set, i) => {
        const points = chart.getDatasetMeta(i).data;
        const last = points[points.length - 1];
        return { text: set.label, colour: set.borderColor, x: last.x, at: last.y, y: last.y };
      }).sort((a, b) => a.at - b.at);
      const gap = 16;
      for (let i = 1; i < labels.length; ++i) labels[i].y = Math.max(labels[i].y, labels[i - 1].y + gap);
      const over = labels.length ? labels[labels.length - 1].y - (chartArea.bottom - 4) : 0;
      if (over > 0) {
        labels[labels.length - 1].y -= over;
        for (let i = labels.length - 2; i >= 0; --i) labels[i].y = Math.min(labels[i].y, labels[i + 1].y - gap);
      }
      ctx.save();
      ctx.font = '600 13px system-ui, "DejaVu Sans", sans-serif';
      ctx.textBaseline = 'middle';
      for (const label of labels) {
        ctx.strokeStyle = label.colour;
        ctx.lineWidth = 0.8;
        ctx.beginPath();
        ctx.moveTo(label.x + 7, label.at);
        ctx.lineTo(chartArea.right + 20, label.y);
        ctx.stroke();
        ctx.fillStyle = label.colour;
        ctx.fillText(label.text, chartArea.right + 24, label.y);
      }
      ctx.restore();
    },
  };

  // 1, 2, 5 of each power of ten where there is room; else the powers.
  function logTick(value, index, ticks) {
    const first = Number(value.toExponential()[0]);
    const isPower = Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;
    const decades = Math.log10(ticks[ticks.length - 1].value / ticks[0].value);
    if (isPower || (decades < 2.2 && (first === 2 || first === 5))) return short(value);
    return '';
  }

  function logAxis(title, ticks) {
    const axis = {
      type: 'logarithmic',
      title: { display: true, text: title, font: { size: 13, weight: '600' }, color: '#1d2430' },
      ticks: { color: '#3a4452', font: { size: 12 }, maxRotation: 0, autoSkip: false, callback: logTick },
      grid: { color: (c) => (c.tick && c.tick.label ? '#dde1e7' : 'transparent') },
    };
    if (!ticks) {
      // Room above the highest mark.
      axis.afterDataLimits = (scale) => { scale.max *= 1.3; };
    } else {
      axis.afterBuildTicks = (scale) => { scale.ticks = ticks.map((value) => ({ value })); };
      axis.ticks.callback = (value) => grouped(value);
      axis.min = ticks[0] * 0.85;
      axis.max = ticks[ticks.length - 1] * 1.15;
    }
    return axis;
  }

  function toDataset(label, points, { colour, mark } = look(label)) {
    return {
      label,
      data: points,
      borderColor: colour,
      backgroundColor: colour,
      pointStyle: mark,
      pointRadius: 5,
      pointBorderWidth: 2,
      borderWidth: 2,
      borderDash: label === 'query-any' ? [5, 4] : [],
      tension: 0,
    };
  }

  /// A box with its heading; returns its canvas.
  function addPlot(parent, title, text, label) {
    const box = element('div', undefined, 'chart');
    box.append(element('h3', title), element('p', text));
    const plot = element('div', undefined, 'plot');
    const canvas = element('canvas');
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', label);
    plot.appendChild(canvas);
    box.appendChild(plot);
    parent.appendChild(box);
    return canvas;
  }
  const still = {
    animation: false,
    maintainAspectRatio: false,
    devicePixelRatio: Math.max(2, window.devicePixelRatio || 1),
  };

  function drawChart(parent, { title, text, xTitle, yTitle, xTicks, sets, unit = 'ms' }) {
    const canvas = addPlot(parent, title, text, `${title}: ${yTitle} against ${xTitle}`);
    return new Chart(canvas, {
      type: 'line',
      data: { datasets: sets },
      plugins: [whiskers, endLabels],
      options: {
        ...still,
        layout: { padding: { right: 104, top: 8 } },
        interaction: { mode: 'nearest', intersect: false },
        scales: { x: logAxis(xTitle, xTicks), y: logAxis(yTitle) },
        plugins: {
          legend: { display: false },
          tooltip: { callbacks: {
            title: (items) => `${items[0].dataset.label}, ${xTitle}: ${short(items[0].parsed.x)}`,
            label: (item) => {
              const p = item.raw;
              const gpu = p.gpu ? `, GPU ${short(p.gpu)} ms` : '';
              const rate = p.rate ? `, ${short(p.rate)} pairs/s` : '';
              return `${short(p.y)} ${unit} (p10 ${short(p.low)}, p90 ${short(p.high)}${gpu})${rate}`;
            },
          } },
        },
      },
    });
  }

  // A range that something else lies in, behind the bars.
  const bandOf = (band) => ({
    id: 'band',
    beforeDatasetsDraw({ ctx, chartArea, scales: { y } }) {
      const top = y.getPixelForValue(band.high);
      const bottom = y.getPixelForValue(band.low);
      ctx.save();
      ctx.fillStyle = 'rgba(29, 36, 48, 0.09)';
      ctx.fillRect(chartArea.left, top, chartArea.width, bottom - top);
      ctx.fillStyle = '#3a4452';
      ctx.font = '600 12px system-ui, "DejaVu Sans", sans-serif';
      ctx.fillText(band.text, chartArea.left + 8, (top + bottom) / 2 + 4);
      ctx.restore();
    },
  });

  function drawBarChart(parent, { title, text, labels, yTitle, sets, stacked, logarithmic, band }) {
    const canvas = addPlot(parent, title, text, `${title}: ${yTitle}`);
    const axisTitle = { display: true, text: yTitle, font: { size: 13, weight: '600' }, color: '#1d2430' };
    const y = logarithmic ? logAxis(yTitle) : { stacked, beginAtZero: true, title: axisTitle, ticks: { color: '#3a4452' } };
    if (band) {
      y.suggestedMin = band.low;
      y.suggestedMax = band.high;
    }
    return new Chart(canvas, {
      type: 'bar',
      data: { labels, datasets: sets.map(({ label, colour, values, low, high }) => ({
        label, data: values, low, high, backgroundColor: colour, borderColor: colour, whiskerColor: '#1d2430' })) },
      plugins: [...(stacked ? [] : [whiskersOver]), ...(band ? [bandOf(band)] : [])],
      options: {
        ...still,
        scales: { x: { stacked, grid: { display: false }, ticks: { color: '#3a4452', font: { size: 13 } } }, y },
        plugins: {
          legend: { display: sets.length > 1, position: 'bottom', labels: { boxWidth: 14, color: '#1d2430' } },
          tooltip: { callbacks: { label: (item) => `${item.dataset.label}: ${short(item.raw)}` } },
        },
      },
    });
  }

  // One line a method, with a point a series.
  function linesOf(series, pointOf) {
    const lines = new Map();
    for (const s of series) {
      const point = pointOf(s);
      if (s.method === 'oracle' || !(point.x > 0) || !(point.y > 0)) continue;
      lines.set(s.method, [...(lines.get(s.method) ?? []), point]);
    }
    return [...lines].map(([method, points]) => toDataset(method, points.sort((a, b) => a.x - b.x)));
  }

  // `divide` turns the time of a batch into the time that is shown.
  const timesOf = (series, xOf, divide) => linesOf(series, (s) => {
    const by = divide(s);
    return { x: xOf(s), y: s.wall_ms.median / by, low: s.wall_ms.p10 / by, high: s.wall_ms.p90 / by,
      gpu: s.gpu_ms ? s.gpu_ms.median / by : null, rate: s.pairs_per_s };
  });
  const ticksOf = (values) => [...new Set(values)].sort((a, b) => a - b);
  function addPair(parent) {
    const pair = element('div', undefined, 'pair');
    parent.appendChild(pair);
    return pair;
  }

  function drawBatches(parent) {
    const all = data.series.filter((s) => s.sweep === 'batch');
    if (all.length === 0) return;
    const chart = { xTitle: 'pairs in a batch', yTitle: 'wall time of a batch, ms', xTicks: ticksOf(all.map((s) => s.batch)) };
    parent.appendChild(element('h2', 'Time against batch size'));
    parent.appendChild(element('p', 'Median wall time; the whiskers are the 10th and 90th percentile of the samples. Lower is better. ' +
      'query-any answers only yes or no.', 'muted'));
    const pair = addPair(parent);
    const many = all.filter((s) => s.mode === 'pipelined');
    const charts = [
      drawChart(pair, { ...chart, title: 'Each pair waited for', text: 'One submission and one wait a pair: the paper\'s way.',
        sets: timesOf(all.filter((s) => s.mode === 'sync'), (s) => s.batch, () => 1) }),
      drawChart(pair, { ...chart, title: 'Pipelined', text: 'One submission a batch, three in flight (cpu: one call a batch).',
        sets: timesOf(many, (s) => s.batch, () => 1) }),
    ];
    // The same range on both, so that they can be compared.
    const range = { min: Math.min(...charts.map((c) => c.scales.y.min)), max: Math.max(...charts.map((c) => c.scales.y.max)) };
    for (const drawn of charts) {
      Object.assign(drawn.options.scales.y, range);
      drawn.update();
    }
    drawChart(parent, { ...chart, title: 'Pipelined, for one pair', text: 'The same times divided by the pairs: what a batch saves.',
      yTitle: 'wall time of a pair, ms', sets: timesOf(many, (s) => s.batch, (s) => s.batch) });
  }

  function drawSweep(parent, sweep, heading, text, xTitle, xOf, onTicks) {
    const series = data.series.filter((s) => s.sweep === sweep);
    if (series.length === 0) return;
    parent.appendChild(element('h2', heading));
    const xTicks = onTicks ? ticksOf(series.map(xOf)) : undefined;
    drawChart(parent, { title: `${series[0].batch} pairs per submission`, text, xTitle, yTitle: 'wall time of a pair, ms', xTicks,
      sets: timesOf(series, xOf, (s) => s.batch) });
  }

  Chart.defaults.font.family = 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif';
  return { data, byId, element, look, grouped, counted, short, words, numbers, fillTable, fillAbout, fillMachine, fillSeries,
    toDataset, linesOf, ticksOf, addPair, drawChart, drawBarChart, drawBatches, drawSweep };
})();
