"""DMF-LCP-1 by SciPy's adaptive integrators, compiled right-hand side or one in NumPy, and by steps written for it."""

from __future__ import annotations

import numba
import numpy as np
from scipy.integrate import solve_ivp
from tests.validation import dmf_lcp
from tests.validation.dmf_lcp import INERTIA, NODES

IMPLICIT = ("LSODA", "Radau", "BDF")


def run(method: str, rtol: float, atol: float, span: float, sampling: float, rates=dmf_lcp.right_hand_side):
    """θ0 − θ1 [rad] at the samples, and how often the right-hand side was asked for."""
    found = solve_ivp(
        rates,
        (0.0, span),
        np.zeros(2 * NODES),
        method=method,
        t_eval=np.linspace(0.0, span, round(span / sampling) + 1),
        rtol=rtol,
        atol=atol,
        **({"jac": dmf_lcp.jacobian} if method in IMPLICIT and rates is dmf_lcp.right_hand_side else {}),
    )
    assert found.success, found.message
    return dmf_lcp.observed(found.y.T)[:, 0], found.nfev


def _ends(plus: np.ndarray, minus: np.ndarray) -> np.ndarray:
    """Rows that take node angles to those of springs."""
    table = np.zeros((len(plus), NODES))
    table[np.arange(len(plus)), plus] += 1.0
    table[np.arange(len(plus)), minus] -= 1.0
    return table


_SPRINGS, _LINKS = _ends(dmf_lcp.PLUS, dmf_lcp.MINUS), _ends(dmf_lcp.FIRST, dmf_lcp.SECOND)
_K = _LINKS.T @ (dmf_lcp.STIFFNESS[:, None] * _LINKS)
_C = _LINKS.T @ (dmf_lcp.DAMPING[:, None] * _LINKS)


def numpy_rates(t: float, y: np.ndarray) -> np.ndarray:
    """ẏ of the state y with whole matrices, as one writes it first."""
    angle, rate = y[:NODES], y[NODES:]
    gap = dmf_lcp.GAP + _SPRINGS @ (angle + dmf_lcp.CONTACT_TIME * rate)
    torque = _SPRINGS.T @ np.maximum(0.0, -dmf_lcp.SPRING_STIFFNESS * gap) - _K @ angle - _C @ rate
    low, high, span, mean = dmf_lcp.RUN_UP.drive
    turned = low * t + (high - low) * t * t / (2 * span)
    torque[dmf_lcp.PRIMARY] += mean + dmf_lcp.SWING * np.sin(dmf_lcp.ORDER * turned)
    torque[dmf_lcp.VEHICLE] -= mean
    return np.concatenate([rate, torque / INERTIA])


def classical(step: float, span: float, sampling: float) -> np.ndarray:
    """θ0 − θ1 [rad] by Runge's and Kutta's classical steps, compiled for these equations and nothing else."""
    found = np.zeros(round(span / sampling) + 1)
    _classical(step, round(span / step), round(sampling / step), dmf_lcp.RUN_UP.drive, found)
    return found


@numba.njit(cache=True, error_model="numpy")
def _classical(h, steps, stride, drive, found):
    y, stage, k = np.zeros(2 * NODES), np.empty(2 * NODES), np.empty((4, 2 * NODES))
    ahead, share = (0.0, 0.5, 0.5, 1.0), (1.0, 2.0, 2.0, 1.0)
    for n in range(steps):
        for s in range(4):
            for i in range(2 * NODES):
                stage[i] = y[i] + ahead[s] * h * k[s - 1, i] if s else y[i]
            dmf_lcp.fill_rates((n + ahead[s]) * h, stage, k[s], drive)
        for s in range(4):
            for i in range(2 * NODES):
                y[i] += h / 6.0 * share[s] * k[s, i]
        if (n + 1) % stride == 0:
            found[(n + 1) // stride] = y[0] - y[1]
