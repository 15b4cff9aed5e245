"""The region of vibration at half the engine's order over speed and mean torque."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.model import Model
from torsional.quantities.region import stretches
from torsional.studies.subharmonic import full_load_curve, sought_region, within
from torsional.workbench.background.asking import Found, Long, Name, Progress, Range, span_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Region(Long):
    """Where the model shakes at half its engine's order, and how much; over the whole range and then looked at
    closely unless a range is asked for."""

    speed: Range | None = None
    torque: Range | None = None
    element: Name = ""
    node: Name = ""
    speeds: Annotated[int, Field(ge=5, le=200)] = 61
    torques: Annotated[int, Field(ge=3, le=60)] = 21

    def found(self, model: Model, progress: Progress) -> Found:
        """Amplitudes 0-peak of the half order, and the curves that bound it."""
        speed = span_of(self.speed, model.operation.speed, "settings.speed")
        usual = model.torques(2)
        torque = span_of(self.torque, (float(usual[0]), float(usual[1])), "settings.torque")
        data = sought_region(
            model,
            np.linspace(*speed, self.speeds),
            np.linspace(*torque, self.torques),
            model.gear_name(self.gear) or None,
            closely=not (self.speed or self.torque),
            element=self.element,
            node=self.node,
            progress=lambda done, total: progress(done, total, "mean torques"),
        )
        curve = full_load_curve(model, float(data.speed[0]), float(data.speed[-1]))
        return Found(_content(data, curve), lambda: _picture(data, curve), _table(data))


def _content(data: xr.Dataset, curve: xr.DataArray | None) -> dict[str, object]:
    ordered = {
        name: data[name].transpose("mean_torque", "speed").values.astype(float)
        for name in ("amplitude", "twist_amplitude", "acceleration", "stable_solutions", "within_full_load")
    }
    inside = within(data)
    return {
        "gear": str(data.attrs.get("gear", "")),
        "order": float(data.attrs["order"]),
        "element": str(data.attrs["element"]),
        "node": str(data.attrs["node"]),
        "speed": data.speed.values,
        "torque": data.mean_torque.values,
        **ordered,
        "boundary": {
            "speed": data.boundary_speed.values,
            "torque": data.boundary_mean_torque.values,
            "curve": data.boundary_curve.values.astype(float),
            "kind": [str(kind) for kind in data.boundary_kind.values],
        },
        "full_load": None if curve is None else {"speed": curve.speed.values, "torque": curve.values},
        "rows": [
            {"torque": float(torque), "from": low, "to": high}
            for row, torque in enumerate(data.mean_torque.values)
            for _, low, high in stretches(inside, row)
        ],
    }


def _picture(data: xr.Dataset, curve: xr.DataArray | None) -> Figure:
    from torsional.plots import panels, plot_region
    from torsional.plots.style import figure_of

    drawn = panels(1, 2, (7.0, 4.8))
    for axes, shown in zip(drawn, ("amplitude", "acceleration"), strict=True):
        plot_region(data, shown, full_load=curve, title=f"Order {float(data.attrs['order']):g}", axes=axes)
    return figure_of(drawn[0])


def _table(data: xr.Dataset) -> xr.Dataset:
    """The cells; the curves that bound them are left out."""
    return data[[name for name, values in data.data_vars.items() if values.dims == data.amplitude.dims]]
