"""`torsional workbench`: refused before anything is served, served to its own page, ended by Ctrl-C."""

from __future__ import annotations

import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from tests.shipped import ROOT
from tests.signals import listening

import torsional as package
from torsional.workbench import pages, start
from torsional.workbench.frames import decoded

Run = Callable[..., Any]
CODE = """
import sys
from pathlib import Path
from torsional.cli import main
from torsional.workbench import pages
pages.HERE = Path(sys.argv.pop(1))
sys.exit(main())
"""


@pytest.fixture
def page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A page that was built."""
    folder = tmp_path / "page"
    folder.mkdir()
    (folder / "index.html").write_text("<!doctype html><title>the page</title>", encoding="utf-8")
    monkeypatch.setattr(pages, "HERE", folder)
    return folder


@contextmanager
def serving(page: Path, *arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A server in a process of its own, and the address that it says."""
    own = {**os.environ, "PYTHONPATH": str(Path(package.__file__).parents[1])}
    line = [sys.executable, "-c", CODE, str(page), "workbench", *arguments, "--port=0", "--no-browser", "--processes=1"]
    pipes: Any = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    process = subprocess.Popen(line, env=own, preexec_fn=listening, cwd=ROOT, **pipes)
    assert process.stdout is not None
    try:
        found = re.search(r"http://\S+", process.stdout.readline())
        assert found, process.communicate()
        yield process, found[0]
    finally:
        process.kill()
        process.communicate()


def answered(address: str, method: str, path: str, body: object = None, **headers: str) -> tuple[int, bytes]:
    """What a server says."""
    place = address.removeprefix("http://").partition("/")[0]
    connection = http.client.HTTPConnection(place, timeout=120)
    sent = {"content-type": "application/json", **{name.replace("_", "-"): value for name, value in headers.items()}}
    connection.request(method, path, None if body is None else json.dumps(body), sent)
    got = connection.getresponse()
    found = got.status, got.read()
    connection.close()
    return found


def test_a_model_is_served_until_ctrl_c(page: Path) -> None:
    with serving(page, "examples/truck_dmf.yaml") as (process, address):
        assert address.startswith("http://127.0.0.1:") and address.endswith("/")
        assert answered(address, "GET", "/")[1].startswith(b"<!doctype html>")
        begun = json.loads(answered(address, "GET", "/api/start")[1])
        asked = {"design": begun["design"], "ask": [{"view": "modes"}]}
        status, frame = answered(address, "POST", "/api/answer", asked)
        assert (status, begun["name"]) == (200, "truck_dmf.yaml")
        system, _ = package.at_operating_point(package.load_model(ROOT / "examples" / "truck_dmf.yaml"), 2500.0)
        assert decoded(frame)["answers"][0]["frequency"].tolist() == package.modal(
            system, 600 * package.RPM
        ).frequency.values.tolist()
        assert answered(address, "GET", "/api/start", host="evil.example")[0] == 403
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        assert (process.returncode, err) == (0, "")
        assert out.endswith("\nThe workbench has ended.\n")


@pytest.mark.full
def test_beyond_this_machine_a_token_is_made_and_wanted(page: Path) -> None:
    with serving(page, "--host=0.0.0.0") as (_, address):
        token = re.search(r"/#token=([\w-]{20,})$", address)
        assert token
        own = re.sub(r"//[^:]+", "//127.0.0.1", address)
        assert answered(own, "GET", "/")[0] == 200
        assert answered(own, "GET", "/api/start")[0] == 401
        assert answered(own, "GET", "/api/start", authorization=f"Bearer {token[1]}")[0] == 200


def test_what_cannot_be_served_is_told_first(torsional: Run, page: Path, tmp_path: Path, truck: str) -> None:
    (tmp_path / "bad.yaml").write_text("torsional: 1\nname: x\nclutch: {stifness: 1}\n", encoding="utf-8")
    for arguments, said in (
        (["none.yaml"], "there is no such file"),
        (["bad.yaml"], "clutch"),
        ([truck, "--results", "none.nc"], "none.nc"),
        ([truck, "--results", truck], "truck_dmf.yaml"),
        ([truck, "--host", "no.such.host.invalid"], "--host: there is no such host; found 'no.such.host.invalid'"),
        ([truck, "--host", "192.0.2.7"], "--host: this is no address of this machine; found '192.0.2.7'"),
        ([truck, "--token", "short"], "--token: this is no token; found 5 letters; allowed: 12 letters and digits"),
        ([truck, "--token", "spaces are no letters"], "--token: this is no token"),
        ([truck, "--port", "70000"], "--port"),
    ):
        told = torsional("workbench", *arguments, "--no-browser")
        assert (told.code, told.out) == (2, "")
        assert said in told.err and told.err.count("error:") == 1 and "Traceback" not in told.err


def test_a_port_that_is_taken_is_told(torsional: Run, page: Path, truck: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        told = torsional("workbench", truck, "--port", port, "--no-browser")
    assert told.code == 2
    assert f"--port: the port is taken; found {port}; another workbench may be at it; --port 0 takes" in told.err


def test_a_page_that_was_not_built_and_libraries_that_are_missing(
    torsional: Run, tmp_path: Path, truck: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pages, "HERE", tmp_path)
    assert "the page of the workbench has not been built" in torsional("workbench", truck, "--no-browser").err
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    told = torsional("workbench", truck, "--no-browser")
    assert (told.code, "pip install 'torsional[workbench]'" in told.err) == (2, True)


@pytest.mark.parametrize(
    ("host", "alone"),
    [
        ("127.0.0.1", True),
        ("127.8.9.1", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("::", False),
        ("192.0.2.7", False),
        ("localhost.evil.example", False),
        ("", False),
    ],
)
def test_whom_a_host_lets_in(host: str, alone: bool) -> None:
    assert start.is_loopback(host) == alone


def test_the_names_of_a_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """One address has that name and those of this machine alone; all addresses have all names of the machine."""
    assert start.names_of("127.0.0.1") == ["127.0.0.1", "localhost", "::1", "127.0.0.1"]
    assert socket.gethostname() in start.names_of("0.0.0.0")
    assert start.told_address("::1", 8210, "a-token") == "http://[::1]:8210/#token=a-token"


def test_a_browser_is_opened_only_where_there_are_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr(start.webbrowser, "open", opened.append)
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    start.opened("http://127.0.0.1:8210/")
    assert opened == []
    monkeypatch.setenv("DISPLAY", ":0")
    start.opened("http://127.0.0.1:8210/")
    assert opened == ["http://127.0.0.1:8210/"]


def test_answers_wait_for_no_acknowledgement() -> None:
    """asyncio sets TCP_NODELAY on what a socket accepts only where that names its protocol: else a request takes 40 ms
    more."""
    with start.bound("127.0.0.1", 0) as listener:
        assert listener.proto == socket.IPPROTO_TCP
