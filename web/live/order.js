/** What the page asks for, or is told of, again and again: an older answer never replaces a newer one. */

/** @returns {{last: number}} */
export const subject = () => ({ last: 0 });

/** Asks or tells of a subject. @param {{last: number}} subject @returns {() => boolean} whether nobody has done so since */
export function question(subject) {
  const own = (subject.last += 1);
  return () => own === subject.last;
}
