/** Numbers as an engineer writes them. */

export function fixed(value: number, digits: number): string {
  return value.toFixed(digits).replace(/^-/, "\u2212").replace(/^\u2212(0(\.0*)?)$/, "$1");
}

/** Three or so significant digits, thin powers of ten. */
export function short(value: number, digits = 3): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e5) {
    const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
    return fixed(value, decimals);
  }
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  return `${mantissa!.replace("-", "\u2212")}\u00d710${superscript(Number(exponent))}`;
}

/** Decimals that show `digits` digits of the largest value and no more: beside 3 m/s, 0.0000002 is 0. */
export function alike(largest: number, digits = 4): (value: number) => string {
  if (!(largest >= 1e-3 && largest < 1e5)) return (value) => (Math.abs(value) < largest * 10 ** -digits ? "0" : short(value, digits));
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(largest)));
  return (value) => fixed(value, decimals);
}

function superscript(n: number): string {
  const digits = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
  return (n < 0 ? "\u207b" : "") + [...String(Math.abs(n))].map((d) => digits[Number(d)]).join("");
}

export function thousands(value: number): string {
  return Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

export function duration(seconds: number): string {
  if (seconds < 60) return `${short(seconds)} s`;
  const whole = Math.round(seconds);
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor((whole % 3600) / 60)} min`;
}

/** Bytes as memory is sold: 25276514304 -> 25.3 GB. */
export function bytes(count: number): string {
  return count < 1e9 ? `${short(count / 1e6)} MB` : `${short(count / 1e9)} GB`;
}

/** "momentum_relative_residual" -> "Momentum relative residual". */
export function words(key: string): string {
  const text = key.replace(/_/g, " ");
  if (text.length === 1) return text; // a symbol: k is no kelvin
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** The unit at the end of a key of result.json: "air_kinetic_energy_J" -> "Air kinetic energy [J]". */
export function labelOf(key: string): string {
  const found = /^(.+?)_(rad_s|m_s|N_s|N_m|kg|Pa|J|N|K|W|m|s)$/.exec(key);
  if (!found) return words(key);
  const unit = { rad_s: "rad/s", m_s: "m/s", N_s: "N\u00b7s", N_m: "N\u00b7m" }[found[2]!] ?? found[2]!;
  return `${words(found[1]!)} [${unit}]`;
}

/** Keeps every number of a sentence on one line with its unit. */
export function unbroken(sentence: string): string {
  return sentence.replace(/(\d) (?=\S)/g, "$1\u00a0");
}

/** Unit as printed: "N m" -> "N·m", "1" -> nothing. */
export function unitText(unit: string): string {
  return unit === "1" ? "" : unit.replace(/ /g, "\u00b7").replace(/(?<=m|s)2\b/g, "\u00b2");
}

/** Ticks at 1, 2 or 5 times a power of ten. */
export function ticks(from: number, to: number, about: number): number[] {
  const raw = (to - from) / about;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((s) => s * power >= raw) ?? 10);
  const list = [];
  for (let n = Math.ceil(from / step - 1e-9); n * step <= to + 1e-9 * step; ++n) list.push(n * step);
  return list;
}
