/** Whether there is so little room that the details of a run are a sheet over everything but the bar. */
export const SHEET = matchMedia("(max-width: 699px)");
