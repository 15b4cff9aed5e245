// What is on the page first: the work of a link, else that of the tab before its reload, else the server's design.

import { Refused, keepToken, start } from "../protocol/client";
import type { Start } from "../protocol/messages";
import { loadDesign, tell } from "./actions";
import { isOwnLink, takeKept, takeLink } from "./keeping";
import { fragment } from "./link";
import { current, update } from "./store";

const PAUSE = 1500;

/** Takes token and link out of the address, where neither should stay. */
function takeAddress(): string | undefined {
  const isOwn = isOwnLink(location.hash);
  const { token, d } = fragment(location.hash);
  if (token) keepToken(token);
  if (token || d) history.replaceState(null, "", location.pathname + location.search);
  return isOwn ? undefined : d;
}

async function started(): Promise<Start> {
  for (;;) {
    try {
      return await start();
    } catch (problem) {
      if (problem instanceof Refused) throw problem;
      update({ stopped: "No connection to the workbench's server; trying again. Start it by: torsional workbench" });
      await new Promise((done) => setTimeout(done, PAUSE));
    }
  }
}

async function takeLinkOrTell(link: string): Promise<boolean> {
  try {
    await takeLink(link);
    return true;
  } catch {
    tell("The link holds no design: it may have been cut off on its way.");
    return false;
  }
}

export async function begin(): Promise<void> {
  const link = takeAddress();
  window.addEventListener("hashchange", () => {
    const later = takeAddress();
    if (later) void takeLinkOrTell(later);
  });
  try {
    const told = await started();
    const taken = link !== undefined ? await takeLinkOrTell(link) : takeKept();
    const notice = current().notice;
    if (!taken) loadDesign(told.design, told.name);
    update({ start: told, stopped: "", notice });
  } catch (problem) {
    update({ stopped: problem instanceof Error ? problem.message : String(problem) });
  }
}
