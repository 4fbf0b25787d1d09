// Formulas break where their printer allows it. One that is still wider than its column is broken before signs inside of brackets too, then between
// factors, then gets smaller letters, as small as they have to be.
function breakFormula(math, betweenFactors) {
  const pieces = [[]], flat = (node) => {
    for (const child of [...node.children]) {
      if (child.localName === "mrow" && child.attributes.length === 0) { flat(child); continue; }
      const sign = child.localName === "mo" && child.getAttribute("form") === "infix" && ["+", "\u2212", "="].includes(child.textContent);
      if (sign && pieces[pieces.length - 1].length > 3) pieces.push([]);
      pieces[pieces.length - 1].push(child);
      if (betweenFactors && child.textContent === "\u2062" && pieces[pieces.length - 1].length > 12) pieces.push([]);
    }
  };
  flat(math);
  if (pieces[pieces.length - 1].length === 0) pieces.pop();
  if (pieces.length < 2) return;
  const parts = pieces.map((piece) => { const part = math.cloneNode(false); part.append(...piece); return part; });
  math.replaceWith(...parts.flatMap((part) => [part, document.createTextNode(" ")]));
}

function fitFormulas() {
  for (const line of document.querySelectorAll("p.formula")) {
    const isWide = () => line.scrollWidth > line.clientWidth + 1;
    line.style.fontSize = "";
    if (!isWide()) continue;
    for (const betweenFactors of [false, true]) {
      if (!isWide()) break;
      for (const math of [...line.querySelectorAll("math")]) if (math.getBoundingClientRect().width > 0.85 * line.clientWidth) breakFormula(math, betweenFactors);
    }
    for (let size = 0.85; isWide() && size > 0.45; size -= 0.05) line.style.fontSize = size + "rem";
  }
}

