/** The tour from its beginning, for whoever asks. */
import { set } from "../store.js";

export const startTour = () => set({ tour: 0 });
