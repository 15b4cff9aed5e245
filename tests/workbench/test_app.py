"""The server as the page meets it: every address, and what hostile requests get of it."""

from __future__ import annotations

import asyncio
import csv
import io
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.workbench.calling import HOST, Got, called

import torsional
from torsional.workbench import tasks
from torsional.workbench.app import Service, application
from torsional.workbench.beginning import design_from, example, examples, start
from torsional.workbench.frames import decoded, encoded
from torsional.workbench.guard import App, Rules
from torsional.workbench.jobs import Jobs
from torsional.workbench.pages import built_page
from torsional.workbench.workers import Workers

Ask = Callable[..., Got]
SESSION = ("x-session", "a-tab-of-the-tests")
SCRIPT = "<script>alert(1)</script>"
PAGE = {"index.html": "<!doctype html>", "assets/index-B3x.js": "let a = 1;" * 100, "assets/x.js.map": "{}"}


class Running:
    """The application alive in a loop of its own."""

    def __init__(self, make: Callable[[], App]) -> None:
        self.loop = asyncio.new_event_loop()
        self.thread = threading.Thread(target=self.loop.run_forever, daemon=True)
        self.thread.start()
        self.done, self.ready = asyncio.Event(), threading.Event()
        self.app = asyncio.run_coroutine_threadsafe(self._made(make), self.loop).result(60)
        self.life = asyncio.run_coroutine_threadsafe(self._alive(), self.loop)
        assert self.ready.wait(60)

    async def _made(self, make: Callable[[], App]) -> App:
        return make()

    async def _alive(self) -> None:
        said = ["lifespan.startup"]

        async def receive() -> Any:
            if said:
                return {"type": said.pop()}
            await self.done.wait()
            return {"type": "lifespan.shutdown"}

        async def send(message: Any) -> None:
            self.ready.set()

        await self.app({"type": "lifespan", "asgi": {"version": "3.0"}}, receive, send)

    def ask(self, *args: Any, **kwargs: Any) -> Got:
        return asyncio.run_coroutine_threadsafe(called(self.app, *args, **kwargs), self.loop).result(120)

    def stop(self) -> None:
        self.loop.call_soon_threadsafe(self.done.set)
        self.life.result(60)
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join(60)
        self.loop.close()


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("page")
    for name, text in PAGE.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")

    def make() -> App:
        design, model = design_from(Path("examples/truck_dmf.yaml"))
        service = Service(
            page=built_page(folder),
            start=start(design, "truck_dmf.yaml", model, ["best"]),
            examples=examples(),
            fronts=(encoded({"name": "best"}),),
            quick=Workers(tasks.work, 1, 60.0),
            slow=Workers(tasks.work, 1, 120.0),
            jobs=Jobs(tasks.background),
        )
        return application(service, Rules(frozenset([HOST])))

    made = Running(make)
    yield made
    made.stop()


@pytest.fixture
def ask(running: Running) -> Ask:
    return running.ask


def told(got: Got) -> dict[str, str]:
    """The first error of a refusal by its parts."""
    return dict(got.document["errors"][0])


# --- the page ---


def test_the_page_and_its_files(ask: Ask) -> None:
    page = ask("GET", "/")
    assert (page.status, page.body) == (200, b"<!doctype html>")
    assert page.headers["cache-control"] == "no-cache"
    plain, packed = (ask("GET", "/assets/index-B3x.js", None, [("accept-encoding", e)]) for e in ("", "gzip, br"))
    assert plain.body == PAGE["assets/index-B3x.js"].encode()
    assert packed.headers["content-encoding"] == "gzip" and len(packed.body) < len(plain.body) / 5
    assert plain.headers["cache-control"] == "public, max-age=31536000, immutable"
    assert plain.headers["content-type"].startswith("text/javascript")


def test_the_head_of_the_page_alone(ask: Ask) -> None:
    assert ask("HEAD", "/").status == 200
    assert ask("HEAD", "/nothing").status == 404


@pytest.mark.parametrize(
    "path",
    [
        "/assets/../../../pyproject.toml",
        "/assets/..%2f..%2fpyproject.toml",
        "/../../etc/passwd",
        "//etc/passwd",
        "/etc/passwd",
        "/assets/x.js.map",
        "/assets/",
        "/assets",
        "/index.html/",
        "/assets/index-B3x.js\0.html",
        "/api",
        "/api/",
        "/api/nothing",
        "/docs",
        "/openapi.json",
    ],
)
def test_nothing_but_its_files_is_there(ask: Ask, path: str) -> None:
    assert ask("GET", path).status == 404


