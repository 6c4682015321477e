/** Viridis (van der Walt and Smith 2015): even in lightness, readable with any colour vision. Every 1/15. */
const VIRIDIS = [
  "440154", "481a6c", "472f7d", "414487", "39568c", "31688e", "2a788e", "23888e",
  "1f988b", "22a884", "35b779", "54c568", "7ad151", "a5db36", "d2e21b", "fde725",
].map((hex) => [0, 2, 4].map((n) => parseInt(hex.slice(n, n + 2), 16)));

export function viridis(fraction: number): [number, number, number] {
  const x = Math.min(Math.max(fraction, 0), 1) * (VIRIDIS.length - 1);
  const n = Math.min(Math.floor(x), VIRIDIS.length - 2);
  return [0, 1, 2].map((d) => {
    const [a, b] = [VIRIDIS[n]![d]!, VIRIDIS[n + 1]![d]!];
    return Math.round(a + (x - n) * (b - a));
  }) as [number, number, number];
}

/** RGBA of 256 speeds; `fade`: entries over which rest fades into the background. */
function speedColours(fade: number): Uint8ClampedArray {
  const table = new Uint8ClampedArray(256 * 4);
  for (let n = 0; n < 256; ++n) {
    table.set(viridis(n / 255), 4 * n);
    table[4 * n + 3] = n < fade ? Math.round((255 * n) / fade) : 255;
  }
  return table;
}
export const AIR_COLOURS = speedColours(48);
export const BODY_COLOURS = speedColours(0);

/** Paints a slice into RGBA pixels, top row first (`flip`) or bottom row first. */
export function paintAir(
  pixels: Uint8Array, width: number, gain: number, out: Uint8ClampedArray, flip: boolean,
): void {
  const height = pixels.length / width;
  for (let row = 0; row < height; ++row) {
    const to = (flip ? height - 1 - row : row) * width;
    for (let column = 0; column < width; ++column) {
      const colour = Math.min(255, Math.round(pixels[row * width + column]! * gain)) * 4;
      for (let c = 0; c < 4; ++c) out[4 * (to + column) + c] = AIR_COLOURS[colour + c]!;
    }
  }
}

/** Okabe and Ito (2008): eight colours that any colour vision tells apart; without black and yellow. */
const BODIES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const BODIES_ON_DARK = ["#4db2ec", "#ff8a3d", "#2fd1a3", "#eba3cb", "#f2b640", "#8fd0f5"];

export function bodyColour(index: number, dark: boolean): string {
  const list = dark ? BODIES_ON_DARK : BODIES;
  return list[index % list.length]!;
}

/** x, y, z of a vector. */
export function componentColour(component: number, dark: boolean): string {
  return bodyColour([1, 2, 0][component]!, dark);
}

export function isDark(): boolean {
  return document.documentElement.dataset["theme"] === "dark";
}

/** Gives the swatches of bodies their colours, after they are made and when the theme changes. */
export function paintSwatches(): void {
  for (const swatch of document.querySelectorAll<HTMLElement>("[data-body]"))
    swatch.style.setProperty("--colour", bodyColour(Number(swatch.dataset["body"]), isDark()));
}
