/** Text with lowered letters: "θ_s". */
import { html } from "../view.js";
import { pieces } from "./notation.js";

/** @param {{text: string}} props */
export const Written = ({ text }) => pieces(text).map((piece) => (piece.lowered ? html`<sub>${piece.text}</sub>` : piece.text));
