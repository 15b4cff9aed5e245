"""Who is answered: every request that is none of the page's is refused, by trying."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest
from tests.workbench.calling import HOST, Got, called, soon

from torsional.workbench.guard import JSON, Guard, Rules, hosts

RULES = Rules(hosts(["127.0.0.1", "localhost", "::1"], 8210), body=1000, patience=0.2)
TOKEN = "a-token-of-the-tests"


async def echo(scope: Any, receive: Any, send: Any) -> None:
    """Tells what it was given."""
    body = json.dumps(scope.get(JSON)).encode()
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-type", b"text/plain")]})
    await send({"type": "http.response.body", "body": body})


def got(method: str, path: str, *args: Any, rules: Rules = RULES, **kwargs: Any) -> Got:
    return soon(called(Guard(echo, rules), method, path, *args, **kwargs))


def test_what_the_page_asks_is_let_through() -> None:
    assert got("GET", "/").status == 200
    told = got("POST", "/api/answer", {"ask": [1.5]}, [("origin", f"http://{HOST}"), ("sec-fetch-site", "same-origin")])
    assert (told.status, told.document) == (200, {"ask": [1.5]})
    assert got("GET", "/api/start", None, [("host", "[::1]:8210")]).status == 200
    assert got("GET", "/api/start", None, [("host", "LOCALHOST:8210")]).status == 200


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8210", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8210.evil.example", ""]
)
@pytest.mark.parametrize("path", ["/", "/api/start"])
def test_a_name_rebound_to_this_address_gets_nothing(host: str, path: str) -> None:
    told = got("GET", path, None, [("host", host)])
    assert (told.status, told.problem) == (403, "the server is not called by this name")


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9999", f"https://{HOST}", "file://"])
def test_requests_of_other_pages_get_nothing(origin: str) -> None:
    told = got("POST", "/api/answer", {}, [("origin", origin)])
    assert (told.status, told.problem) == (403, "requests of other pages are not answered")


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_a_browser_that_says_it_comes_from_elsewhere_gets_the_page_alone(site: str) -> None:
    assert got("GET", "/api/start", None, [("sec-fetch-site", site)]).status == 403
    assert got("GET", "/", None, [("sec-fetch-site", site)]).status == 200  # a link in a mail


@pytest.mark.parametrize(
    "brought", ["", TOKEN, f"Bearer {TOKEN}x", f"Bearer {TOKEN[:-1]}", "Bearer", f"bearer {TOKEN}", "Bearer \xff"]
)
def test_without_the_token_nothing_is_told(brought: str) -> None:
    rules = Rules(RULES.hosts, TOKEN)
    for method, path in (("GET", "/api/start"), ("POST", "/api/answer"), ("DELETE", "/api/jobs/x")):
        told = got(method, path, {}, [("authorization", brought)], rules=rules)
        assert (told.status, told.problem) == (401, "the token is missing or wrong")
        assert TOKEN not in told.body.decode()
    assert got("GET", "/", rules=rules).status == 200  # the page itself holds nothing of anybody's


def test_with_the_token_it_is() -> None:
    told = got("POST", "/api/answer", [1], [("authorization", f"Bearer {TOKEN}")], rules=Rules(RULES.hosts, TOKEN))
    assert told.document == [1]


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""])
@pytest.mark.parametrize("method", ["POST", "DELETE"])
def test_what_a_form_could_send_is_refused(method: str, kind: str) -> None:
    assert got(method, "/api/answer", {}, [("content-type", kind)]).status == 415


@pytest.mark.parametrize("method", ["PUT", "PATCH", "TRACE", "CONNECT", "OPTIONS"])
def test_there_are_four_methods(method: str) -> None:
    told = got(method, "/api/answer")
    assert told.status == 405
    assert "access-control-allow-origin" not in told.headers


def test_a_large_body_is_refused_by_its_length_before_it_arrives() -> None:
    told = got("POST", "/api/answer", headers=[("content-length", "1001")], parts=[b"never read"])
    assert (told.status, told.problem) == (413, "the request is too large")


@pytest.mark.parametrize("length", ["", "10", "-1", "x"])
def test_a_large_body_is_refused_while_it_arrives(length: str) -> None:
    """Chunked, or of another length than was said: 600 + 600 bytes, of which the third part is never asked for."""
    parts = [b'["' + b"a" * 598, b"a" * 600, b'"]']
    told = got("POST", "/api/answer", headers=[("content-length", length)], parts=parts)
    assert (told.status, told.headers["connection"]) == (413, "close")


def test_a_body_of_just_the_size_is_read() -> None:
    assert got("POST", "/api/answer", parts=[b'"' + b"a" * 500, b"a" * 498 + b'"']).document == "a" * 998


def test_a_body_that_does_not_come_is_not_waited_for() -> None:
    async def trickling() -> Got:
        guard, sent = Guard(echo, RULES), []

        async def receive() -> Any:
            if not sent:
                await asyncio.sleep(0.01)
            return {"type": "http.request", "body": b" ", "more_body": True}

        async def held() -> Any:
            return await asyncio.sleep(60)

        async def send(message: Any) -> None:
            sent.append(message)

        headers = [(b"host", HOST.encode()), (b"content-type", b"application/json")]
        scope = {"type": "http", "method": "POST", "path": "/api/answer", "headers": headers}
        await guard(scope, held, send)
        return Got(sent[0]["status"], {}, sent[1]["body"])

    assert soon(trickling()).problem == "the request took too long to arrive"


DEEP = b"[" * 100_000 + b"]" * 100_000


@pytest.mark.parametrize(
    ("body", "found"),
    [
        (b"", "Expecting value"),
        (b"{", "Expecting"),
        (b"{'a': 1}", "Expecting"),
        (b'{"a": NaN}', "NaN is no number"),
        (b'{"a": [Infinity]}', "Infinity is no number"),
        (b'{"a": -Infinity}', "-Infinity is no number"),
        (b'{"a": 1e999}', "too large"),
        (b'{"a": 1, "a": 2}', "a key stands twice"),
        (b"\xff\xfe{}", "utf-8"),
        (b'{"a": "\\ud800"}', "half a character"),
        (b'{"\\udc00": 1}', "half a character"),
        (b"1" * 5000, "digit"),
        (b"[" * 33 + b"]" * 33, "nested too deeply"),
        (DEEP, "nested too deeply"),
        (b"[" + b"0," * 250_000 + b"0]", "too many values"),
    ],
    ids=lambda value: str(value[:12]),
)
def test_what_is_no_strict_json_is_refused(body: bytes, found: str) -> None:
    told = got("POST", "/api/answer", parts=[body], rules=Rules(RULES.hosts))
    assert told.status == 400
    assert found in told.document["errors"][0]["text"]


def test_just_so_deep_is_read() -> None:
    assert got("POST", "/api/answer", parts=[b"[" * 32 + b"]" * 32]).status == 200


@pytest.mark.parametrize("name", ["host", "origin", "authorization", "content-type"])
def test_a_header_that_decides_stands_once(name: str) -> None:
    async def twice() -> int:
        statuses = []

        async def send(message: Any) -> None:
            statuses.append(message.get("status"))

        headers = [(b"host", HOST.encode()), (b"content-type", b"application/json")]
        headers += [(name.encode(), b"evil.example"), (name.encode(), b"evil.example")]
        scope = {"type": "http", "method": "POST", "path": "/api/answer", "headers": headers}
        await Guard(echo, RULES)(scope, send, send)
        return int(statuses[0])

    assert soon(twice()) == 400


@pytest.mark.parametrize(("path", "host"), [("/", HOST), ("/api/start", HOST), ("/", "evil.example")])
def test_every_answer_says_what_the_page_may_do(path: str, host: str) -> None:
    told = got("GET", path, None, [("host", host)]).headers
    policy = told["content-security-policy"]
    assert "default-src 'none'" in policy and "script-src 'self';" in policy and "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy and "http" not in policy and "*" not in policy
    assert told["x-content-type-options"] == "nosniff"
    assert told["referrer-policy"] == "no-referrer"
    assert told["cross-origin-opener-policy"] == told["cross-origin-resource-policy"] == "same-origin"
    assert ("no-store" in told.get("cache-control", "")) == path.startswith("/api")


def test_a_socket_is_closed() -> None:
    sent: list[Any] = []

    async def send(message: Any) -> None:
        sent.append(message)

    soon(Guard(echo, RULES)({"type": "websocket", "path": "/", "headers": []}, send, send))
    assert sent == [{"type": "websocket.close", "code": 1008}]
