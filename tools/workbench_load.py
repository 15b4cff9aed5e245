"""Many users at one workbench: how long their edits take, and whether anything of one comes to another.

    python tools/workbench_load.py --minutes 10

starts a server on the shipped truck (the page must have been built) and as many sessions as asked, each with a design
of its own name and stiffness.  A session turns a value, thinks for a moment, and turns it again, looking at one view
after the other; now and then it types a wrong value, saves, exports, or begins a job and cancels it.  An edit asks what
the page asks: the model and the view.  Times are of the whole request over a kept connection, of this machine's clock.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import random
import re
import subprocess
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from torsional.workbench.frames import decoded

ROOT = Path(__file__).parents[1]
VIEWS = ("modes", "characteristic", "response", "interference", "map", "criteria")
BARS = {"modes": 0.3, "characteristic": 0.3, "response": 1.0}
"""The 95th percentile [s] that an edit and a response may take."""
OTHERS = ("wrong", "save", "export", "job")


@dataclass
class Tally:
    """What all sessions saw: ``times`` [s] by what was asked, ``answers`` by status, ``wrong`` in words."""

    times: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    answers: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)


class Connection:
    """One kept connection, one request at a time, as a browser's."""

    def __init__(self, host: str, port: int, token: str, session: str) -> None:
        self.place, self.session = (host, port), session
        self.extra = f"authorization: Bearer {token}\r\n" if token else ""
        self.reader: asyncio.StreamReader | None = None

    async def asked(self, method: str, path: str, body: object = None) -> tuple[int, bytes]:
        """Status and body of an answer; a connection that the server closed while it was idle is opened again."""
        try:
            return await self._asked(method, path, body)
        except (asyncio.IncompleteReadError, ConnectionError) as error:
            if getattr(error, "partial", b""):
                raise
            self.reader = None
            return await self._asked(method, path, body)

    async def _asked(self, method: str, path: str, body: object) -> tuple[int, bytes]:
        if self.reader is None:
            self.reader, self.writer = await asyncio.open_connection(*self.place, limit=2**24)
        data = b"" if body is None else json.dumps(body).encode()
        head = f"{method} {path} HTTP/1.1\r\nhost: {self.place[0]}:{self.place[1]}\r\nx-session: {self.session}\r\n"
        head += f"{self.extra}content-type: application/json\r\ncontent-length: {len(data)}\r\n\r\n"
        self.writer.write(head.encode() + data)
        answer = (await self.reader.readuntil(b"\r\n\r\n")).decode("latin-1").lower()
        length = re.search(r"content-length: (\d+)", answer)
        found = await self.reader.readexactly(int(length[1])) if length else b""
        return int(answer[9:12]), found


