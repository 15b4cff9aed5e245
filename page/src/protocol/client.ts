// Requests to the server, and what may come of them.

import { decodeFrame } from "./frame";
import type { Answer, Ask, Design, Fault, JobState, Json, Settings, Start } from "./messages";

/** The server refused, with sentences for the user; `status` is that of HTTP. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    readonly faults: Fault[],
  ) {
    super(faults.map((fault) => fault.text).join("\n") || `the server answered ${status}`);
  }
}

/** The server did not answer: it is gone, restarting, or the way to it is cut. */
export class Unreachable extends Error {}

const TOKEN = "torsional.token";

/** The token that the address brought, kept for this tab. */
export function keepToken(token: string): void {
  sessionStorage.setItem(TOKEN, token);
}

const SESSION_KEY = "torsional.session";

/** Tells this tab's requests and jobs from those of others; the same after a reload, so that they are found again. */
export function session(): string {
  const kept = sessionStorage.getItem(SESSION_KEY);
  if (kept) return kept;
  const made = crypto.getRandomValues(new Uint32Array(4)).join("-");
  sessionStorage.setItem(SESSION_KEY, made);
  return made;
}

function headers(more: Record<string, string>): Record<string, string> {
  const token = sessionStorage.getItem(TOKEN);
  return { ...more, "X-Session": session(), ...(token ? { Authorization: `Bearer ${token}` } : {}) };
}

async function reached(path: string, request: RequestInit): Promise<Response> {
  try {
    return await fetch(path, { ...request, cache: "no-store", credentials: "omit" });
  } catch (problem) {
    if (request.signal?.aborted) throw problem;
    throw new Unreachable("no connection to the workbench's server");
  }
}

async function refusal(response: Response): Promise<Error> {
  if (response.status >= 500) return new Unreachable(`the workbench's server answered ${response.status}`);
  const told: unknown = await response.json().catch(() => ({}));
  const faults = (told as { errors?: Fault[] }).errors ?? [];
  return new Refused(response.status, faults);
}

async function sent(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<Response> {
  const typed: Record<string, string> = method === "GET" ? {} : { "Content-Type": "application/json" };
  const request = { method, headers: headers(typed), body: body === undefined ? undefined : JSON.stringify(body), signal };
  const response = await reached(path, request);
  if (!response.ok) throw await refusal(response);
  return response;
}

/** One answer to each ask, in their order. */
export async function answers(design: Design, ask: Ask[], signal?: AbortSignal): Promise<Answer<object>[]> {
  const response = await sent("POST", "api/answer", { design, ask }, signal);
  return (decodeFrame(await response.arrayBuffer()) as { answers: Answer<object>[] }).answers;
}

export async function start(): Promise<Start> {
  return (await (await sent("GET", "api/start")).json()) as Start;
}

export async function example(name: string): Promise<{ design: Design; name: string }> {
  return (await sent("GET", `api/examples/${encodeURIComponent(name)}`)).json() as Promise<{ design: Design; name: string }>;
}

export interface Opened {
  design: Design;
  missing: string[];
}

export async function opened(text: string, files: Record<string, string>): Promise<Opened> {
  return (await sent("POST", "api/open", { text, files })).json() as Promise<Opened>;
}

export interface Saved {
  text: string;
  files: Record<string, string>;
}

export async function saved(design: Design): Promise<Saved> {
  return (await sent("POST", "api/save", { design })).json() as Promise<Saved>;
}

export interface Variant {
  name: string;
  design: Design;
}

export type Format = "png" | "svg" | "csv";

export interface Download {
  blob: Blob;
  name: string;
}

async function download(response: Response, otherwise: string): Promise<Download> {
  const told = /filename="?([^";]+)"?/.exec(response.headers.get("Content-Disposition") ?? "");
  return { blob: await response.blob(), name: told ? told[1] : otherwise };
}

export async function exported(variants: Variant[], ask: Ask, format: Format, dark: boolean): Promise<Download> {
  const subject = variants.length > 1 ? { variants } : { design: variants[0].design };
  return download(await sent("POST", "api/export", { ...subject, ask, format, dark }), `${ask.view}.${format}`);
}

export async function report(variants: Variant[]): Promise<Download> {
  return download(await sent("POST", "api/report", { variants }), "report.html");
}

export async function front(index: number): Promise<unknown> {
  return decodeFrame(await (await sent("GET", `api/fronts/${index}`)).arrayBuffer());
}

export type JobKind = "branches" | "region" | "scenario";

export async function beginJob(design: Design, kind: JobKind, settings: Settings): Promise<string> {
  const body: Json = { session: session(), design: design as unknown as Json, kind, settings };
  return ((await (await sent("POST", "api/jobs", body)).json()) as { job: string }).job;
}

export async function jobState(job: string): Promise<JobState> {
  return (await sent("GET", `api/jobs/${job}`)).json() as Promise<JobState>;
}

export async function jobResult(job: string): Promise<unknown> {
  return decodeFrame(await (await sent("GET", `api/jobs/${job}/result`)).arrayBuffer());
}

/** What a job gave as a file. */
export async function exportJob(job: string, kind: JobKind, format: Format): Promise<Download> {
  const found = await download(await sent("GET", `api/jobs/${job}/export/${format}`), "");
  return { ...found, name: `${kind}.${format}` };
}

export async function cancelJob(job: string): Promise<void> {
  await sent("DELETE", `api/jobs/${job}`, {});
}
