// One look for every picture, in light and dark: Okabe and Ito's palette, which colour-blind eyes tell apart.

import { useEffect, useState } from "react";
import { current, useStore } from "../state/store";

export interface Look {
  dark: boolean;
  colours: string[];
  ink: string;
  faint: string;
  grid: string;
  shade: string;
  paper: string;
}

const LIGHT: Look = {
  dark: false,
  colours: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#b27d00", "#000000", "#777777"],
  ink: "#1d2430",
  faint: "#5b6675",
  grid: "#dfe4ea",
  shade: "#edf2f7",
  paper: "#ffffff",
};

const DARK: Look = {
  dark: true,
  colours: ["#56b4e9", "#ff8a33", "#2fc69a", "#e29ac2", "#3f8fd0", "#e6b422", "#ffffff", "#aab3be"],
  ink: "#e4e8ee",
  faint: "#a3aebb",
  grid: "#303844",
  shade: "#1e2630",
  paper: "#14181e",
};

/** Dashes that tell lines apart where the colour means something else. */
export const DASHES: number[][] = [[], [8, 5], [2, 4], [10, 4, 2, 4]];

function useMedia(query: string): boolean {
  const [matches, set] = useState(() => window.matchMedia(query).matches);
  useEffect(() => {
    const media = window.matchMedia(query);
    const heard = () => set(media.matches);
    media.addEventListener("change", heard);
    return () => media.removeEventListener("change", heard);
  }, [query]);
  return matches;
}

/** The look at this moment, outside of what is drawn by React. */
export function currentLook(): Look {
  const { theme } = current();
  return theme === "dark" || (theme === "system" && window.matchMedia("(prefers-color-scheme: dark)").matches) ? DARK : LIGHT;
}

export function useLook(): Look {
  const theme = useStore((state) => state.theme);
  const dark = useMedia("(prefers-color-scheme: dark)");
  return theme === "dark" || (theme === "system" && dark) ? DARK : LIGHT;
}

export function useCalm(): boolean {
  return useMedia("(prefers-reduced-motion: reduce)");
}