def test_a_page_that_was_not_built_is_told(tmp_path: Path) -> None:
    with pytest.raises(torsional.ModelError, match="has not been built; 'make page' builds it"):
        built_page(tmp_path)


# --- answers ---


def test_what_a_page_begins_with(ask: Ask) -> None:
    found = ask("GET", "/api/start").document
    assert (found["name"], found["version"]) == ("truck_dmf.yaml", torsional.__version__)
    assert found["design"]["text"] == Path("examples/truck_dmf.yaml").read_text(encoding="utf-8")
    assert found["units"]["stiffness"] == {
        "unit": "kNm/rad",
        "factor": 1000.0,
        "label": "torsional stiffness",
        "symbol": "k",
    }
    assert {"name": "engine_start", "title": "Engine start"} in found["scenarios"]
    assert [each["name"] for each in found["examples"]] == ["truck", "line"]
    assert {each["type"] for each in found["absorbers"]} >= {"smf", "dmf", "psva"}
    assert found["fronts"] == [{"name": "best"}]
    assert ask("GET", "/api/examples/line").document["name"] == "line.yaml"
    assert ask("GET", "/api/examples/..%2Ftruck").status == 404
    assert decoded(ask("GET", "/api/fronts/0").body) == {"name": "best"}
    for number in ("1", "-1", "x", "9" * 100):
        assert ask("GET", f"/api/fronts/{number}").status == 404


def test_an_answer_has_the_figures_of_python(ask: Ask) -> None:
    design = ask("GET", "/api/start").document["design"] | {"changes": {"absorber.stiffness": "10 kNm/rad"}}
    got = ask("POST", "/api/answer", {"design": design, "ask": [{"view": "modes"}, {"view": "mode"}]})
    modes, misspelt = decoded(got.body)["answers"]
    model = torsional.changed(torsional.load_model("examples/truck_dmf.yaml"), "absorber.stiffness=10kNm/rad")
    system, _ = torsional.at_operating_point(model, model.typical_torque())
    assert (modes["frequency"] == torsional.modal(system, model.operation.idle).frequency.values).all()
    assert misspelt["errors"][0]["remedy"] == "did you mean 'modes'?"


@pytest.mark.parametrize(
    ("changes", "where", "problem"),
    [
        ({"absorber.stiffness": "12 kg"}, "absorber.stiffness", "kg is a mass, and a stiffness is wanted"),
        ({"absorber.stifness": "12"}, "absorber.stifness", "the key is unknown"),
        ({"absorber.stiffness": "-1"}, "absorber.stiffness", "must be positive"),
        ({"absorber.stiffness": True}, "absorber.stiffness", ""),
        ({"a..b": 1}, "", ""),
        ({"": 1}, "", ""),
        ({f"a{n}": 1 for n in range(1200)}, "design.changes", ""),
        ({"absorber": {"type": "dual_mass_flywheel"} | {f"k{n}": [[[[n]]]] for n in range(300)}}, "absorber", ""),
        ({"name": "x\u001b[2J"}, "name", ""),
        ({"name": "[" * 5000}, "name", ""),
    ],
    ids=lambda value: str(value)[:24],
)
def test_a_wrong_value_is_told_at_its_field(ask: Ask, changes: Any, where: str, problem: str) -> None:
    got = ask("POST", "/api/answer", {"design": {**example("truck"), "changes": changes}, "ask": [{"view": "modes"}]})
    assert got.status == 422
    assert told(got)["where"].startswith(where) and problem in told(got)["problem"]
    assert "Traceback" not in got.body.decode() and "this should not have happened" not in got.body.decode()


@pytest.mark.parametrize(
    "body",
    [
        [],
        {},
        {"design": {}},
        {"design": 1, "ask": [{"view": "modes"}]},
        {"design": {}, "ask": []},
        {"design": {}, "ask": [{}] * 9},
        {"design": {}, "ask": ["modes"]},
        {"design": {}, "ask": [{"view": "modes"}], "more": 1},
    ],
)
def test_a_body_of_another_shape_is_refused(ask: Ask, body: Any) -> None:
    assert ask("POST", "/api/answer", body).status == 400


