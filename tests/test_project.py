"""The project's own promises: two commands, pinned names, small modules, nothing heavy at start-up."""

from __future__ import annotations

import ast
import importlib.util
import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from ruamel.yaml import YAML

import torsional
from torsional.cli.app import command
from torsional.files.schema.document import json_schema
from torsional.results import ANY, NAMES
from torsional.units import QUANTITIES

ROOT = Path(__file__).parent.parent
MODULES = sorted((ROOT / "src" / "torsional").rglob("*.py"))
ROOMS = {path.stem for path in (ROOT / "src" / "torsional").iterdir() if not path.stem.startswith("_")}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def loaded(path: Path) -> ModuleType:
    """A script that is no part of the package."""
    spec = importlib.util.spec_from_file_location(f"loaded_{path.stem}", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def tracked() -> list[Path]:
    """Files under version control, or none where there is no version control."""
    try:
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, text=True)
    except (OSError, subprocess.CalledProcessError):
        return []
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


# --- start-up ---


@pytest.mark.parametrize("statement", ["import torsional", "import torsional.cli", "dir(__import__('torsional'))"])
def test_start_up_leaves_numpy_alone(statement: str) -> None:
    heavy = "sorted({'numpy', 'numba', 'scipy', 'xarray', 'matplotlib', 'pydantic'} & set(sys.modules))"
    code = f"import sys; {statement}; print({heavy})"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert answer.stdout.strip() == "[]"


@pytest.mark.parametrize("name", torsional.__all__)
def test_every_public_name_exists_and_is_described(name: str) -> None:
    thing = getattr(torsional, name)
    assert isinstance(thing, ModuleType) == (name in ROOMS)  # a name that a module has too would be either by chance
    assert not (callable(thing) or name in ROOMS) or (thing.__doc__ or "").strip()


def test_rooms_of_the_package_are_entered_by_their_names() -> None:
    code = "import torsional as tv; print(tv.plots.plot_map.__name__, tv.laws.Hinges is tv.Hinges, 'laws' in dir(tv))"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert answer.stdout.split() == ["plot_map", "True", "True"]


# --- sizes ---


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_modules_and_functions_are_small(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 300
    functions = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.FunctionDef | ast.AsyncFunctionDef)]
    long = {f.name: lines for f in functions if (lines := body_lines(f)) > 40}
    assert not long


