"""The model file's reader: what YAML 1.2 says, and one sentence for every way a file can be bad."""

from __future__ import annotations

import json
import math
import warnings
from pathlib import Path

import pytest
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from tests.files.mutation import mutants

from torsional.errors import ModelError
from torsional.files.reader import DEPTH, MODEL_BYTES, NODES, Tree, parse_tree, read_tree

TRUCK = """\
torsional: 1
name: 13-litre truck   # a comment
engine: {bore: 131 mm, firing_order: [1, 5, 3, 6, 2, 4]}
absorber:
  primary_inertia: 1.2
  stages:
    - {up_to: 1000 Nm, stiffness: 8 kNm/rad}
    - up_to: 3500 Nm
      stiffness: 24e3
components: {}
operation: {speed: 600:2000 rpm, torque: full_load}
note: |
  two
  lines
"""
DATA = {
    "torsional": 1,
    "name": "13-litre truck",
    "engine": {"bore": "131 mm", "firing_order": [1, 5, 3, 6, 2, 4]},
    "absorber": {
        "primary_inertia": 1.2,
        "stages": [{"up_to": "1000 Nm", "stiffness": "8 kNm/rad"}, {"up_to": "3500 Nm", "stiffness": 24e3}],
    },
    "components": {},
    "operation": {"speed": "600:2000 rpm", "torque": "full_load"},
    "note": "two\nlines\n",
}


def refusal(text: str | bytes, json_only: bool = False) -> ModelError:
    with pytest.raises(ModelError) as caught:
        parse_tree(text, file="truck.yaml", json_only=json_only)
    assert caught.value.file == "truck.yaml"
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 400
    return caught.value


def test_a_model_file_becomes_a_plain_tree_with_lines(tmp_path: Path) -> None:
    path = tmp_path / "truck.yaml"
    path.write_text(TRUCK, encoding="utf-8")
    tree = read_tree(path)
    assert tree.data == DATA
    assert tree.file == str(path)
    assert tree.line("absorber.stages.1.stiffness") == 9
    assert tree.place("absorber.stages.0.up_to") == "absorber.stages.0.up_to (line 7)"
    assert tree.place("absorber.damping.3") == "absorber.damping.3 (line 4)"
    assert tree.place("vehicle") == "vehicle"


@pytest.mark.parametrize("indent", [None, 1, "\t"])
def test_json_gives_the_same_tree(tmp_path: Path, indent: int | str | None) -> None:
    path = tmp_path / "truck.JSON"
    path.write_text(json.dumps(DATA, indent=indent), encoding="utf-8")
    tree = read_tree(path)
    assert tree.data == DATA
    assert tree.line("absorber.stages.1") == (1 if indent is None else 22)


def test_json_text_keeps_its_escapes() -> None:
    text = r'{"name": "\"a\\b\/\u00e9\ud83d\ude9b, [c]: {d}", "n": -1.5e3}'
    assert parse_tree(text, json_only=True).data == {"name": '"a\\b/é🚛, [c]: {d}', "n": -1500.0}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e4", 10000.0),
        ("-7", -7),
        ("+7", 7),
        ("012", 12),
        ("1.", 1.0),
        (".5", 0.5),
        ("1e999", math.inf),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("true", True),
        ("False", False),
        ("no", "no"),
        ("~", None),
        ("", None),
        ("null", None),
        ("12:30:00", "12:30:00"),
        ("2024-01-01", "2024-01-01"),
        ("1_000", "1_000"),
        ("1e", "1e"),
        ("nan", "nan"),
        ("'1'", "1"),
        ('"true"', "true"),
        ('"\\u00e9"', "é"),
        ("1,5", "1,5"),
        ("25 kNm/rad", "25 kNm/rad"),
        ("- 1", [1]),
        ("=1+1", "=1+1"),
        ("<b>", "<b>"),
    ],
)
def test_scalars_are_those_of_yaml_1_2(text: str, value: object) -> None:
    found = parse_tree(f"a:\n  {text}\n").data["a"]
    assert found == value
    assert type(found) is type(value)