@pytest.mark.parametrize("design", [{}, {"text": 1}, {"text": "a: 1"}, {"text": ""}, {"text": "x", "y": 1}])
def test_what_is_no_design_is_refused(ask: Ask, design: Any) -> None:
    for path, more in (("/api/answer", {"ask": [{"view": "modes"}]}), ("/api/save", {})):
        got = ask("POST", path, {"design": design, **more})
        assert got.status == 422 and told(got)["text"]


# --- files ---


@pytest.mark.parametrize("name", ["../../../etc/passwd", "/etc/passwd", "pyproject.toml", "truck13_full_load.csv"])
def test_no_file_of_the_server_is_read(ask: Ask, name: str) -> None:
    """Neither one that lies about nor one that lies beside the model it was started with."""
    text = example("truck")["text"] + f"\n# {SCRIPT}\n"
    found = ask("POST", "/api/open", {"text": text, "files": {}})
    assert (found.status, found.document["missing"]) == (200, [])
    design = {"text": text, "files": {}, "changes": {"engine.full_load": {"file": name}}}
    got = ask("POST", "/api/answer", {"design": design, "ask": [{"view": "modes"}]})
    assert got.status == 422
    assert "root:" not in got.body.decode() and "[project]" not in got.body.decode()
    assert told(got)["where"].startswith("engine.full_load")


@pytest.mark.parametrize(
    "text",
    [
        "a: &a [x]\nb: &b [*a, *a]\nc: [*b, *b]\n",
        "!!python/object/apply:os.system ['true']\n",
        "a: " + "[" * 5000,
        "torsional: 1\n" * 3,
        "a: 1\n" * 60_000,
        "\0",
        "x" * 300_000,
        "torsional: 1\nname: x\n<<: {a: 1}\n",
    ],
    ids=lambda text: text[:16],
)
def test_hostile_files_end_in_a_sentence(ask: Ask, text: str) -> None:
    for path, body in (("/api/open", {"text": text, "files": {}}), ("/api/save", {"design": {"text": text}})):
        got = ask("POST", path, body)
        assert got.status == 422
        assert told(got)["problem"] not in ("", "this should not have happened")


def test_a_model_is_saved_with_its_changes_and_comments(ask: Ask) -> None:
    design = {**example("truck"), "changes": {"name": "softer", "absorber.stiffness": "9 kNm/rad"}}
    text = ask("POST", "/api/save", {"design": design}).document["text"]
    assert "# " in text and "9 kNm/rad" in text
    again = ask("POST", "/api/open", {"text": text, "files": {}}).document
    assert again == {"design": {"text": text, "files": {}, "changes": {}}, "missing": []}


# --- exports ---

NAMED = {**example("truck"), "changes": {"name": SCRIPT, "clutch.stiffness": "20 kNm/rad"}}
VIEWS = ("model", "modes", "interference", "response", "map", "characteristic")


@pytest.mark.parametrize("view", VIEWS)
def test_every_picture_is_exported(ask: Ask, view: str) -> None:
    asked = {"view": view, **({"gears": ["12"]} if view == "map" else {})}
    svg = ask("POST", "/api/export", {"design": NAMED, "ask": asked, "format": "svg", "dark": True})
    assert svg.headers["content-disposition"] == f'attachment; filename="{view}.svg"'
    assert b"<svg" in svg.body and b"<script" not in svg.body and b"#15191e" in svg.body


def test_a_table_has_the_figures_of_the_page(ask: Ask) -> None:
    asked = {"view": "response", "speeds": 5, "nodes": ["gearbox_input"], "elements": []}
    (seen,) = decoded(ask("POST", "/api/answer", {"design": NAMED, "ask": [asked]}).body)["answers"]
    got = ask("POST", "/api/export", {"design": NAMED, "ask": asked, "format": "csv"})
    rows = list(csv.DictReader(io.StringIO(got.body.decode("utf-8-sig"))))
    heading = "acceleration gearbox_input, 0-peak [rad/s²]"
    assert [float(row[heading]) for row in rows] == seen["value"][0].T.ravel().tolist()


