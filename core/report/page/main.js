// The head of the page, and the start of everything.

(() => {
  function frameText(numbers) {
    if (numbers.length === 0) return 'none';
    const runs = [];
    for (const number of numbers) {
      const run = runs[runs.length - 1];
      if (run && number === run[1] + 1) run[1] = number;
      else runs.push([number, number]);
    }
    const texts = runs.map(([a, b]) => (a === b ? String(a) : `${a}–${b}`));
    const text = texts.length > 6 ? `${texts.slice(0, 5).join(', ')}, …, ${texts[texts.length - 1]}` : texts.join(', ');
    return numbers.length > 1 ? `${text} (${numbers.length})` : text;
  }

  function head() {
    const count = report.presets.length;
    const facts = [
      ['Input', report.input], ['Reference', report.reference ?? 'none'], ['Frames', frameText(report.frames)],
      ['Size', `${report.display.width} × ${report.display.height}`], ['View', report.view_transform], ['Threads', report.threads],
      ['Program', report.program],
    ];
    byId('head').append(
      el('p', {class: 'eyebrow'}, 'aftershade compare'),
      el('h1', {}, fileName(report.input)),
      el('p', {class: 'lead'}, `${count} ${count === 1 ? 'preset' : 'presets'}${report.reference === null ? ', without a reference' : ` against ${referenceName()}`}`),
      el('dl', {}, facts.filter(([, value]) => value !== '').map(([name, value]) => el('div', {}, el('dt', {}, name), el('dd', {}, String(value))))),
      ...report.notes.map((note) => el('p', {class: 'note'}, `${note[0].toUpperCase()}${note.slice(1)}.`)));
  }

  head();
  results.start();
  chart.start();
  frames.start(viewer.showFrame);
  viewer.start((number) => frames.choose(number));
  parameters.start();
  byId('foot').append(el('p', {}, `${report.program}. The numbers are also in report.json and report.csv.`));
  document.documentElement.dataset.ready = 'yes';
})();
