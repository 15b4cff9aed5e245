"""Archives from strangers: nothing is unpacked that could do harm, and nothing is run that is no unit for here."""

from __future__ import annotations

import sys
import zipfile
from pathlib import Path

import pytest
from tests.shipped import shipped

import torsional as tv
from torsional.errors import ModelError
from torsional.exchange.fmu import reading

pytest.importorskip("fmpy")
DESCRIPTION = "modelDescription.xml"


def opened(path: Path) -> None:
    with reading.unpacked(path):
        pass


@pytest.fixture
def unit(tmp_path: Path) -> Path:
    """A unit without a binary."""
    absorber = shipped("truck_dmf").absorber
    assert absorber is not None
    tv.export_fmu(absorber, tmp_path / "unit.fmu", compiled=False)
    return tmp_path / "unit.fmu"


def repacked(unit: Path, **changed: str) -> Path:
    """The unit with another description."""
    other = unit.with_name("other.fmu")
    with zipfile.ZipFile(unit) as old, zipfile.ZipFile(other, "w") as new:
        for name in old.namelist():
            text = old.read(name).decode()
            for before, after in changed.items() if name == DESCRIPTION else ():
                assert before in text
                text = text.replace(before, after)
            new.writestr(name, text)
    return other


def test_what_is_no_archive(tmp_path: Path) -> None:
    (tmp_path / "x.fmu").write_text("torsional: 1\n", encoding="utf-8")
    with pytest.raises(ModelError, match=r"x.fmu: this is no functional mock-up unit; found not an archive"):
        opened(tmp_path / "x.fmu")
    with pytest.raises(ModelError, match=r"y.fmu: this is no functional mock-up unit; found No such file"):
        opened(tmp_path / "y.fmu")


def test_another_archive(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as archive:
        archive.writestr("readme.txt", "hello")
    with pytest.raises(ModelError, match=r"found another archive; a functional mock-up unit has modelDescription.xml"):
        opened(tmp_path / "x.zip")


@pytest.mark.parametrize("name", ["../evil.so", "/etc/evil", "a/../../evil", "C:\\evil", "..\\evil", "\\\\host\\evil"])
def test_names_that_lead_out_of_the_folder(tmp_path: Path, name: str) -> None:
    with zipfile.ZipFile(tmp_path / "x.fmu", "w") as archive:
        archive.writestr(DESCRIPTION, "<fmiModelDescription/>")
        archive.writestr(zipfile.ZipInfo(name), "evil")
    with pytest.raises(ModelError, match="would lie outside of it"):
        opened(tmp_path / "x.fmu")
    assert [path.name for path in tmp_path.iterdir()] == ["x.fmu"]


def test_links(tmp_path: Path) -> None:
    link = zipfile.ZipInfo("resources/link")
    link.external_attr = 0o120777 << 16
    with zipfile.ZipFile(tmp_path / "x.fmu", "w") as archive:
        archive.writestr(DESCRIPTION, "<fmiModelDescription/>")
        archive.writestr(link, "/etc/passwd")
    with pytest.raises(ModelError, match="the archive holds a link"):
        opened(tmp_path / "x.fmu")


def test_archives_that_would_fill_the_disk(unit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "MOST_BYTES", 10_000)
    with pytest.raises(ModelError, match="would fill the disk"):
        opened(unit)


def test_sixty_megabytes_of_nothing(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "x.fmu", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(DESCRIPTION, "<fmiModelDescription/>")
        archive.writestr("resources/nothing", bytes(60_000_000))
    with pytest.raises(ModelError, match="would fill the disk"):
        opened(tmp_path / "x.fmu")


def test_descriptions_with_entities(unit: Path) -> None:
    bomb = '<!DOCTYPE x [<!ENTITY a "aaaa">]><fmiModelDescription fmiVersion'
    with pytest.raises(ModelError, match="declares entities"):
        opened(repacked(unit, **{"<fmiModelDescription fmiVersion": bomb}))


def test_descriptions_that_fmi_does_not_allow(unit: Path) -> None:
    with pytest.raises(ModelError, match="the unit's description is not what FMI wants"):
        opened(repacked(unit, **{'causality="input"': 'causality="wish"'}))


def test_units_for_model_exchange(unit: Path) -> None:
    with zipfile.ZipFile(unit) as archive:
        text = archive.read(DESCRIPTION).decode()
    first, rest = text.split("<CoSimulation", 1)
    tag, rest = rest.split("</CoSimulation>", 1)
    name = tag.split('modelIdentifier="')[1].split('"')[0]
    with zipfile.ZipFile(unit.with_name("me.fmu"), "w") as archive:
        events = first.replace('variableNamingConvention="flat"', 'numberOfEventIndicators="0"')
        archive.writestr(DESCRIPTION, f'{events}<ModelExchange modelIdentifier="{name}"/>{rest}')
    with pytest.raises(ModelError, match="not made for co-simulation; found model exchange"):
        opened(unit.with_name("me.fmu"))


def test_units_for_other_machines(unit: Path, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"no binary for this machine; found sources alone; have it compiled for"):
        opened(unit)
    with zipfile.ZipFile(unit, "a") as archive:
        archive.writestr("binaries/vax32/unit.exe", "x")
    with pytest.raises(ModelError, match=r"no binary for this machine; found vax32"):
        opened(unit)


def test_the_missing_library_is_named(unit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fmpy", None)
    with pytest.raises(ModelError, match=r"pip install 'torsional\[fmi\]'"):
        opened(unit)
