"""`torsional claims`: page and document, ids and letters, own trucks, refusals."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.shipped import EXAMPLES

from torsional.cli.claims import chosen_ids
from torsional.errors import ModelError
from torsional.studies.register import claims

Run = Callable[..., Any]


def test_page_and_document_tell_the_same(torsional: Run) -> None:
    told = torsional("claims", "A2", "A7", "--trucks", "3", "--processes", "1", "-o", "mine.html")
    assert (told.code, told.err) == (0, "written: mine.html\nwritten: mine.json\n")
    assert re.search(r"A2 +reproduced +3 of 3", told.out)
    page, document = Path("mine.html").read_text(), json.loads(Path("mine.json").read_text())
    assert [each["id"] for each in document["claims"]] == ["A2", "A7"]
    first = document["claims"][0]
    assert first["verdict"] == "reproduced" and first["robustness"]["asked"] == 3
    assert f"{first['figures']['order speeds [rpm]'][0]:.4g}" in page
    assert all(text in page for text in ("§ 2.1", 'href="#claim-A7"', 'id="claim-A7"', "as shipped", "3 of 3"))
    assert page.count("<img") == 2 + ("turns" in page and "turned by:" in page)


def test_a_second_run_writes_the_same_document(torsional: Run) -> None:
    for name in ("one", "two"):
        assert torsional("claims", "A6", "C2", "--quick", "--processes", "1", "-q", "-o", f"{name}.html").code == 0
    one, two = (Path(f"{name}.json").read_text() for name in ("one", "two"))
    assert one == two
    assert "robustness" not in one


def test_own_truck(torsional: Run) -> None:
    told = torsional("claims", "A7", "--truck", EXAMPLES / "truck_psva.yaml", "--quick", "--json")
    document = json.loads(told.out)
    assert document["model"]["name"] == "13-litre truck with a power split absorber"
    assert document["trucks"]["psva"] == "yours, as it is"
    assert document["claims"][0]["verdict"] == "reproduced"


def test_ids_and_letters() -> None:
    assert chosen_ids(["c3", "D"]) == ("C3", "D1", "D2", "D3", "D4")
    assert chosen_ids([]) == tuple(claims())
    with pytest.raises(ModelError, match=r"no such claim; found 'Z9'"):
        chosen_ids(["A1", "Z9"])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["Q7"], "there is no such claim"),
        (["--truck", "nix.yaml"], "there is no such file"),
        (["--truck", EXAMPLES / "marine_line.yaml"], "absorber"),
        (["-o", "page.pdf"], "the ending of the file"),
        (["-o", "nix/page.html"], "there is no such folder"),
        (["--trucks", "0"], "--trucks"),
    ],
    ids=lambda value: "",
)
def test_refusals(torsional: Run, arguments: list[object], said: str) -> None:
    told = torsional("claims", "A2", "--quick", *arguments)
    assert told.code == 2 and said in told.err and "Traceback" not in told.err
    assert list(Path().iterdir()) == []
