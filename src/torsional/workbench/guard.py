"""Who is answered: requests of the page that this server serves, of moderate size, and with its token if it has one.

The page is on a port of the user's own machine, to which every web site that is open in the same browser can send
requests.  What keeps them out: the name they came by (``Host``, against names rebound to this address), the page they
come from (``Origin``, ``Sec-Fetch-Site``), a content type that no form has, and the token.
"""

from __future__ import annotations

import asyncio
import hmac
import json
from collections.abc import Awaitable, Callable, Iterable, Mapping, MutableMapping
from dataclasses import dataclass
from typing import Any

from torsional.workbench.bodies import parsed
from torsional.workbench.refusals import RefusedError, document, refused

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Any]]
Send = Callable[[Any], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

BODY = 5_000_000
PATIENCE = 30.0  # [s] for a body to arrive
JSON = "torsional.json"
"""Where the scope of a request holds what its body says."""
HEADERS: Mapping[str, str] = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "font-src 'self'; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "x-frame-options": "DENY",
}
_METHODS = ("GET", "HEAD", "POST", "DELETE")


@dataclass(frozen=True)
class Rules:
    """The ``hosts`` by which the server is called, with their port; the ``token`` it asks for, if any; the most bytes
    of a ``body`` and the time [s] it may take."""

    hosts: frozenset[str]
    token: str = ""
    body: int = BODY
    patience: float = PATIENCE


def hosts(names: Iterable[str], port: int) -> frozenset[str]:
    """What ``Host`` may say of a server by these names.

    >>> sorted(hosts(["127.0.0.1", "::1"], 8210))
    ['127.0.0.1:8210', '[::1]:8210']
    """
    bracketed = [f"[{name}]" if ":" in name else name.lower() for name in names]
    return frozenset([f"{name}:{port}" for name in bracketed] + (bracketed if port == 80 else []))


@dataclass(frozen=True)
class Guard:
    """An ASGI application that lets requests through to another one, and puts security headers on every answer."""

    app: App
    rules: Rules

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        if scope["type"] != "http":  # the page opens no socket
            await send({"type": "websocket.close", "code": 1008})
            return
        guarded = _with_headers(send, scope["path"].startswith("/api"))
        try:
            headers = _headers(scope)
            self._admitted(scope, headers)
            if scope["method"] == "POST":
                scope[JSON] = parsed(await self._body(headers, receive))
        except RefusedError as refusal:
            await answered(guarded, refusal)
            return
        except ConnectionError:
            return
        await self.app(scope, receive, guarded)

    def _admitted(self, scope: Scope, headers: Mapping[str, str]) -> None:
        """RefusedError for who is none of ours."""
        rules = self.rules
        if headers.get("host", "").lower() not in rules.hosts:
            found = headers.get("host", "")[:100] or "none"
            remedy = "open the address that 'torsional workbench' told; a tunnel wants the same port at both ends"
            raise refused(403, "the server is not called by this name", where="Host", found=found, remedy=remedy)
        origin = headers.get("origin")
        if origin is not None and origin.lower() not in {f"http://{host}" for host in rules.hosts}:
            raise refused(403, "requests of other pages are not answered", where="Origin", found=origin[:100])
        if scope["method"] not in _METHODS:
            raise refused(405, "there is no such method", found=scope["method"][:20], allowed=", ".join(_METHODS))
        if not scope["path"].startswith("/api"):
            return
        if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
            raise refused(403, "requests of other pages are not answered", where="Sec-Fetch-Site")
        if rules.token and not _alike(headers.get("authorization", ""), f"Bearer {rules.token}"):
            raise refused(
                401,
                "the token is missing or wrong",
                where="Authorization",
                remedy="open the address that 'torsional workbench' told, with its token",
            )
        kind = headers.get("content-type", "").partition(";")[0].strip().lower()
        if scope["method"] in ("POST", "DELETE") and kind != "application/json":
            raise refused(
                415, "the request is not JSON", where="Content-Type", found=kind[:100], allowed="application/json"
            )

    async def _body(self, headers: Mapping[str, str], receive: Receive) -> bytes:
        """The body, counted while it arrives, whatever its length was said to be."""
        said = headers.get("content-length", "0")
        if said.isascii() and said.isdigit() and int(said[:20]) > self.rules.body:
            raise self._too_large()
        try:
            return await asyncio.wait_for(self._received(receive), self.rules.patience)
        except TimeoutError:
            raise refused(408, "the request took too long to arrive") from None

    async def _received(self, receive: Receive) -> bytes:
        parts, size, more = [], 0, True
        while more:
            message = await receive()
            if message["type"] != "http.request":
                raise ConnectionError
            parts.append(message.get("body", b""))
            size, more = size + len(parts[-1]), message.get("more_body", False)
            if size > self.rules.body:
                raise self._too_large()
        return b"".join(parts)

    def _too_large(self) -> RefusedError:
        most = f"{self.rules.body:,}".replace(",", " ")
        return refused(413, "the request is too large", allowed=f"at most {most} bytes")


async def answered(send: Send, refusal: RefusedError) -> None:
    """Tell a refusal."""
    body = json.dumps(document(refusal.errors)).encode()
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    if refusal.status in (408, 413):  # what is still on its way is not waited for
        headers.append((b"connection", b"close"))
    await send({"type": "http.response.start", "status": refusal.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def _with_headers(send: Send, private: bool) -> Send:
    """A sender that adds the security headers; answers of the interface are kept by nobody."""
    added = [*HEADERS.items(), *([("cache-control", "no-store")] if private else [])]
    encoded = [(name.encode(), value.encode()) for name, value in added]

    async def sent(message: Any) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", ()), *encoded]}
        await send(message)

    return sent


def _headers(scope: Scope) -> dict[str, str]:
    """The headers by name; RefusedError for one that decides and stands twice."""
    found: dict[str, str] = {}
    for name, value in scope["headers"]:
        key = name.decode("latin-1").lower()
        if key in found and key in ("host", "origin", "authorization", "content-type", "content-length"):
            raise refused(400, "a header stands twice", where=key)
        found[key] = value.decode("latin-1")
    return found


def _alike(given: str, wanted: str) -> bool:
    """Compared in a time that tells nothing of where they differ."""
    return hmac.compare_digest(given.encode("latin-1", "replace"), wanted.encode("latin-1", "replace"))
