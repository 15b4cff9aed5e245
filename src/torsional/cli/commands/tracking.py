"""The command about orders of measurements."""

from __future__ import annotations

from torsional.cli import measured_options as m
from torsional.cli import options as o
from torsional.cli.app import app
from torsional.cli.jobs import Job, job


@app.command()
def orders(
    file: m.Recording,
    tacho: m.Tacho = "",
    wheel: m.Wheel = "",
    kind: m.TachoKind = "",
    ratio: m.Ratio = "",
    index: m.Index = "",
    marks: m.Marks = "",
    channel: m.Channels = None,
    shaft: m.Shafts = None,
    orders: m.Tracked = "",
    cycles: m.Cycles = "",
    window: m.Window = "",
    amplitude: m.Amplitudes = "",
    shown_as: m.ShaftsAs = "",
    picture: m.Picture = "",
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Orders of a measured run-up.

    Angle and speed from tacho pulses, counters or encoders, faults of pulses mended and told; amplitudes and phases of
    orders over speed, of shafts with the noise of their clock.  -o takes a page, .html, too.
    """
    return job("orders", **locals())
