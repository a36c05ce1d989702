/** "θ_s" and "x_d" as pieces of text, so that what stands under the line can be set there. Pure. */

/**
 * @param {string} text an underscore lowers the letters and digits after it
 * @returns {{text: string, lowered: boolean}[]}
 */
export function pieces(text) {
  return text.split(/(_[\p{L}\p{N}]+)/u).filter(Boolean).map((part) =>
    part[0] === "_" && part.length > 1 ? { text: part.slice(1), lowered: true } : { text: part, lowered: false });
}