def test_not_a_number_stays_a_float_for_the_units_to_refuse() -> None:
    assert math.isnan(parse_tree("a: .nan").data["a"])


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        ("", ["the file is empty"]),
        (" \n\t\n", ["the file is empty"]),
        ("# only\n# comments\n", ["the file holds no model, only comments or blanks"]),
        ("---\n", ["the file holds no model"]),
        ("---\n...\n", ["the file holds no model"]),
        ("just words", ["line 1: the file must begin with keys, such as 'torsional: 1'; found 'just words'"]),
        ("\n- a\n- b\n", ["line 2: the file must begin with keys", "found a list"]),
        ("a: 1\nb: 2\na: 3\n", ["a (line 3): the key stands twice; found it stands on line 1 already"]),
        ("a:\n  b: {c: 1,\n c: 2}\n", ["a.b.c (line 3): the key stands twice", "line 2 already"]),
        ("a: &x 1\nb: 2\n", ["line 1: YAML anchors ('&') are not read; found '&x'"]),
        ("a: 1\nb: *x\n", ["line 2: YAML aliases ('*') are not read; found '*x'"]),
        ("a: !!python/object:os.system x", ["line 1: YAML tags ('!') are not read; found '!!python/object:os.system'"]),
        ("a: !!int 1", ["YAML tags ('!') are not read"]),
        ("!", ["YAML tags"]),
        ("a: 1\n<<: {b: 2}\n", ["line 2: merge keys '<<' are not read; write the keys out"]),
        ("a: 1\n---\nb: 2\n", ["line 2: a second document begins here ('---')", "one model a file"]),
        ("%YAML 1.1\n---\na: 1\n", ["only the directive '%YAML 1.2' is read"]),
        ("%TAG ! tag:x,2000:\n---\na: 1\n", ["only the directive '%YAML 1.2' is read"]),
        ("a:\n  1: 2\n", ["a (line 2): a key must be a word; found '1'; put it in quotes"]),
        ("true: 2\n", ["line 1: a key must be a word; found 'true'"]),
        ("? \n: 2\n", ["a key must be a word; found ''"]),
        ("? [a, b]\n: 2\n", ["line 1: a key must be a word, not a list or a mapping"]),
        ("{a: {b: 1}: 2}", ["line 1"]),
        ('"": 2\n', ["this cannot be a key; found ''"]),
        ("a.b: 2\n", ["this cannot be a key; found 'a.b'", "key paths are written with dots"]),
        ("k" * 65 + ": 2\n", ["this cannot be a key", "1 to 64 characters"]),
        ('"a\\nb": 2\n', ["a key must be printable; found 'a\\nb'"]),
        ("a: 0x1F\n", ["a (line 1): numbers are decimal; found '0x1F'"]),
        ("a: 0o17\n", ["numbers are decimal", "in quotes if a text is meant"]),
        ("a: -0b1\n", ["numbers are decimal"]),
        ("a: " + "9" * 5000, ["a (line 1): a number this long is not read", "at most 40 digits"]),
        ("a: 1\n\tb: 2\n", ["line 2: this is not YAML"]),
        ("a:\n\t- 2\n", ["line 2: this is not YAML", "indent with blanks, not tabs"]),
        ("a: b: c\n", ["line 1: this is not YAML: mapping values are not allowed here", "needs quotes"]),
        ("a: [1, 2\nb: 3\n", ["this is not YAML", "(begun on line 1)", "close the brackets"]),
        ('a: "1\nb: 3\n', ["this is not YAML", "(begun on line 1)", "close the quotes"]),
        ("a: 1\n b: 2\n", ["line 2: this is not YAML"]),
        ("a:\n    b: 1\n  c: 2\n", ["line 3: this is not YAML", "check the indentation"]),
        ("a: @x\n", ["line 1: this is not YAML", "'@'"]),
        ("a: 1\nb: \x1b[31m\n", ["line 2: the file holds a control character; found U+001B; remove it"]),
        ("a: 1\u2028b: 2\n", ["line 1: the file holds a control character; found U+2028"]),
        ("a: \ufeff1\n", ["found U+FEFF"]),
        ("a: \uffff\n", ["found U+FFFF"]),
        ('a: "\\x1b[31m"\n', ["a (line 1): the text holds a control character; found U+001B"]),
        ('a: "\\ud83d"\n', ["a (line 1): the text holds a control character; found U+D83D"]),
        ('a: "\\UFFFFFFFF"\n', ["cannot be parsed"]),
        (b"a: 1\nb: \0\n", ["line 2: the file holds a control character; found a NUL byte"]),
        (b"a: 1\nb: \xff\n", ["line 2: the file is not UTF-8 text; found byte 0xff at offset 8; save it as UTF-8"]),
        (b"a: caf\xe9\n", ["found byte 0xe9 at offset 6"]),
        (b"\x80\x04\x95.", ["the file is not UTF-8 text"]),
        (b"PK\x03\x04\x14\0", ["line 1: the file holds a control character; found U+0003"]),
        ("a: 1".encode("utf-16"), ["the file is not UTF-8 but probably UTF-16; save it as UTF-8"]),
        ("a: 1".encode("utf-16-be"), ["probably UTF-16"]),
        ("a: 1".encode("utf-32"), ["probably UTF-16"]),
        (b"\xef\xbb\xbf", ["the file is empty"]),
        ("a: " + "[" * 200_000, ["the file is nested too deeply; allowed: at most 30 levels"]),
        ("a: " + "{a: " * 10_000, ["the file is nested too deeply"]),
        ("- " * 100_000, ["the file must begin with keys"]),
        ("a:\n " + "- " * 100_000, ["the file is nested too deeply"]),
        ("".join(" " * i + "a:\n" for i in range(400)), ["(line 31)", "nested too deeply"]),
        ("a: [" + "1," * NODES + "]", ["the file holds too many values; allowed: at most 10000"]),
        ("a: " + "x" * MODEL_BYTES, ["the model is too large; allowed: at most 256 000 bytes"]),
    ],
)
def test_bad_yaml_is_refused_in_one_sentence(text: str | bytes, sentences: list[str]) -> None:
    told = str(refusal(text))
    for sentence in sentences:
        assert sentence in told.replace("line 31:", "(line 31)")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "the file is empty"),
        ('{"a": 1', "line 1, column 8: this is not JSON: Expecting ',' delimiter"),
        ('{"a": 1,\n}', "this is not JSON"),
        ("a: 1", "line 1, column 1: this is not JSON: Expecting value"),
        ('{"a": 1} {"b": 2}', "this is not JSON: Extra data"),
        ('{"a": 1,\n"a": 2}', "a (line 2): the key stands twice; found it stands on line 1 already"),
        ('{"a": NaN}', "line 1: a finite number is wanted; found 'NaN'"),
        ('{"a": -Infinity}', "found '-Infinity'"),
        ("[1]", "the file must begin with keys"),
        ("null", "the file must begin with keys"),
        ('{"a": "\t"}', "this is not JSON: Invalid control character"),
        ('{"a": "\\u0000"}', "a (line 1): the text holds a control character; found U+0000"),
        ('{"a": "\\ud800"}', "found U+D800"),
        ('{"a": ' + "9" * 5000 + "}", "a number this long is not read"),
        ('{"a":' + "[" * 100_000, "the file is nested too deeply"),
        ('{"a":' + "[" * 40 + "]" * 40 + "}", "the file is nested too deeply"),
        ('{"a": "x}', "Unterminated string"),
    ],
)
def test_bad_json_is_refused_in_one_sentence(text: str, sentence: str) -> None:
    assert sentence in str(refusal(text, json_only=True))


