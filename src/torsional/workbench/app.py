"""The addresses of the workbench: each hands its question to a process, and its answer to the page.

FastAPI and uvicorn come with the extra `workbench`; this module is imported where they are known to be there.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from fastapi import FastAPI, Request, Response
from fastapi.responses import JSONResponse

from torsional.workbench import bodies
from torsional.workbench.guard import JSON, App, Guard, Rules
from torsional.workbench.jobs import Jobs
from torsional.workbench.pages import File
from torsional.workbench.refusals import RefusedError, document, refused
from torsional.workbench.workers import Workers

FRAME = "application/octet-stream"
KINDS = {"png": "image/png", "svg": "image/svg+xml", "csv": "text/csv; charset=utf-8", "html": "text/html"}
TIDY = 15.0  # [s] between looks at the jobs
BodyKind = TypeVar("BodyKind", bound=bodies.Body)


@dataclass(frozen=True)
class Service:
    """What answers: the ``page``, what it is told at its ``start``, shipped ``examples``, ``fronts`` as frames,
    processes for what is ``quick`` and for what is ``slow``, and ``jobs``."""

    page: Mapping[str, File]
    start: Mapping[str, Any]
    examples: Mapping[str, Any]
    fronts: tuple[bytes, ...]
    quick: Workers
    slow: Workers
    jobs: Jobs


def application(service: Service, rules: Rules) -> App:
    """The whole server as an ASGI application."""

    @contextlib.asynccontextmanager
    async def alive(_: FastAPI) -> AsyncIterator[None]:
        service.quick.begin()
        tidying = asyncio.ensure_future(_tidied(service.jobs))
        try:
            yield
        finally:
            tidying.cancel()
            for part in (service.quick, service.slow, service.jobs):
                part.close()

    app = FastAPI(openapi_url=None, docs_url=None, redoc_url=None, lifespan=alive, redirect_slashes=False)
    app.add_exception_handler(RefusedError, _refusal)
    app.add_exception_handler(404, _nothing)
    app.add_exception_handler(405, _nothing)
    app.add_exception_handler(Exception, _broken)
    _answering(app, service)
    _writing(app, service)
    _working(app, service)
    _showing(app, service)
    return Guard(app, rules)


def _answering(app: FastAPI, service: Service) -> None:
    """What the page asks at its start, and while values are changed."""

    @app.get("/api/start")
    async def start() -> Response:
        return JSONResponse(service.start)

    @app.get("/api/examples/{name}")
    async def example(name: str) -> Response:
        if name not in service.examples:
            raise refused(404, "there is no such example", allowed=", ".join(service.examples))
        return JSONResponse(service.examples[name])

    @app.get("/api/fronts/{number}")
    async def front(number: str) -> Response:
        if not (number.isascii() and number.isdigit() and int(number[:6]) < len(service.fronts)):
            raise refused(404, "there is no such front")
        return Response(service.fronts[int(number[:6])], media_type=FRAME)

    @app.post("/api/answer")
    async def answer(request: Request) -> Response:
        body = _read(bodies.Asked, request)
        return Response(await _of(service.quick, request, "answer", body.design, body.ask), media_type=FRAME)

    @app.post("/api/open")
    async def opened(request: Request) -> Response:
        body = _read(bodies.Opened, request)
        return JSONResponse(await _of(service.quick, request, "open", body.text, body.files))

    @app.post("/api/save")
    async def save(request: Request) -> Response:
        return JSONResponse(await _of(service.quick, request, "save", _read(bodies.Saved, request).design))


def _writing(app: FastAPI, service: Service) -> None:
    """Pictures, tables and reports."""

    @app.post("/api/export")
    async def export(request: Request) -> Response:
        body = _read(bodies.Exported, request)
        variants = [(each.name, each.design) for each in body.variants]
        listed = variants if body.design is None else [("", body.design), *variants]
        if not listed or len(listed) > len(variants) > 0:
            raise refused(400, "one design is wanted, or variants", where="design")
        data = await _of(service.slow, request, "export", listed, body.ask, body.format, body.dark)
        return _file(data, body.format, str(body.ask.get("view", "view")))

    @app.post("/api/report")
    async def report(request: Request) -> Response:
        variants = [(each.name, each.design) for each in _read(bodies.Reported, request).variants]
        return _file(await _of(service.slow, request, "report", variants), "html", "report")


def _working(app: FastAPI, service: Service) -> None:
    """Jobs in the background."""

    @app.post("/api/jobs")
    async def begin(request: Request) -> Response:
        body = _read(bodies.Commanded, request)
        name = service.jobs.begin(body.session, body.design, body.kind, body.settings)
        return JSONResponse({"job": name}, status_code=202)

    @app.get("/api/jobs/{job}")
    async def state(job: str, request: Request) -> Response:
        return JSONResponse(dict(service.jobs.state(job, _session(request))))

    @app.get("/api/jobs/{job}/result")
    async def result(job: str, request: Request) -> Response:
        return Response(service.jobs.result(job, _session(request)), media_type=FRAME)

    @app.get("/api/jobs/{job}/export/{kind}")
    async def file(job: str, kind: str, request: Request) -> Response:
        if kind not in KINDS:
            raise refused(404, "there is no such file", allowed="png, svg, csv")
        return _file(service.jobs.result(job, _session(request), kind), kind, "job")

    @app.delete("/api/jobs/{job}")
    async def cancel(job: str, request: Request) -> Response:
        service.jobs.cancel(job, _session(request))
        return JSONResponse({})


def _showing(app: FastAPI, service: Service) -> None:
    """The page itself, by the names of its files alone."""

    @app.api_route("/{path:path}", methods=["GET", "HEAD"])
    async def page(request: Request) -> Response:
        file = service.page.get(request.scope["path"])
        if file is None:
            raise refused(404, "there is no such page")
        packing = "gzip" in request.headers.get("accept-encoding", "")
        return Response(file.packed if packing else file.plain, headers=file.headers(packing))


async def _of(workers: Workers, request: Request, name: str, *asked: Any) -> Any:
    """What a process answers; given up where the page that asked has gone, or asks something newer."""
    working = asyncio.ensure_future(workers.answer((name, asked), _session(request)))
    leaving = asyncio.ensure_future(_left(request))
    try:
        await asyncio.wait((working, leaving), return_when=asyncio.FIRST_COMPLETED)
        if not working.done():
            raise refused(499, "the page has gone")
        return working.result()
    finally:
        working.cancel()
        leaving.cancel()


async def _left(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass


def _read(kind: type[BodyKind], request: Request) -> BodyKind:
    return bodies.read(kind, request.scope[JSON])


def _session(request: Request) -> str:
    """The tab that asks: the name that it made for itself, else the connection."""
    named = request.headers.get("x-session", "")[:64]
    return named or (":".join(map(str, request.client)) if request.client else "")


def _file(data: bytes, kind: str, name: str) -> Response:
    """A file to be saved; its name of our own letters."""
    plain = "".join(letter for letter in name if letter.isascii() and letter.isalpha())[:40] or "file"
    headers = {"content-disposition": f'attachment; filename="{plain}.{kind}"'}
    return Response(data, media_type=KINDS[kind], headers=headers)


async def _tidied(jobs: Jobs) -> None:
    while True:
        await asyncio.sleep(TIDY)
        jobs.tidy()


async def _refusal(_: Request, error: Exception) -> Response:
    assert isinstance(error, RefusedError)
    return JSONResponse(document(error.errors), status_code=error.status)


async def _broken(_: Request, error: Exception) -> Response:
    told = refused(500, "this should not have happened", found=type(error).__name__)
    return JSONResponse(document(told.errors), status_code=500)


async def _nothing(_: Request, error: Exception) -> Response:
    status = int(getattr(error, "status_code", 404))
    told = refused(status, "there is nothing at this address")
    return JSONResponse(document(told.errors), status_code=status)


