"""An ASGI application called in memory, with every byte of the request as a test wants it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Coroutine, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, TypeVar

from torsional.workbench.guard import App

HOST = "127.0.0.1:8210"
Value = TypeVar("Value")


@dataclass(frozen=True)
class Got:
    """An answer: its status, headers and body."""

    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def document(self) -> Any:
        return json.loads(self.body)

    @property
    def problem(self) -> str:
        """What is told first of what is wrong."""
        return str(self.document["errors"][0]["problem"])


def soon(work: Coroutine[Any, Any, Value], within: float = 60.0) -> Value:
    """What comes of it; a failure where that lasts too long.

    In a thread of its own: that of the tests has a loop running once a browser was driven from it.
    """
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, asyncio.wait_for(work, within)).result()


async def called(
    app: App,
    method: str,
    path: str,
    body: object = None,
    headers: Iterable[tuple[str, str]] = (),
    *,
    parts: Sequence[bytes] | None = None,
    leaves: asyncio.Event | None = None,
) -> Got:
    """Call it; ``parts`` is the body as it arrives, ``leaves`` says when the client goes away."""
    given = {"host": HOST, **({"content-type": "application/json"} if method in ("POST", "DELETE") else {})}
    given |= {name.lower(): value for name, value in headers}
    whole = parts if parts is not None else [b"" if body is None else json.dumps(body).encode()]
    waiting = [{"type": "http.request", "body": p, "more_body": n < len(whole) - 1} for n, p in enumerate(whole)]
    sent: list[Any] = []

    async def receive() -> Any:
        if waiting:
            return waiting.pop(0)
        await (leaves or asyncio.Event()).wait()
        return {"type": "http.disconnect"}

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {
        "type": "http",
        "asgi": {"version": "3.0"},
        "http_version": "1.1",
        "method": method,
        "scheme": "http",
        "path": path,
        "raw_path": path.encode(),
        "root_path": "",
        "query_string": b"",
        "headers": [(name.encode(), value.encode("latin-1")) for name, value in given.items() if value != ""],
        "client": ("127.0.0.1", 50000),
        "server": ("127.0.0.1", 8210),
    }
    await app(scope, receive, send)
    kept = {name.decode().lower(): value.decode() for name, value in sent[0]["headers"]} if sent else {}
    return Got(sent[0]["status"] if sent else 0, kept, b"".join(message.get("body", b"") for message in sent[1:]))