def test_the_deepest_allowed_file_is_read() -> None:
    text = '{"a":' + "[" * (DEPTH - 1) + "]" * (DEPTH - 1) + "}"
    assert parse_tree(text).data == parse_tree(text, json_only=True).data
    refusal('{"a":' + "[" * DEPTH + "]" * DEPTH + "}")


@pytest.mark.parametrize(
    "text", ["---\na: 1\n...\n", "%YAML 1.2\n---\na: 1\n", "\ufeffa: 1", "a: 1\r\n", "a: 1\r", "{a: 1}"]
)
def test_harmless_spellings_are_read(text: str) -> None:
    assert parse_tree(text).data == {"a": 1}


def test_a_defect_of_the_parser_ends_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(self: YAML, stream: str) -> None:
        raise AttributeError(stream)

    monkeypatch.setattr(YAML, "parse", broken)
    assert refusal("a: 1").problem == "the file cannot be parsed (AttributeError)"


def outcome(data: bytes, json_only: bool) -> Tree | ModelError:
    try:
        return parse_tree(data, file="m", json_only=json_only)
    except ModelError as error:
        return error


@pytest.mark.parametrize("json_only", [False, True])
def test_damaged_files_end_in_a_tree_or_a_sentence(json_only: bool) -> None:
    source = json.dumps(DATA, indent=1) if json_only else TRUCK
    for _name, mutant in mutants(source.encode(), 1600, seed=1):
        found = outcome(mutant, json_only)
        if isinstance(found, ModelError):
            assert str(found).isprintable()
            assert not found.problem.startswith("the file cannot be parsed")
        else:
            assert set(found.lines.values()) <= set(range(1, mutant.count(b"\n") + mutant.count(b"\r") + 2))


def test_what_survives_damage_means_what_another_reader_finds() -> None:
    compared = 0
    for _name, mutant in mutants(TRUCK.encode(), 800, seed=2):
        found = outcome(mutant, json_only=False)
        if isinstance(found, Tree):
            compared += 1
            assert same(found.data, reference(mutant))
    assert compared > 200


def reference(data: bytes) -> object:
    yaml = YAML(typ="safe", pure=True)
    yaml.version = (1, 2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return yaml.load(data.decode("utf-8-sig"))
        except YAMLError as error:  # pragma: no cover - would be a file we read and ruamel does not
            return error


def same(ours: object, theirs: object) -> bool:
    """Equal trees, but where the other reader departs from YAML 1.2: it reads 1_000 as a number and .4e3 as a text."""
    if isinstance(ours, dict) and isinstance(theirs, dict):
        return list(ours) == list(theirs) and all(same(ours[key], theirs[key]) for key in ours)
    if isinstance(ours, list) and isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(same, ours, theirs))
    departs = (isinstance(ours, str) and "_" in ours) or (isinstance(theirs, str) and theirs.startswith("."))
    return departs or (repr(ours) == repr(theirs))


def test_mutants_are_the_same_in_any_order() -> None:
    data = TRUCK.encode()
    assert list(mutants(data, 5, seed=3, start=20)) == list(mutants(data, 25, seed=3))[20:]
    assert len({mutant for _, mutant in mutants(data, 160, seed=3)}) > 130
