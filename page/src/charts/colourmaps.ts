// Colour maps of the pictures, as matplotlib has them, by a few colours each with straight lines between.

const AMOUNT_COLOURS =
  "#00224e #003170 #2a3f6d #434e6c #575d6d #6a6c71 #7d7c78 #918b78 #a59c74 #bcae6c #d2c060 #e9d34e #fee838";
const RATIO_COLOURS =
  "#053061 #1c5c9f #3783bb #6bacd1 #a7d0e4 #d7e8f1 #f7f6f6 #fcdfcf #f7b799 #e48066 #c94741 #a51429 #67001f";

export type ColourMap = (share: number) => [number, number, number];

function mapOf(colours: string): ColourMap {
  const stops = colours.split(" ").map((colour) => [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16)));
  return (share) => {
    const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
    const below = Math.min(Math.floor(at), stops.length - 2);
    const mixed = (i: number) => Math.round(stops[below][i] + (at - below) * (stops[below + 1][i] - stops[below][i]));
    return [mixed(0), mixed(1), mixed(2)];
  };
}

/** From little to much, rising in lightness (cividis). */
export const AMOUNT = mapOf(AMOUNT_COLOURS);

/** From less through as much to more: blue, white, red (RdBu reversed). */
export const RATIO = mapOf(RATIO_COLOURS);
