"""Components of a model file as components of a powertrain, and back."""

from __future__ import annotations

from collections.abc import Callable

from torsional import components as made
from torsional.absorbers import CentrifugalPendulum, Rollers
from torsional.components import Component
from torsional.errors import ModelError
from torsional.files.schema import parts as schema
from torsional.files.schema.absorber import PendulumFields, SwitchBlock
from torsional.files.schema.fields import Block
from torsional.stamps import SpeedSwitch


def component(block: Block, path: str) -> Component:
    """The component of a block; ModelError names the key path."""
    try:
        return _MAKERS[type(block)](block)
    except ModelError as error:
        raise error.located(prefix=path) from None


def switch(block: SwitchBlock) -> SpeedSwitch:
    """The other inertia above a speed."""
    return SpeedSwitch(block.inertia, block.above, block.hysteresis)


def pendulum(block: PendulumFields, carrier: str) -> CentrifugalPendulum:
    """A centrifugal pendulum on a carrier."""
    r = block.rollers
    rollers = Rollers(r.mass, r.inertia, r.radius, r.distance) if r else None
    return CentrifugalPendulum(
        carrier,
        block.mass,
        block.distance,
        block.order,
        block.damping,
        block.path,
        rollers,
        block.count,
        block.stop,
        block.stop_stiffness,
        block.stop_time,
    )


def _shaft(b: schema.ShaftPart) -> Component:
    kind = made.Tyre if b.type == "tyre" else made.Shaft
    return kind(b.a, b.b, b.stiffness, b.damping, b.loss_factor)


def _planetary_gear(b: schema.PlanetaryGearPart) -> Component:
    return made.PlanetaryGear(b.sun, b.ring, b.carrier, b.standing_ratio, b.planet_inertia, b.planet_ratio)


def _distributed_shaft(b: schema.DistributedShaftPart) -> Component:
    return made.DistributedShaft(
        b.a,
        b.b,
        length=b.length,
        outer_diameter=b.outer_diameter,
        inner_diameter=b.inner_diameter,
        elements=b.elements,
        shear_modulus=b.shear_modulus,
        density=b.density,
        loss_factor=b.loss_factor,
    )


_MAKERS: dict[type[Block], Callable[..., Component]] = {
    schema.InertiaPart: lambda b: made.Inertia(b.inertia, b.node or ""),
    schema.VehiclePart: lambda b: made.Vehicle(b.mass, b.rolling_radius, b.node or ""),
    schema.ShaftPart: _shaft,
    schema.DamperPart: lambda b: made.Damper(b.a, b.b, b.damping),
    schema.CouplingPart: lambda b: made.Coupling(b.a, b.b, b.law(), b.damping),
    schema.FrictionWasherPart: lambda b: made.Coupling(b.a, b.b, b.law(), b.damping),
    schema.GearPairPart: lambda b: made.GearPair(b.a, b.b, b.ratio),
    schema.PlanetaryGearPart: _planetary_gear,
    schema.SuperpositionPart: lambda b: made.Superposition(b.node, b.a, b.b, b.ratio),
    schema.PlanetSpinPart: lambda b: made.PlanetSpin(
        b.a, b.b, b.ratio, b.inertia, switch(b.switch) if b.switch else None
    ),
    schema.DistributedShaftPart: _distributed_shaft,
    schema.PendulumPart: lambda b: pendulum(b, b.carrier),
}