def test_designs_side_by_side_and_no_formulas(ask: Ask) -> None:
    variants = [{"name": "=cmd()", "design": example("truck")}, {"name": "softer", "design": NAMED}]
    got = ask("POST", "/api/export", {"variants": variants, "ask": {"view": "criteria"}, "format": "csv"})
    rows = list(csv.DictReader(io.StringIO(got.body.decode("utf-8-sig"))))
    assert {row["variant"] for row in rows} == {"'=cmd()", "softer"}
    png = ask("POST", "/api/export", {"variants": variants, "ask": {"view": "response"}, "format": "png"})
    assert (png.headers["content-type"], png.body[:4]) == ("image/png", b"\x89PNG")
    both = ask("POST", "/api/export", {"variants": variants, "ask": {"view": "model"}, "format": "png"})
    assert told(both)["problem"] == "this view shows one design at a time"
    assert ask("POST", "/api/export", {"ask": {"view": "modes"}, "format": "png"}).status == 400
    assert ask("POST", "/api/export", {"design": NAMED, "ask": {"view": "modes"}, "format": "exe"}).status == 400
    none = ask("POST", "/api/export", {"design": NAMED, "ask": {"view": "criteria"}, "format": "png"})
    assert told(none)["problem"] == "there is no picture of this view"


@pytest.mark.full
def test_the_report_is_that_of_the_command(ask: Ask) -> None:
    variants = [{"name": SCRIPT, "design": NAMED}, {"name": "shipped", "design": example("truck")}]
    got = ask("POST", "/api/report", {"variants": variants})
    assert got.headers["content-disposition"] == 'attachment; filename="report.html"'
    assert b"&lt;script&gt;" in got.body and b"<script" not in got.body


# --- jobs ---


def ended(ask: Ask, job: str) -> Any:
    """The state of a job when it has ended; it needs the processor that asking takes."""
    while True:
        state = ask("GET", f"/api/jobs/{job}", None, [SESSION]).document
        if state["state"] not in ("waiting", "running"):
            return state
        time.sleep(0.05)


def test_a_scenario_is_run_in_the_background(ask: Ask) -> None:
    asked = {"scenario": "tip_in", "values": {"duration": 0.2, "at": 0.05}}
    body = {"session": SESSION[1], "design": example("truck"), "kind": "scenario", "settings": asked}
    begun = ask("POST", "/api/jobs", body)
    assert begun.status == 202
    job = begun.document["job"]
    assert ask("GET", f"/api/jobs/{job}", None, [("x-session", "another-tab-altogether")]).status == 404
    assert ask("DELETE", f"/api/jobs/{job}", {}, [("x-session", "another-tab-altogether")]).status == 404
    assert ask("GET", f"/api/jobs/{job}").status == 404
    assert (ended(ask, job)["state"], ask("GET", f"/api/jobs/{job}/result").status) == ("done", 404)
    found = decoded(ask("GET", f"/api/jobs/{job}/result", None, [SESSION]).body)
    assert found["time"][-1] == pytest.approx(0.2)
    assert {channel["name"] for channel in found["channels"]} >= {"torque:clutch", "angular_velocity:primary"}
    for kind, begins in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("csv", b"\xef\xbb\xbftime [s]")):
        assert ask("GET", f"/api/jobs/{job}/export/{kind}", None, [SESSION]).body.startswith(begins)
    assert ask("GET", f"/api/jobs/{job}/export/frame", None, [SESSION]).status == 404
    assert ask("DELETE", f"/api/jobs/{job}", {}, [SESSION]).status == 200
    assert ask("GET", f"/api/jobs/{job}", None, [SESSION]).status == 404


def test_a_job_that_cannot_be_says_why(ask: Ask) -> None:
    asked = {"scenario": "../../etc/passwd"}
    body = {"session": SESSION[1], "design": example("truck"), "kind": "scenario", "settings": asked}
    state = ended(ask, ask("POST", "/api/jobs", body).document["job"])
    assert (state["state"], state["errors"][0]["where"]) == ("failed", "settings.scenario")


def test_a_job_of_no_kind_is_refused(ask: Ask) -> None:
    body = {"session": SESSION[1], "design": {}, "kind": "mining", "settings": {}}
    assert ask("POST", "/api/jobs", body).status == 400
    assert ask("POST", "/api/jobs", {**body, "kind": "region", "session": "short"}).status == 400
