/** Which of the journal's tabs is open. */
import { set, useStore } from "../store.js";

export const useTab = () => useStore((state) => state.tab);
export const showTab = (name) => set({ tab: name });
