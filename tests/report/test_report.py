"""The page: self-contained, escaped, whole."""

from __future__ import annotations

import base64
import re
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from tests.report.conftest import example

from torsional.errors import ModelError
from torsional.report import write_report
from torsional.report.analysis import Comparison
from torsional.report.findings import findings

DATA = "data:image/svg+xml;base64,"
VOID = {"meta", "link", "img"}


class Reader(HTMLParser):
    """Tags with their attributes, the text, and whether tags close as they open."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.open: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self.open += [] if tag in VOID else [tag]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] != "style":
            self.text += data

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attrs for name, attrs in self.tags if name == tag]


@pytest.fixture(scope="module")
def read(page: str) -> Reader:
    return Reader(page)


def pictures(page: str) -> list[str]:
    return [base64.b64decode(code).decode() for code in re.findall(DATA.replace("+", r"\+") + '([^"]+)"', page)]


def test_nothing_is_asked_of_the_network(page: str, read: Reader) -> None:
    addresses = [
        v for _, attrs in read.tags for k, v in attrs.items() if k in ("src", "href", "srcset", "action", "data")
    ]
    assert addresses
    assert all(str(address).startswith(("#", "data:")) for address in addresses)
    assert not read.all("script")
    assert not re.search(r"url\(|@import|https?:", re.sub(r"data:[^\"]+", "", page))
    for svg in pictures(page):
        links = [v for e in ElementTree.fromstring(svg).iter() for k, v in e.attrib.items() if k.endswith("href")]
        assert all(link.startswith(("#", "data:")) for link in links)
        assert "<script" not in svg


def test_every_tag_is_closed_and_every_link_leads_somewhere(read: Reader) -> None:
    assert read.open == []
    places = {attrs["id"] for _, attrs in read.tags if "id" in attrs}
    assert {str(attrs["href"])[1:] for attrs in read.all("a")} == places


def test_sections(read: Reader) -> None:
    wanted = ["findings", "machine-1", "machine-2", "interference", "excitation", "orders", "maps", "travel", "motions"]
    assert [attrs["id"] for attrs in read.all("section")] == [*wanted, "cycle", "conventions"]


def test_every_picture_has_a_caption_and_a_text(read: Reader) -> None:
    images = read.all("img")
    assert len(images) >= 20
    assert len(read.all("figcaption")) == len(images)
    assert all(image["alt"] and int(str(image["width"])) > 100 for image in images)


def test_findings_are_on_the_page(trucks: Comparison, read: Reader) -> None:
    sentences = [finding.text for _, found in findings(trucks) for finding in found]
    assert len(sentences) > 8
    assert all(sentence in read.text for sentence in sentences)


def test_modes_and_provenance_are_on_the_page(trucks: Comparison, read: Reader) -> None:
    for variant in trucks.variants:
        assert variant.model.hash in read.text
        modes = variant.modes("12")
        assert f"{float(modes.frequency[4]):.2f}" in read.text


def test_names_cannot_be_more_than_names(hostile_page: str) -> None:
    read = Reader(hostile_page)
    assert not read.all("script")
    assert not read.all("b") or all(not attrs for attrs in read.all("b"))
    assert "onerror" not in {key for _, attrs in read.tags for key in attrs}
    assert "<script>alert(1)</script>" in read.text
    assert "{{ 7 * 6 }}" in read.text
    assert "<b>bold</b>" in read.text


def test_a_page_of_modes_alone_and_one_without_gears(hostile_page: str) -> None:
    read = Reader(hostile_page)
    assert "The model has no engine, so this page tells its modes only." in read.text
    assert {attrs["id"] for attrs in read.all("section")} >= {"machine-1", "machine-2", "maps", "cycle"}
    assert not re.search(r"(in|from) gear|gear \d", read.text)


def test_the_file_appears_whole(tmp_path: Path) -> None:
    counted: list[tuple[int, int]] = []
    target = write_report(example("mwm_engine"), tmp_path / "r.html", progress=lambda a, b: counted.append((a, b)))
    assert target.read_text(encoding="utf-8").rstrip().endswith("</html>")
    assert [entry.name for entry in tmp_path.iterdir()] == ["r.html"]
    assert counted[-1] == (1, 1)


def test_the_same_models_give_the_same_page(tmp_path: Path) -> None:
    first, second = (write_report(example("mwm_engine"), tmp_path / f"{i}.html").read_bytes() for i in "ab")
    assert first == second


def test_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"ending in \.html"):
        write_report(example("mwm_engine"), tmp_path / "report.pdf")
    with pytest.raises(ModelError, match="needs a model"):
        write_report([], tmp_path / "r.html")
    with pytest.raises(ModelError, match="no gear '99'"):
        write_report(example("mwm_engine"), tmp_path / "r.html", gears=[99])
