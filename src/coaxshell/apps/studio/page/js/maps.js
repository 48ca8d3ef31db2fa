// Diverging colour maps, centred on 0, safe for every kind of colour vision: blue to red for pressure, purple to orange for stress.
// In the dark theme no pressure is dark too: the same hues, lighter outwards.
const PRESSURE = {
  light: [[33, 102, 172], [103, 169, 207], [209, 229, 240], [247, 247, 247], [253, 219, 199], [239, 138, 98], [178, 24, 43]],
  dark: [[120, 190, 255], [56, 128, 196], [34, 68, 104], [30, 36, 44], [104, 48, 40], [206, 92, 64], [255, 168, 130]],
};
const STRESS = [[84, 39, 136], [153, 142, 195], [216, 218, 235], [200, 200, 200], [254, 224, 182], [241, 163, 64], [179, 88, 6]];

function mixed(stops, share) {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1), low = Math.min(Math.floor(at), stops.length - 2);
  return stops[low].map((part, k) => Math.round(part + (at - low) * (stops[low + 1][k] - part)));
}

// The front is tens of times louder than what the shells radiate. As in the library's figures, colours of the pressure are in proportion
// up to about a tenth of their end and follow the logarithm beyond (arsinh): the front is a line, and a hundredth of it is still seen.
const LINEAR = 0.1, WHOLE = Math.asinh(1 / LINEAR);
const compressed = (share) => Math.asinh(share / LINEAR) / WHOLE;

// The same colours of the stress as plotly takes them.
export const STRESS_SCALE = STRESS.map((stop, i) => [i / (STRESS.length - 1), `rgb(${stop.join(",")})`]);

const theme = () => (document.documentElement.dataset.theme === "dark" ? "dark" : "light");

// Colours of the bytes 0..255, 128 in the centre, as little-endian RGBA words, of the present theme.
const WORDS = Object.fromEntries(Object.entries(PRESSURE).map(([name, stops]) => [name, Uint32Array.from({ length: 256 }, (_, q) => {
  const [r, g, b] = mixed(stops, 0.5 + compressed((q - 128) / 127) / 2);
  return (255 << 24) | (b << 16) | (g << 8) | r;
})]));
export const words = () => WORDS[theme()];

export const stressColour = (share) => `rgb(${mixed(STRESS, 0.5 + share / 2).join(" ")})`;

const css = (colours) => `linear-gradient(to right, ${colours.join(", ")})`;
const SHARES = Array.from({ length: 41 }, (_, k) => (k - 20) / 20);
// Bars from one end of a scale to the other, in proportion to the pressure or the stress.
export const pressureBar = () => css(SHARES.map((share) => `rgb(${mixed(PRESSURE[theme()], 0.5 + compressed(share) / 2).join(" ")})`));
export const STRESS_BAR = css(SHARES.map(stressColour));
