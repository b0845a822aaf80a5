// Sliders, choices and switches with labels. If the library rejects a value, they show its message and are reset.
const refusal = document.getElementById('refusal');

/** Runs `act`. If that throws, runs `undo`, shows the message and returns false. */
export function attempt(act, undo = () => {}) {
  refusal.textContent = '';
  try {
    act();
    return true;
  } catch (error) {
    undo();
    refusal.textContent = error.message;
    if (error.name !== 'MobilError') throw error;
    return false;
  }
}

function control(place, name, title, element) {
  const label = document.createElement('label'), text = document.createElement('span');
  text.textContent = name;
  element.setAttribute('aria-label', name);
  if (title) label.title = title;
  label.append(text, element);
  document.getElementById(place).append(label);
  return label;
}

/** Adds a slider that sets `holder[key]` and then calls `act`. */
export function slider(place, { id, name, title, holder, key, low, high, step, unit = '', usual, act }) {
  const input = document.createElement('input'), output = document.createElement('output');
  Object.assign(input, { id, type: 'range', min: low, max: high, step, value: holder[key] ?? usual });
  const show = () => {
    const text = key === 'step' && +input.value === 0 ? 'usual' : `${+(+input.value).toPrecision(4)}${unit}`;
    output.textContent = text;
    input.setAttribute('aria-valuetext', text);
  };
  control(place, name, title, input).append(output);
  show();
  input.addEventListener('input', () => {
    const before = holder[key];
    holder[key] = +input.value;
    attempt(act, () => {
      if (before === undefined) delete holder[key];
      else holder[key] = before;
      input.value = before ?? usual;
    });
    show();
  });
}

/** Adds a choice among the names `options`. It stores the name, or with `numbers` its index. */
export function choice(place, { id, name, title, holder, key, options, numbers = false, act }) {
  const select = document.createElement('select');
  select.id = id;
  options.forEach((option, i) => select.add(new Option(option, numbers ? i : option)));
  select.value = holder[key];
  control(place, name, title, select).classList.add('wide');
  select.addEventListener('change', () => {
    const before = holder[key];
    holder[key] = numbers ? +select.value : select.value;
    attempt(act, () => { holder[key] = before; select.value = before; });
  });
}

export function toggle(place, { id, name, title, holder, key, act }) {
  const input = document.createElement('input');
  Object.assign(input, { id, type: 'checkbox', checked: !!holder[key] });
  control(place, name, title, input).classList.add('wide');
  input.addEventListener('change', () => {
    const before = holder[key];
    holder[key] = input.checked ? 1 : 0;
    attempt(act, () => { holder[key] = before; input.checked = !!before; });
  });
}