def body_lines(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Lines of a function's body, its docstring left out."""
    body = function.body[1:] if ast.get_docstring(function) is not None else function.body
    return body[-1].end_lineno - body[0].lineno + 1 if body else 0  # type: ignore[operator]


# --- names and versions ---


def pins() -> dict[str, str]:
    """The constraints, by normalised name."""
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pairs = [re.fullmatch(r"([A-Za-z0-9._-]+)==([A-Za-z0-9.!+]+)", line) for line in lines]
    assert all(pairs), "constraints.txt holds names and versions only"
    return {normalised(pair[1]): pair[2] for pair in pairs if pair}


def normalised(name: str) -> str:
    """A distribution's name as registries compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def test_every_declared_dependency_is_pinned() -> None:
    extras = PROJECT["optional-dependencies"].values()
    declared = [*PROJECT["dependencies"], *(requirement for extra in extras for requirement in extra)]
    names = {normalised(re.split(r"[^A-Za-z0-9._-]", requirement)[0]) for requirement in declared}
    assert sorted(names - set(pins()) - {PROJECT["name"]}) == []  # extras may name each other


def test_one_version_everywhere() -> None:
    citation = YAML(typ="safe").load(ROOT / "CITATION.cff")
    assert torsional.__version__ == PROJECT["version"] == str(citation["version"])


def test_citation_names_the_thesis_and_the_authors() -> None:
    citation = YAML(typ="safe").load(ROOT / "CITATION.cff")
    assert citation["authors"] == [{"name": "The torsional developers"}]
    (thesis,) = citation["references"]
    assert (thesis["type"], thesis["year"]) == ("thesis", 2020)
    assert "multiple-mass flywheel concepts" in thesis["title"]
    assert PROJECT["license"] == citation["license"] == "BSD-3-Clause"


# --- what is under version control ---


def test_no_lock_file_nothing_large() -> None:
    files = tracked()
    assert not [file for file in files if file.name == "uv.lock"]
    assert not [file for file in files if file.stat().st_size > 1_000_000]


def test_no_package_address_in_a_project_file() -> None:
    for name in ("constraints.txt", "pyproject.toml", "Makefile", ".ci/run"):
        assert "://" not in (ROOT / name).read_text(encoding="utf-8"), name


def test_the_lock_of_the_page_names_no_addresses() -> None:
    locked = json.loads((ROOT / "page" / "package-lock.json").read_text(encoding="utf-8"))["packages"].values()
    assert all("resolved" not in package for package in locked)
    assert all("integrity" in package for package in locked if package.get("name") != "torsional-workbench")


SCRIPTS = sorted(path for room in ("src", "tests") for path in (ROOT / "page" / room).rglob("*.ts*"))


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.name)
def test_modules_of_the_page_are_small(path: Path) -> None:
    assert len(path.read_text(encoding="utf-8").splitlines()) <= 300


# --- make ---


def test_make_help_lists_every_target() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    phony = re.search(r"^\.PHONY: (help .*)$", makefile, re.MULTILINE)
    assert phony
    described = re.findall(r"^([a-z-]+):.*## ", makefile, re.MULTILINE)
    assert sorted(described) == sorted(phony[1].split())


def test_readme_and_ci_use_the_targets() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "make demo" in readme and "make test" in readme
    stages = re.search(r"for target in (.*); do", (ROOT / ".ci" / "run").read_text(encoding="utf-8"))
    assert stages and stages[1].split() == ["lint", "types", "imports", "examples", "docs", "page", "test"]


def test_every_module_has_a_floor() -> None:
    contract = (ROOT / ".importlinter").read_text(encoding="utf-8")
    floors = set(re.findall(r"[a-z_]+", contract.split("layers =")[1]))
    names = {path.relative_to(ROOT / "src" / "torsional").parts[0].removesuffix(".py") for path in MODULES}
    assert sorted(names - floors - {"__init__", "__main__"}) == []


# --- names in words ---


def words_of(tree: ast.Module) -> Iterator[str]:
    """Identifiers of a module, and the words of its short texts: what exists to be named."""
    for node in ast.walk(tree):
        for field in ("id", "attr", "name", "arg", "module"):
            yield from (getattr(node, field, None) or "").split(".")
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and len(node.value) < 60:
            yield from re.findall(r"\w+", node.value)


def docstrings_of(tree: ast.Module) -> Iterator[str]:
    """The docstrings of a module, of its classes and functions."""
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef
    yield from filter(None, (ast.get_docstring(node) for node in ast.walk(tree) if isinstance(node, kinds)))


def test_names_in_backticks_exist() -> None:
    scripts = [path for name in ("tests", "benchmarks", "tools", "examples") for path in (ROOT / name).rglob("*.py")]
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in (*MODULES, *scripts)}
    pages = [ROOT / "README.md", *(page for page in (ROOT / "docs").rglob("*.md") if "_generated" not in page.parts)]
    known = {word for tree in trees.values() for word in words_of(tree)} | {path.stem for path in MODULES}
    known |= {"tv", "md", "py", "pyi", "toml", "yaml", "docs"}
    told = [text for path in MODULES for text in docstrings_of(trees[path])]
    told += [page.read_text(encoding="utf-8") for page in pages]
    quoted = {name for text in told for name in re.findall(r"(?<!`)`{1,2}([A-Za-z_][\w.]*)`{1,2}(?!`)", text)}
    numbered = {name for name in quoted if re.search(r"\d", name)}  # parts of rows, as arc_1_3
    assert sorted(name for name in quoted - numbered if not {*filter(None, name.split("."))} <= known) == []


# --- documentation ---


@pytest.fixture
def generate(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    return loaded(ROOT / "docs" / "generate.py")


def test_nomenclature_page_lists_every_quantity_and_name(generate: ModuleType) -> None:
    page = generate.nomenclature(QUANTITIES, NAMES)
    assert {named.quantity for named in NAMES.values()} <= {*QUANTITIES, "", ANY}
    assert all(f"| `{name}` | {named.meaning} |" in page for name, named in NAMES.items())
    for name, quantity in QUANTITIES.items():
        assert f"| {quantity.symbol} | `{name}` | {quantity.long_name} | {quantity.unit} |" in page


def test_every_command_and_option_is_described(generate: ModuleType) -> None:
    program = command()
    page = generate.faces.command_line_page(program)
    for name, sub in program.commands.items():
        assert f"## `torsional {name}`" in page and sub.help
        assert [p.name for p in sub.params if p.name != "help" and not p.help] == []


def test_model_file_page_tells_units_limits_and_defaults(generate: ModuleType) -> None:
    page = generate.faces.model_file_page(json_schema())
    assert "| `secondary_inertia` | kgm² > 0 | required |" in page
    assert "| `absolute_damping` | Nm s/rad ≥ 0, or a list | `0.0` | of each throw, to ground |" in page
    links = set(re.findall(r"\(#(block-[a-z-]+)\)", page))
    assert links <= set(re.findall(r"^\((block-[a-z-]+)\)=$", page, re.MULTILINE))


@pytest.mark.parametrize(
    ("plain", "written"),
    [
        ("|H_ij| of 2*x_ and ``a*b``.", r"\|H\_ij\| of 2\*x\_ and ``a*b``."),
        (
            "As the law `Hinges`:\n\n    f = k*x\n\n    g = 2",
            "As the law ``Hinges``:\n\n::\n\n    f = k*x\n\n    g = 2",
        ),
        (">>> 1 * 1\n1", ">>> 1 * 1\n1"),
        ("* one\n  more\n* two", "* one more\n* two"),
    ],
)
def test_docstrings_are_plain_text(generate: ModuleType, plain: str, written: str) -> None:
    assert generate.restructured(plain) == written


# --- the data of the benchmarks ---


def test_chain15_has_its_known_modes_and_response() -> None:
    chain15 = loaded(ROOT / "benchmarks" / "chain15.py")
    chain = chain15.matrices()
    scale = 1.0 / np.sqrt(chain15.INERTIA)
    squares = np.linalg.eigvalsh(scale[:, None] * chain.K * scale)
    np.testing.assert_allclose(np.sqrt(squares[1:6]) / (2 * np.pi), chain15.NATURAL_FREQUENCIES, atol=5e-5)
    angle, torque = chain15.dense(np.array([800.0, 1500.0]))
    third, fourth_and_half = 5, 8
    gearbox = chain15.NODES.index("gearbox_input")
    found = [abs(torque[0, third, chain15.DUAL_MASS]), abs(torque[1, fourth_and_half, chain15.DUAL_MASS])]
    np.testing.assert_allclose(found, [461.598699, 31.135577], rtol=2e-8)
    found = [abs(angle[0, third, gearbox]), abs(angle[1, fourth_and_half, gearbox])]
    np.testing.assert_allclose(found, [7.744631121e-3, 5.324797673e-5], rtol=1e-9)
