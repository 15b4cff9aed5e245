"""Motion of a centrifugal pendulum along its path: exact geometry, inertias and forces, compiled.

The path's direction turns by u/λ with sin u = λ s/ρ0, so that its radius of curvature is ρ² = ρ0² − λ² s²: a circle for
λ = 0, a cycloid for λ = 1, the epicycloid that is the tautochrone for λ² = n²/(1 + n²) (Denman, J. Sound Vib. 159
(1992) 251).  In the carrier's frame the mass lies X along the tangent of the path at rest and Y from the axis; s is arc
length.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math

from torsional.numerics.uncounted import uncounted

END = 1.0 - 1e-9
"""Share of the way to the cusp up to which a path has a direction."""

Path = tuple[float, float, float, float, float]


@uncounted()
def path_at(curvature_radius: float, flattening: float, distance: float, arc: float) -> Path:
    """X, Y [m], X', −Y' [-] and the curvature 1/ρ [1/m] at arc length s [m]; beyond the path's end those of the end.

    ``curvature_radius`` ρ0 [m] at rest, ``flattening`` λ, ``distance`` c [m] of the mass from the axis at rest.

    >>> tuple(round(value, 6) for value in path_at(0.01, 0.0, 0.1, 0.01 * math.pi / 2))
    (0.01, 0.09, 0.0, 1.0, 100.0)
    """
    rho, lam = curvature_radius, flattening
    if lam < 1e-9:
        turned = arc / rho
        return (
            rho * math.sin(turned),
            distance - rho * (1.0 - math.cos(turned)),
            math.cos(turned),
            math.sin(turned),
            1 / rho,
        )
    u = math.asin(min(max(lam * arc / rho, -END), END))
    more, less = 1.0 / lam + 1.0, 1.0 / lam - 1.0
    # ∫ cos(u/λ) cos u du and ∫ sin(u/λ) cos u du; with λ = 1 the second terms are u and 0
    along = math.sin(more * u) / more + (math.sin(less * u) / less if less > 1e-9 else u)
    inwards = (1.0 - math.cos(more * u)) / more + ((1.0 - math.cos(less * u)) / less if less > 1e-9 else 0.0)
    half, turned = 0.5 * rho / lam, u / lam
    return half * along, distance - half * inwards, math.cos(turned), math.sin(turned), 1.0 / (rho * math.cos(u))


Terms = tuple[float, float, float, float]


@uncounted()
def pendulum_terms(
    curvature_radius: float, flattening: float, distance: float, arc: float, rate: float, turning: float
) -> Terms:
    """R² [m²] and G [m], and per unit of mass the forces on the carrier [m²/s²] and along the path [m/s²].

    T = ½ m (ṡ² + R² θ̇² + 2 G ṡ θ̇) with R² = X² + Y² and G = Y X' − X Y' gives

        θ: m (R² θ̈ + G s̈) + m ((R²)' ṡ θ̇ + G' ṡ²) = …        s: m (s̈ + G θ̈) − ½ m (R²)' θ̇² = …

    The forces are the second terms, with ``rate`` ṡ [m/s] and ``turning`` θ̇ [rad/s], the carrier's whole speed.
    """
    x, y, cosine, sine, curvature = path_at(curvature_radius, flattening, distance, arc)
    half_slope = x * cosine - y * sine  # ½ (R²)'
    bend = curvature * (x * cosine - y * sine)  # G' = Y X'' − X Y''
    squared, lever = x * x + y * y, y * cosine + x * sine
    return squared, lever, 2.0 * half_slope * rate * turning + bend * rate * rate, -half_slope * turning * turning


@uncounted()
def weight_terms(
    curvature_radius: float, flattening: float, distance: float, arc: float, angle: float, gravity: float
) -> tuple[float, float]:
    """What weight exerts per unit of mass on the carrier [m²/s²] and along the path [m/s²].

    ``angle`` [rad] of the pendulum's place on the carrier from the top, in the sense of rotation; ``gravity`` [m/s²].
    The height is Y cos(angle) − X sin(angle).
    """
    x, y, cosine, sine, _ = path_at(curvature_radius, flattening, distance, arc)
    up, aside = math.cos(angle), math.sin(angle)
    return gravity * (y * aside + x * up), gravity * (sine * up + cosine * aside)
