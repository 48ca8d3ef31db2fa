// Making elements: el("button", { type: "button", class: "quiet", onclick }, "Cancel").
const SVG = "http://www.w3.org/2000/svg";

function make(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

export const el = (tag, attributes, ...children) => make(document.createElement(tag), attributes, children);
export const svg = (tag, attributes, ...children) => make(document.createElementNS(SVG, tag), attributes, children);
export const by = (id) => document.getElementById(id);

let timer;
export function toast(text) {
  const box = by("toast");
  box.textContent = text;
  box.hidden = false;
  clearTimeout(timer);
  timer = setTimeout(() => { box.hidden = true; }, 5000);
}

// A text taken home as a file.
export function saveText(text, name, type = "application/toml") {
  const address = URL.createObjectURL(new Blob([text], { type })), anchor = el("a", { href: address, download: name });
  document.body.append(anchor);
  anchor.click();
  anchor.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

// A sentence in the place of what a box shows; without one, what it shows comes back.
export function instead(box, text) {
  box.querySelector(":scope > .instead")?.remove();
  box.classList.toggle("not-shown", Boolean(text));
  if (text) box.prepend(el("p", { class: "empty instead" }, text));
}
