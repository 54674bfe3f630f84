/* exercises.js - the exercises of the kind `predict`, in the chapters of doc/: a person writes down what will
 * come out, as a line `expect`, before the page runs it. {m} is a number, {a|b} a choice. */
'use strict';

const EXERCISES = {
  '6.1': { model: 'incline.model', title: 'A block on a slope',
    equation: 's = 1/2 g (sin a - cos a tan phi) t^2 for phi < a,  u = -s cos a',
    task: 'The slope has a = 30 degrees, the run takes 1 s. Where will the lower corner of the ' +
      'block be? What moves at 31 and 40 degrees, and what sets how far?',
    cases: ['phi 0', 'phi 20', 'phi 29', 'phi 31', 'phi 40'], place: /^let phi .*/m,
    words: 'let {}', ask: 'expect corner u {m} within 0.005' },
  '6.10': { model: 'arch.model', title: 'What holds an arch',
    equation: 'a joint at the springing holds while H <= W tan phi; thrust H, half the weight W',
    task: 'The arch has t/R = 0.15. What does the crown do with less friction: stay, sink ' +
      'a little, fall? Which joints move?',
    cases: ['phi 35', 'phi 20', 'phi 19', 'phi 15'], place: /^let phi .*/m,
    words: 'let {}', ask: 'expect crown {stays|moves} by {m}' },
  '8.2': { model: 'exp1.model', title: 'Quadrilaterals that lock',
    equation: 'without gaps at their vertices, rectangles can have u, v = f(x) + g(y) alone',
    task: 'Theory has -8.90e-3 m at the tip of the cantilever. Can u = -y v\'(x), bending, be ' +
      'written like that? What will the tip do with the bonds of the paper, and with a moment?',
    cases: ['bond at vertices', 'bond at moment'], place: /^static.*/m,
    words: '{}\n$&', ask: 'expect tip v {m} within 10 %' },
};

/* The model of a case, without the answers that it comes with. */
function modelOf(exercise, words, expected) {
  const text = files.get('gallery/' + exercise.model).replace(exercise.place,
    exercise.words.replace('{}', words));
  return text.replace(/^expect .*\n/gm, '').replace(/^ *#.*\n/gm, '') +
    (expected ? `\n${expected}\n` : '');
}

/* The sentence to fill in, as text and inputs; `done` is called with it when all are filled. */
function askFor(exercise, done) {
  const form = make('form', { className: 'ask', autocomplete: 'off' });
  for (const part of exercise.ask.split(/[{}]/)) {
    if (part.includes('|'))
      form.append(make('select', { name: 'part', ariaLabel: 'what it does' },
        ...part.split('|').map(word => new Option(word, word))));
    else if (part === 'm')
      form.append(make('input', { name: 'part', required: true, size: 9, placeholder: 'metres',
        pattern: '[-+]?(\\d+\\.?\\d*|\\.\\d+)([eE][-+]?\\d+)?',
          ariaLabel: 'your number in metres' }));
    else
      form.append(make('span', { className: 'part' }, part));
  }
  form.append(make('button', { id: 'predict' }, 'I predict: run'));
  form.onsubmit = event => {
    event.preventDefault();
    const parts = [...form.querySelectorAll('.part, [name=part]')];
    done(parts.map(e => e.value ?? e.textContent).join(''));
  };
  return form;
}
