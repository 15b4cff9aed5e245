"""Serving: a port, the names it may be called by, a token where others can reach it."""

from __future__ import annotations

import contextlib
import ipaddress
import os
import secrets
import socket
import sys
import threading
import webbrowser
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from torsional.errors import ModelError
from torsional.studies.crew import processors
from torsional.workbench import pages, tasks
from torsional.workbench.beginning import FIRST, design_from, example, examples, start
from torsional.workbench.frames import encoded
from torsional.workbench.fronts import front_of
from torsional.workbench.guard import Rules, hosts
from torsional.workbench.jobs import Jobs
from torsional.workbench.pages import built_page
from torsional.workbench.workers import Workers

HOST, PORT = "127.0.0.1", 8210
LOOPBACK = ("127.0.0.1", "localhost", "::1")
QUICK, SLOW = 15.0, 180.0
"""Time [s] for an answer, and for a picture or a report."""
NICE = 5
CONNECTIONS, KEPT = 256, 75
"""How many connections there may be, and how long [s] one is kept for the next request."""
TOKEN = 12
"""Letters that a token has at least."""
WARM = ("model", "modes", "interference", "response", "map", "characteristic", "criteria")


@dataclass(frozen=True)
class Asked:
    """What is served: a ``model`` file (None: the shipped truck), where, with which ``token``, by how many
    ``processes`` (0: two at most), beside which ``results``."""

    model: Path | None = None
    host: str = HOST
    port: int = PORT
    token: str = ""
    browser: bool = True
    processes: int = 0
    results: Sequence[Path] = field(default_factory=tuple)


def served(asked: Asked, listening: Callable[[str], None]) -> None:
    """Serve until interrupted; ``listening`` is called with the address when it can be opened.

    Raises ModelError, before anything is served, for a model, result or host that cannot be, a port that is taken, and
    where the page has not been built or the extra `workbench` is not installed.
    """
    uvicorn, _ = library("uvicorn"), library("fastapi")
    from torsional.workbench.app import Service, application

    token = _token(asked)
    design, name, model = _first(asked.model)
    fronts = [front_of(path) for path in asked.results]
    page = built_page(pages.HERE)
    with bound(asked.host, asked.port) as listener:
        port = listener.getsockname()[1]
        warm = ("answer", (design, [{"view": view} for view in WARM]))
        service = Service(
            page=page,
            start=start(design, name, model, [front["name"] for front in fronts]),
            examples=examples(),
            fronts=tuple(map(encoded, fronts)),
            quick=Workers(tasks.work, asked.processes or min(2, processors()), QUICK, warm),
            slow=Workers(tasks.work, 1, SLOW, nice=NICE),
            jobs=Jobs(tasks.background),
        )
        app = application(service, Rules(hosts(names_of(asked.host), port), token))
        address = told_address(asked.host, port, token)
        config = uvicorn.Config(
            app,
            log_config=None,
            log_level="error",
            access_log=False,
            server_header=False,
            lifespan="on",
            ws="none",
            limit_concurrency=CONNECTIONS,
            timeout_keep_alive=KEPT,
            timeout_graceful_shutdown=1,
            proxy_headers=False,
        )
        server = uvicorn.Server(config)
        listening(address)
        if asked.browser:
            threading.Timer(0.5, opened, (address,)).start()
        server.run(sockets=[listener])


def library(name: str) -> ModuleType:
    """A library that the extra `workbench` brings; raises ModelError where it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        remedy = "pip install 'torsional[workbench]'"
        raise ModelError("a library that the workbench needs is not installed", found=name, remedy=remedy) from None


def bound(host: str, port: int) -> socket.socket:
    """A socket that listens; ModelError for a port that is taken or not allowed, and for a host that is not here."""
    try:
        family, _, _, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
    except (OSError, UnicodeError):
        remedy = f"leave it out for this machine alone ({HOST}), or name an address of this machine"
        raise ModelError("there is no such host", where="--host", found=repr(host), remedy=remedy) from None
    # asyncio turns Nagle's algorithm off for sockets that name their protocol alone; with it an answer waits 40 ms
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        if os.name == "posix":  # elsewhere it would let two servers share a port
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(place)
        listener.listen(128)
    except OSError as error:
        listener.close()
        raise _unbound(host, port, error) from None
    return listener


def _unbound(host: str, port: int, error: OSError) -> ModelError:
    if isinstance(error, PermissionError):
        return ModelError("this port may not be used", where="--port", found=str(port), allowed="1024 to 65535, or 0")
    if error.errno == 99 or "assign" in (error.strerror or ""):
        return ModelError("this is no address of this machine", where="--host", found=repr(host))
    remedy = "another workbench may be at it; --port 0 takes one that is free"
    return ModelError("the port is taken", where="--port", found=str(port), remedy=remedy)


def is_loopback(host: str) -> bool:
    """Whether a host is reached from this machine alone.

    >>> is_loopback("127.0.0.1"), is_loopback("localhost"), is_loopback("0.0.0.0")
    (True, True, False)
    """
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def names_of(host: str) -> list[str]:
    """The names by which browsers may call the server; of one that listens everywhere all that the machine has."""
    named = [*LOOPBACK, host]
    if host in ("0.0.0.0", "::", ""):
        own = {socket.gethostname(), socket.getfqdn()}
        with contextlib.suppress(OSError):
            own |= {str(place[4][0]) for place in socket.getaddrinfo(socket.gethostname(), None)}
        named += sorted(own)
    return named


def told_address(host: str, port: int, token: str) -> str:
    """The address to open; the token stands behind #, which browsers send to nobody.

    >>> told_address("127.0.0.1", 8210, "")
    'http://127.0.0.1:8210/'
    """
    name = socket.gethostname() if host in ("0.0.0.0", "::", "") else f"[{host}]" if ":" in host else host
    return f"http://{name}:{port}/{f'#token={token}' if token else ''}"


def opened(address: str) -> None:
    """Show the page in a browser with windows; one for the terminal would take it over."""
    windows = sys.platform in ("win32", "darwin") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if windows:
        webbrowser.open(address)


def _token(asked: Asked) -> str:
    """The token given, one of our own where others can reach the server, or none."""
    if asked.token:
        if len(asked.token) < TOKEN or not (asked.token.isascii() and asked.token.replace("-", "_").isidentifier()):
            allowed = f"{TOKEN} letters and digits or more, - and _ among them"
            raise ModelError("this is no token", where="--token", found=f"{len(asked.token)} letters", allowed=allowed)
        return asked.token
    return "" if is_loopback(asked.host) else secrets.token_urlsafe(24)


def _first(path: Path | None) -> tuple[dict[str, Any], str, Any]:
    """The design to begin with, its name and model."""
    if path is not None:
        design, model = design_from(path)
        return design, path.name, model
    from torsional.files.load import model_from_tree
    from torsional.files.reader import parse_tree

    design = example(FIRST)
    return design, f"{FIRST}.yaml", model_from_tree(parse_tree(design["text"]))
