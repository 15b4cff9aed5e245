"""Imported models as model files."""

from __future__ import annotations

import io

from torsional.files import expanded
from torsional.model import Model


def yaml_of(model: Model) -> str:
    """A model as a model file of components."""
    from ruamel.yaml import YAML

    yaml, text = YAML(typ="rt"), io.StringIO()
    yaml.width, yaml.default_flow_style = 120, False
    yaml.dump(expanded(model), text)
    return text.getvalue()
