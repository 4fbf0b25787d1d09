// Values chosen on the page as the fragment of its address: "m=2&theta=0.3", and "(state)=0.3,1,.." for a state that was
// placed by hand. A fragment may come from anybody: only names of the model and finite numbers are taken from it.
const placedState = "(state)", longestFragment = 20000;

function fragmentOf(live) {
  const values = new URLSearchParams();
  live.parameters.forEach((p, i) => { if (p.moved && live.chosen[i] !== p.value) values.set(p.name, String(live.chosen[i])); });
  for (const [k, value] of live.starts_chosen) values.set(live.states[k].name, String(value));
  if (live.placed) values.set(placedState, Array.from(live.placed).join(","));
  return values.toString();
}

// Sets the values of a fragment in place of all that was chosen. Returns the names without a value for this model.
function takeFragment(live, fragment) {
  const unknown = [];
  live.reset();
  if (fragment.length > longestFragment) return ["a text of " + fragment.length + " characters"];
  for (const [name, text] of new URLSearchParams(fragment)) {
    const numbers = text.split(",").map((part) => (part.trim() === "" ? NaN : Number(part))), isWhole = numbers.every(Number.isFinite);
    const p = live.parameters.findIndex((of) => of.moved && of.name === name), k = live.states.findIndex((of) => of.moved && of.name === name);
    if (isWhole && name === placedState && numbers.length === live.layout.size) live.placed = Float64Array.from(numbers);
    else if (isWhole && numbers.length === 1 && p >= 0) live.chosen[p] = numbers[0];
    else if (isWhole && numbers.length === 1 && k >= 0) live.starts_chosen.set(k, numbers[0]);
    else unknown.push(name);
  }
  return unknown;
}

