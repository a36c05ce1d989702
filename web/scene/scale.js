/** The numbers on the field's scale. Pure. */

/** Begin, middle and end. @param {number} full end of the scale, mT @returns {string[]} */
export const marks = (full) => [0, full / 2, full].map((value) => String(Number(value.toFixed(1))));