class Session:
    """A user with a design of his own."""

    def __init__(
        self, number: int, place: tuple[str, int, str], design: dict[str, Any], tally: Tally, pause: float
    ) -> None:
        self.chance = random.Random(number)
        self.name = f"session {number} {self.chance.getrandbits(64):016x}"
        self.connection = Connection(*place, session=f"load-{number}-{self.chance.getrandbits(64):x}")
        self.tally, self.pause = tally, pause
        self.design: dict[str, Any] = {**design, "changes": {"name": self.name}}
        self.stiffness = 13e3

    async def lasting(self, until: float, names: Sequence[str]) -> None:
        """Work until then."""
        self.others = [name for name in names if name != self.name]
        while time.monotonic() < until:
            await asyncio.sleep(self.pause * self.chance.uniform(0.5, 1.5))
            if self.chance.random() < 0.03:
                await getattr(self, self.chance.choice(OTHERS))()
            else:
                await self.edit(self.chance.choice(VIEWS))

    async def edit(self, view: str) -> None:
        """Turn a value and look at a view."""
        self.stiffness = round(self.chance.uniform(8e3, 20e3), 3)
        self.design["changes"]["absorber.stiffness"] = f"{self.stiffness} Nm/rad"
        body = {"design": self.design, "ask": [{"view": "model"}, {"view": view}]}
        status, data = await self.timed(view, "POST", "/api/answer", body)
        if status == 200:
            self.check(decoded(data)["answers"], view)

    def check(self, answers: Sequence[Any], view: str) -> None:
        """The model is the session's own, to the value that it turned last."""
        model, shown = answers
        fields = {each["path"]: each["value"] for group in model["groups"] for each in group["fields"]}
        if model["name"] != self.name or fields["absorber.stiffness"] != self.stiffness:
            self.tally.wrong.append(f"{self.name} was told of {model['name']}, {fields['absorber.stiffness']}")
        if "errors" in shown:
            self.tally.wrong.append(f"{view}: {shown['errors'][0]['text']}")

    async def timed(self, kind: str, method: str, path: str, body: object = None, well: int = 200) -> tuple[int, bytes]:
        """Ask and note how long it took; no answer holds another session's name."""
        begun = time.perf_counter()
        status, data = await self.connection.asked(method, path, body)
        self.tally.times[kind].append(time.perf_counter() - begun)
        self.tally.answers[f"{kind} {status}"] += 1
        if status != well:
            self.tally.wrong.append(f"{kind}: {status} {data[:200]!r}")
        if any(other.encode() in data for other in self.others):
            self.tally.wrong.append(f"{kind}: an answer to {self.name} holds another session's name")
        return status, data

    async def wrong(self) -> None:
        """Type a value that cannot be."""
        changes = {**self.design["changes"], "absorber.stiffness": "twelve"}
        body = {"design": {**self.design, "changes": changes}, "ask": [{"view": "model"}]}
        await self.timed("wrong value", "POST", "/api/answer", body, well=422)

    async def save(self) -> None:
        """Save, and open what was saved."""
        status, data = await self.timed("save", "POST", "/api/save", {"design": self.design})
        if status == 200:
            saved = json.loads(data)
            if self.name not in saved["text"]:
                self.tally.wrong.append(f"{self.name} saved another model")
            await self.timed("open", "POST", "/api/open", saved)

    async def export(self) -> None:
        """A picture."""
        body = {"design": self.design, "ask": {"view": "response"}, "format": "png"}
        await self.timed("export", "POST", "/api/export", body)

    async def job(self) -> None:
        """Begin a run in time, look at it, cancel it."""
        asked = {"scenario": "tip_in", "values": {"duration": 0.5}}
        body = {"session": self.connection.session, "design": self.design, "kind": "scenario", "settings": asked}
        status, data = await self.connection.asked("POST", "/api/jobs", body)
        self.tally.answers[f"job {status}"] += 1
        if status != 202:  # the queue is full
            return
        name = json.loads(data)["job"]
        await asyncio.sleep(self.chance.uniform(0.0, 6.0))
        await self.timed("job state", "GET", f"/api/jobs/{name}")
        await self.timed("job cancel", "DELETE", f"/api/jobs/{name}", {})


async def worked(place: tuple[str, int, str], asked: argparse.Namespace) -> Tally:
    """All sessions, for so many minutes; they begin when the server has answered every view once."""
    first, tally = Connection(*place, session="load-first"), Tally()
    _, data = await first.asked("GET", "/api/start")
    design = json.loads(data)["design"]
    for _ in range(2 * asked.processes):
        await first.asked("POST", "/api/answer", {"design": design, "ask": [{"view": view} for view in VIEWS]})
    sessions = [Session(number, place, design, tally, asked.pause) for number in range(asked.sessions)]
    until = time.monotonic() + 60 * asked.minutes
    names = [session.name for session in sessions]
    await asyncio.gather(*(session.lasting(until, names) for session in sessions))
    return tally


def told(tally: Tally) -> int:
    """Print the figures; 1 where a bar is missed or something is wrong."""
    missed = bool(tally.wrong)
    print(f"{'asked':16}{'count':>8}{'median':>10}{'95 %':>10}{'99 %':>10}{'most':>10}  [ms]")
    for kind, times in sorted(tally.times.items()):
        median, *high = (1e3 * float(v) for v in np.percentile(times, [50, 95, 99, 100]))
        late = high[0] > 1e3 * BARS.get(kind, np.inf)
        missed |= late
        row = f"{kind:16}{len(times):8}{median:10.1f}" + "".join(f"{value:10.1f}" for value in high)
        print(row + ("  late" if late else ""))
    print("answers:", ", ".join(f"{kind} {count}" for kind, count in sorted(tally.answers.items())))
    print(f"wrong: {len(tally.wrong)}", *tally.wrong[:10], sep="\n  ")
    return int(missed)


def main() -> int:
    """Start a server, work at it, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--sessions", type=int, default=20)
    parser.add_argument("--pause", type=float, default=1.0, help="mean time between an answer and the next edit [s]")
    parser.add_argument("--processes", type=int, default=2)
    asked = parser.parse_args()
    line = [sys.executable, "-m", "torsional", "workbench", str(ROOT / "examples" / "truck_dmf.yaml"), "--port=0"]
    line += ["--no-browser", f"--processes={asked.processes}"]
    with subprocess.Popen(line, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        found = re.search(r"http://([^:]+):(\d+)/", server.stdout.readline())
        if found is None:
            return 1
        try:
            return told(asyncio.run(worked((found[1], int(found[2]), ""), asked)))
        finally:
            server.terminate()


if __name__ == "__main__":
    sys.exit(main())
