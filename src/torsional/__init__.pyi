"""The public names and where they live: the one list, which type checkers, editors and the package itself read."""

from . import (
    absorbers as absorbers,
    components as components,
    engine as engine,
    errors as errors,
    exchange as exchange,
    files as files,
    laws as laws,
    measurements as measurements,
    plots as plots,
    quantities as quantities,
    report as report,
    results as results,
    stamps as stamps,
    units as units,
)
from .absorbers import (
    Absorber as Absorber,
    ArcSprings as ArcSprings,
    CentrifugalPendulum as CentrifugalPendulum,
    CoilSpring as CoilSpring,
    GuideFriction as GuideFriction,
    Rollers as Rollers,
    StraightSprings as StraightSprings,
    arc_spring_flywheel as arc_spring_flywheel,
    cancellation_frequency as cancellation_frequency,
    spring_characteristic as spring_characteristic,
    condensed_flywheel as condensed_flywheel,
    dual_mass_flywheel as dual_mass_flywheel,
    planetary_dual_mass_flywheel as planetary_dual_mass_flywheel,
    power_split_absorber as power_split_absorber,
    single_mass_flywheel as single_mass_flywheel,
    straight_spring_flywheel as straight_spring_flywheel,
    tuned_flange_flywheel as tuned_flange_flywheel,
    tuned_secondary_flywheel as tuned_secondary_flywheel,
    with_friction as with_friction,
    with_pendulum as with_pendulum,
)
from .components import (
    Coupling as Coupling,
    Damper as Damper,
    DistributedShaft as DistributedShaft,
    GearPair as GearPair,
    Inertia as Inertia,
    PlanetaryGear as PlanetaryGear,
    PlanetSpin as PlanetSpin,
    Shaft as Shaft,
    Superposition as Superposition,
    Tyre as Tyre,
    Vehicle as Vehicle,
)
from .components.slip_clutch import SlipClutch as SlipClutch
from .engine import (
    ChenFlynn as ChenFlynn,
    CombustionCycle as CombustionCycle,
    CrankLayout as CrankLayout,
    Engine as Engine,
    Excitation as Excitation,
    FullLoad as FullLoad,
    PressureTrace as PressureTrace,
    SliderCrank as SliderCrank,
    Wiebe as Wiebe,
)
from .errors import ModelError as ModelError, TorsionalError as TorsionalError
from .exchange.fmu.cosimulation import co_simulation as co_simulation
from .exchange.fmu.coupling import FmuPart as FmuPart
from .exchange.fmu.export import export_fmu as export_fmu
from .exchange.inertia_table import read_inertia_table as read_inertia_table
from .exchange.matrices import matrices as matrices, write_matrices as write_matrices
from .exchange.opentorsion_assembly import from_opentorsion as from_opentorsion, read_tors as read_tors
from .files import changed as changed, expanded as expanded, load_model as load_model
from .files.scenario import load_scenario as load_scenario
from .laws import (
    Contacts as Contacts,
    Coulomb as Coulomb,
    Hinges as Hinges,
    Jenkins as Jenkins,
    Karnopp as Karnopp,
    Law as Law,
    LuGre as LuGre,
    Polynomial as Polynomial,
    Stribeck as Stribeck,
    Table as Table,
    contact_time as contact_time,
    hysteresis_loop as hysteresis_loop,
)
from .measurements import (
    load_mapping as load_mapping,
    mapped as mapped,
    read_measurement as read_measurement,
    write_measurement as write_measurement,
)
from .measurements.encoders import (
    shaft_from_counter as shaft_from_counter,
    shaft_from_encoder as shaft_from_encoder,
    shaft_from_speed as shaft_from_speed,
)
from .measurements.orders import (
    in_convention as in_convention,
    torsional_angle as torsional_angle,
    track_orders as track_orders,
)
from .measurements.pulses import pulse_times as pulse_times
from .measurements.resampling import resampled as resampled
from .measurements.rotation import mean_rotation as mean_rotation
from .measurements.shafts import shaft_from_pulses as shaft_from_pulses, tooth_pitch as tooth_pitch
from .measurements.spectrograms import speed_spectrogram as speed_spectrogram
from .model import Gear as Gear, Landmarks as Landmarks, Model as Model, Operation as Operation
from .powertrain import Powertrain as Powertrain
from .quantities import (
    acceleration as acceleration,
    amplitude as amplitude,
    angular_velocity as angular_velocity,
    order_sum as order_sum,
    dominant_element as dominant_element,
    irregularity as irregularity,
    named_modes as named_modes,
    order_share as order_share,
    order_speed as order_speed,
    swing as swing,
    waveform as waveform,
)
from .report import write_report as write_report
from .results import load_results as load_results, save_results as save_results
from .solvers.campbell import campbell as campbell
from .solvers.equilibrium import OperatingPoint as OperatingPoint, equilibrium as equilibrium, linearize as linearize
from .solvers.harmonic import harmonic_response as harmonic_response
from .solvers.hysteresis import hysteresis as hysteresis, model_hysteresis as model_hysteresis
from .solvers.map import response_map as response_map
from .solvers.modal import damped_modes as damped_modes, modal as modal
from .solvers.operating import at_operating_point as at_operating_point
from .solvers.periodic import (
    Load as Load,
    Variation as Variation,
    model_response as model_response,
    periodic_response as periodic_response,
    subharmonic_boundary as subharmonic_boundary,
    subharmonic_map as subharmonic_map,
    varied_response as varied_response,
)
from .solvers.run_up import full_load_response as full_load_response, run_up_response as run_up_response
from .solvers.transient import (
    CylinderTorques as CylinderTorques,
    Governor as Governor,
    OrderTorques as OrderTorques,
    SpeedProfile as SpeedProfile,
    MotionState as MotionState,
    TorqueHistory as TorqueHistory,
    certified as certified,
    crank_angle_of as crank_angle_of,
    engine_drive as engine_drive,
    order_tracking as order_tracking,
    stage_changes as stage_changes,
    steady_map as steady_map,
    steady_state as steady_state,
    steady_sweep as steady_sweep,
    transient as transient,
    windowed_rms as windowed_rms,
)
from .stamps import (
    Connection as Connection,
    Constraint as Constraint,
    Mass as Mass,
    NormalLoad as NormalLoad,
    SpeedSwitch as SpeedSwitch,
)
from .studies.scenarios.run_up import run_up as run_up
from .studies.correlation import correlation as correlation
from .studies.identification.plan import load_identification as load_identification
from .studies.identification.result import identify as identify
from .studies.scenarios.running import run_scenario as run_scenario
from .system import System as System, assemble as assemble
from .units import RPM as RPM

__version__: str
