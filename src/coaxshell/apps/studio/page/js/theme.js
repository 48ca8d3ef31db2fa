// Light or dark: the system's wish until the person chooses.
const wish = matchMedia("(prefers-color-scheme: dark)");

function stored() {
  try { return localStorage.getItem("coaxshell-theme"); } catch { return null; }
}

function show() {
  const theme = stored() ?? (wish.matches ? "dark" : "light");
  document.documentElement.dataset.theme = theme;
  const button = document.getElementById("theme");
  if (button) {
    button.textContent = theme === "dark" ? "Light" : "Dark";
    button.setAttribute("aria-label", `Switch to the ${theme === "dark" ? "light" : "dark"} theme`);
  }
  document.dispatchEvent(new CustomEvent("theme"));
}

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

wish.addEventListener("change", show);
document.getElementById("theme")?.addEventListener("click", () => {
  const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  try { localStorage.setItem("coaxshell-theme", next); } catch { /* private windows may refuse */ }
  show();
});
show();
