"""The tool that loads a server: it notices what it is there to notice."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from tests.test_project import ROOT, loaded
from tests.workbench.calling import soon

from torsional.workbench.frames import encoded


def answer(name: str, stiffness: float, **shown: Any) -> bytes:
    """What a server says of a design by its name and stiffness."""
    fields = [{"path": "absorber.stiffness", "value": stiffness}]
    return encoded({"answers": [{"name": name, "groups": [{"fields": fields}]}, shown]})


class Server:
    """Says what a test wants said."""

    session = "load"

    def __init__(self, say: Any) -> None:
        self.say = say

    async def asked(self, method: str, path: str, body: Mapping[str, Any]) -> tuple[int, bytes]:
        changes = body["design"]["changes"]
        found: tuple[int, bytes] = self.say(changes["name"], float(changes["absorber.stiffness"].split()[0]))
        return found


@pytest.mark.parametrize(
    ("say", "wrong"),
    [
        (lambda name, k: (200, answer(name, k)), []),
        (lambda name, k: (200, answer("session of another", k)), ["was told of", "holds another session's name"]),
        (lambda name, k: (200, answer(name, k + 1e-9 * k)), ["was told of"]),
        (lambda name, k: (200, answer(name, k, errors=[{"text": "must be positive"}])), ["must be positive"]),
        (lambda name, k: (429, b"{}"), ["429"]),
    ],
)
def test_what_is_wrong_is_told(say: Any, wrong: list[str]) -> None:
    tool = loaded(ROOT / "tools" / "workbench_load.py")
    tally = tool.Tally()
    session = tool.Session(0, ("127.0.0.1", 1, ""), {"text": "", "files": {}}, tally, 0.0)
    session.connection, session.others = Server(say), ["session of another"]
    soon(session.edit("modes"))
    assert len(tally.wrong) == len(wrong)
    assert all(any(part in told for told in tally.wrong) for part in wrong)
    assert sum(tally.answers.values()) == len(tally.times["modes"]) == 1
    assert tool.told(tally) == int(bool(wrong))


def test_a_late_answer_misses_the_bar(capsys: pytest.CaptureFixture[str]) -> None:
    tool = loaded(ROOT / "tools" / "workbench_load.py")
    tally = tool.Tally()
    tally.times["modes"] = [0.1] * 19 + [0.31] * 2
    assert tool.told(tally) == 1
    assert "late" in capsys.readouterr().out
    tally.times["modes"] = [0.1] * 90 + [0.31] * 2
    assert tool.told(tally) == 0
