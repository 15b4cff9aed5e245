// What the page has drawn itself, as a file: an SVG with the canvas below it as an image, or the pixels of both.

import type { Look } from "./style";

/** Looks that come from the style sheet, which a file does not have. */
const PLAIN = { xmlns: "http://www.w3.org/2000/svg", "font-family": "system-ui, sans-serif", "font-size": "12" };
const DENSITY = 2;

/** The SVG of a picture, and its canvas in the same place; null where there is none yet. */
export function svgOf(picture: Element | null, look: Look): string | null {
  const drawn = picture?.querySelector<SVGSVGElement>("svg");
  if (!drawn) return null;
  const copy = drawn.cloneNode(true) as SVGSVGElement;
  for (const [name, value] of Object.entries(PLAIN)) copy.setAttribute(name, value);
  const below = picture!.querySelector("canvas");
  if (below) copy.prepend(imageOf(below));
  const paper = document.createElementNS(PLAIN.xmlns, "rect");
  for (const [name, value] of Object.entries({ width: "100%", height: "100%", fill: look.paper })) paper.setAttribute(name, value);
  copy.prepend(paper);
  return new XMLSerializer().serializeToString(copy);
}

function imageOf(canvas: HTMLCanvasElement): SVGImageElement {
  const image = document.createElementNS(PLAIN.xmlns, "image") as SVGImageElement;
  const { left, top, width, height } = canvas.style;
  const places = { href: canvas.toDataURL("image/png"), x: left, y: top, width, height };
  for (const [name, value] of Object.entries(places)) image.setAttribute(name, value.replace(/px$/, ""));
  return image;
}

export async function pngOf(svg: string): Promise<Blob> {
  const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width * DENSITY, image.height * DENSITY];
    canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await new Promise((done, fail) => canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error("the browser made no picture of it")))));
  } finally {
    URL.revokeObjectURL(address);
  }
}
