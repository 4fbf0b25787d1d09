// Formulas break where the printer allows it. A formula that is still wider than its column is also broken before signs
// inside brackets, then between factors. Then wide fractions, powers and roots are written inline and broken in the
// same way. Finally the font size is reduced as far as necessary.
function breakFormula(math, betweenFactors) {
  const pieces = [[]], flat = (node) => {
    for (const child of [...node.children]) {
      if (child.localName === "mrow" && child.attributes.length === 0) { flat(child); continue; }
      const sign = child.localName === "mo" && child.getAttribute("form") === "infix" && ["+", "\u2212", "="].includes(child.textContent);
      if (sign && pieces[pieces.length - 1].length > (betweenFactors ? 0 : 3)) pieces.push([]);  // a fraction is one piece
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

// Makes wide parts breakable: a fraction becomes (a + b)/c, the exponent of a bracket moves to the closing bracket, a
// root becomes a power.
function loosen(line) {
  const element = (name, ...parts) => { const node = document.createElementNS("http://www.w3.org/1998/Math/MathML", name); node.append(...parts); return node; };
  const sign = (text) => { const node = element("mo", text); node.setAttribute("stretchy", "false"); return node; };
  const bracketed = (node) => (node.children.length > 1 ? [sign("("), node, sign(")")] : [node]);
  const inner = (node) => (node.localName === "mrow" && node.children.length === 1 ? inner(node.firstElementChild) : node);
  for (const node of [...line.querySelectorAll("mfrac, msup, msqrt")].reverse()) {
    if (node.getBoundingClientRect().width <= 0.85 * line.clientWidth) continue;
    const [first, second] = [...node.children], base = inner(first);
    if (node.localName === "mfrac") node.replaceWith(element("mrow", ...bracketed(first), sign("/"), ...bracketed(second)));
    else if (node.localName === "msqrt") node.replaceWith(element("mrow", sign("("), ...node.children, element("msup", sign(")"), element("mrow", element("mn", "1"), sign("/"), element("mn", "2")))));
    else if (base.children.length > 2 && base.lastElementChild.textContent === ")") node.replaceWith(element("mrow", ...[...base.children].slice(0, -1), element("msup", base.lastElementChild, second)));
  }
}

function fitFormulas() {
  for (const line of document.querySelectorAll("p.formula")) {
    const isWide = () => line.scrollWidth > line.clientWidth + 1;
    line.style.fontSize = "";
    if (!isWide()) continue;
    for (const [betweenFactors, loosened] of [[false, false], [true, false], [false, true], [true, false]]) {
      if (!isWide()) break;
      if (loosened) loosen(line);
      for (const math of [...line.querySelectorAll("math")]) if (math.getBoundingClientRect().width > 0.85 * line.clientWidth) breakFormula(math, betweenFactors);
    }
    for (let size = 0.85; isWide() && size > 0.45; size -= 0.05) line.style.fontSize = size + "rem";
  }
}

