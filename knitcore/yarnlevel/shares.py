"""Who carries the energy along a stretch: bending or contact (paper, Supplementary Fig. 7)."""

from __future__ import annotations

import numpy as np

from knitcore.yarnlevel.results import Sweep


def overtaking_strain(sweep: Sweep) -> float | None:
    """Strain at which contact first holds half of the energy (linear between points).

    Returns
    -------
    The strain; 0 if contact holds half of it from the start, None if bending leads throughout.
    """
    share, strain = sweep.contact_share, sweep.strain
    above = np.flatnonzero(share >= 0.5)
    if not len(above):
        return None
    i = int(above[0])
    if i == 0:
        return 0.0
    return float(np.interp(0.5, share[i - 1 : i + 1], strain[i - 1 : i + 1]))
