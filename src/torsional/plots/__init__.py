"""Pictures: one function a picture, from a Dataset or DataArray to a matplotlib Figure."""

from torsional.plots.arcs import plot_arc_friction, plot_arc_losses
from torsional.plots.bands import plot_bands
from torsional.plots.branches import plot_branches
from torsional.plots.campbell import plot_campbell, plot_resonance_speeds
from torsional.plots.chain import plot_chain
from torsional.plots.claims import plot_design_maps, plot_gear_ratios, plot_work_precision
from torsional.plots.cycle import plot_cycle
from torsional.plots.doubling import plot_doubling, plot_regression
from torsional.plots.engine import plot_engine_orders, plot_full_load
from torsional.plots.hysteresis import plot_hysteresis, plot_hysteresis_loops
from torsional.plots.maps import plot_map, plot_ratio_map
from torsional.plots.modes import plot_energy_shares, plot_mode_shapes
from torsional.plots.orders import plot_gears, plot_order_cuts
from torsional.plots.periodic import plot_periodic
from torsional.plots.region import plot_region
from torsional.plots.scenario import plot_scenario
from torsional.plots.sensitivity import plot_sensitivities
from torsional.plots.solution import plot_loops, plot_signals, plot_solutions
from torsional.plots.spectra import plot_spectrogram, plot_waterfall
from torsional.plots.springs import plot_characteristic, plot_travel
from torsional.plots.style import panels, save_png, save_svg
from torsional.plots.sweeps import plot_sweep
from torsional.plots.tracking import plot_rotation, plot_tracked_orders
from torsional.plots.transient import plot_transient

__all__ = [
    "panels",
    "plot_arc_friction",
    "plot_arc_losses",
    "plot_bands",
    "plot_branches",
    "plot_campbell",
    "plot_chain",
    "plot_characteristic",
    "plot_cycle",
    "plot_design_maps",
    "plot_doubling",
    "plot_energy_shares",
    "plot_engine_orders",
    "plot_full_load",
    "plot_gear_ratios",
    "plot_gears",
    "plot_hysteresis",
    "plot_hysteresis_loops",
    "plot_loops",
    "plot_map",
    "plot_mode_shapes",
    "plot_order_cuts",
    "plot_periodic",
    "plot_ratio_map",
    "plot_region",
    "plot_regression",
    "plot_resonance_speeds",
    "plot_rotation",
    "plot_scenario",
    "plot_sensitivities",
    "plot_signals",
    "plot_solutions",
    "plot_spectrogram",
    "plot_sweep",
    "plot_tracked_orders",
    "plot_transient",
    "plot_travel",
    "plot_waterfall",
    "plot_work_precision",
    "save_png",
    "save_svg",
]
