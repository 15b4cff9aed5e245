"""The model description of a unit: its variables with their units, what it can do, which files it is built of."""

from __future__ import annotations

import re
from collections.abc import Mapping
from xml.etree import ElementTree

from torsional import __version__
from torsional.exchange.fmu.sources import ENTRY
from torsional.exchange.fmu.unit import Unit, Variable

VERSIONS = ("2.0", "3.0")
UNITS: Mapping[str, Mapping[str, int]] = {
    "1": {},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "rad/s2": {"rad": 1, "s": -2},
    "kg.m2": {"kg": 1, "m": 2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N.m/rad": {"kg": 1, "m": 2, "s": -2, "rad": -1},
    "N.m.s/rad": {"kg": 1, "m": 2, "s": -1, "rad": -1},
}
"""Units of variables as products of base units."""


def identifier(name: str) -> str:
    """A name that C and file systems take.

    >>> identifier("13-litre truck"), identifier("привет")
    ('unit_13_litre_truck', 'unit')
    """
    plain = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:60]
    return plain if plain[:1].isalpha() else f"unit_{plain}".rstrip("_")


def description_of(unit: Unit, version: str, token: str) -> str:
    """modelDescription.xml."""
    root = ElementTree.Element("fmiModelDescription", fmiVersion=version, modelName=_written(unit.name))
    root.set("guid" if version == "2.0" else "instantiationToken", token)
    root.set("description", _written(unit.description))
    root.set("generationTool", f"torsional {__version__}")
    root.set("variableNamingConvention", "flat")
    _co_simulation(root, unit, version)
    _units(root)
    categories = ElementTree.SubElement(root, "LogCategories")
    ElementTree.SubElement(categories, "Category", name="logStatusError", description="errors")
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0.0", stepSize=repr(unit.accuracy.step))
    (_variables_2 if version == "2.0" else _variables_3)(root, unit)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def build_description(unit: Unit) -> str:
    """buildDescription.xml, which FMI 3.0 has beside the sources."""
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    build = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=identifier(unit.name))
    files = ElementTree.SubElement(build, "SourceFileSet", language="C99")
    ElementTree.SubElement(files, "SourceFile", name=ENTRY)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _written(text: str) -> str:
    """What XML may hold of a text."""
    return "".join(c if c.isprintable() else " " for c in text)


def _co_simulation(root: ElementTree.Element, unit: Unit, version: str) -> None:
    can = "canGetAndSetFMUstate", "canSerializeFMUstate"
    found = ElementTree.SubElement(root, "CoSimulation", modelIdentifier=identifier(unit.name))
    found.set("canHandleVariableCommunicationStepSize", "true")
    for name in can:
        found.set(name if version == "2.0" else name.replace("FMUstate", "FMUState"), "true")
    if version == "2.0":
        found.set("canNotUseMemoryManagementFunctions", "true")
        ElementTree.SubElement(ElementTree.SubElement(found, "SourceFiles"), "File", name=ENTRY)


def _units(root: ElementTree.Element) -> None:
    told = ElementTree.SubElement(root, "UnitDefinitions")
    for name, powers in UNITS.items():
        base = ElementTree.SubElement(ElementTree.SubElement(told, "Unit", name=name), "BaseUnit")
        for unit, power in powers.items():
            base.set(unit, str(power))


def _meaning(causality: str) -> dict[str, str]:
    """Variability, and where a value comes from at first."""
    if causality == "parameter":
        return {"variability": "fixed", "initial": "exact"}
    return {"variability": "continuous"} | ({"initial": "calculated"} if causality == "output" else {})


def _value(causality: str, variable: Variable) -> dict[str, str]:
    return {"unit": variable.unit} | ({} if causality == "output" else {"start": repr(float(variable.start))})


def _variables_2(root: ElementTree.Element, unit: Unit) -> None:
    listed, outputs = ElementTree.SubElement(root, "ModelVariables"), []
    for number, (causality, variable) in enumerate(unit.variables):
        told = {"name": variable.name, "valueReference": str(number), "description": variable.description}
        one = ElementTree.SubElement(listed, "ScalarVariable", told | {"causality": causality} | _meaning(causality))
        ElementTree.SubElement(one, "Real", _value(causality, variable))
        outputs += [number + 1] if causality == "output" else []
    structure = ElementTree.SubElement(root, "ModelStructure")
    for name in ("Outputs", "InitialUnknowns"):
        group = ElementTree.SubElement(structure, name)
        for index in outputs:
            ElementTree.SubElement(group, "Unknown", index=str(index))


def _variables_3(root: ElementTree.Element, unit: Unit) -> None:
    listed, outputs = ElementTree.SubElement(root, "ModelVariables"), []
    variables = unit.variables
    time = {"name": "time", "valueReference": str(len(variables)), "causality": "independent"}
    ElementTree.SubElement(listed, "Float64", time | {"variability": "continuous", "description": "time", "unit": "s"})
    for number, (causality, variable) in enumerate(variables):
        told = {"name": variable.name, "valueReference": str(number), "description": variable.description}
        told |= {"causality": causality} | _meaning(causality) | _value(causality, variable)
        ElementTree.SubElement(listed, "Float64", told)
        outputs += [number] if causality == "output" else []
    structure = ElementTree.SubElement(root, "ModelStructure")
    for name in ("Output", "InitialUnknown"):
        for number in outputs:
            ElementTree.SubElement(structure, name, valueReference=str(number))
