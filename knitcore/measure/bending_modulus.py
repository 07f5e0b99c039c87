"""Bending modulus of a yarn from photos of it hanging from a horizontal clamp.

The heavy elastica (:mod:`knitcore.measure.heavy_elastica`) is fitted to the traced centreline over
the half of the yarn next to the clamp: farther down the yarn hangs straight and shows its set
rather than its stiffness. The exact place of the clamp is fitted too, because a photo is cropped
near it. B comes out proportional to the linear density.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_linear_density, check_positive, check_range
from knitcore.base.errors import InputError
from knitcore.base.gravity import STANDARD_GRAVITY_M_PER_S2
from knitcore.base.kinds import as_numbers
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.result import Result
from knitcore.measure.centreline import Centreline, load_grey, trace_centreline
from knitcore.measure.heavy_elastica import heavy_elastica

FITTED_SHARE = 0.5
"""Share of the yarn, from the clamp, that is fitted."""
LOG_LOADS = np.linspace(np.log(0.1), np.log(3e5), 60)
"""Starts of the search for the load."""
WORST_RMS_SHARE = 0.02
"""Largest rms distance, over the length, at which a line is accepted as hanging yarn."""


@dataclass(frozen=True, eq=False)
class BendingPhoto:
    """Result from one photo.

    Attributes
    ----------
    name : file name.
    bending_modulus_n_mm2 : B, N·mm².
    load : dimensionless weight w L³/B.
    length_mm : hanging length.
    px_per_mm : scale of the photo.
    yarn_width_mm : as seen in the photo.
    rms_mm : distance between the traced line and the elastica over the fitted half.
    traced_mm, fitted_mm : (n, 2) points right of and below the clamp, for pictures.
    """

    name: str
    bending_modulus_n_mm2: float
    load: float
    length_mm: float
    px_per_mm: float
    yarn_width_mm: float
    rms_mm: float
    traced_mm: Array
    fitted_mm: Array


@dataclass(frozen=True, eq=False, repr=False)
class MeasuredBending(Result):
    """Mean over photos.

    Attributes
    ----------
    bending_modulus_n_mm2 : mean, N·mm².
    standard_deviation : of one photo, N·mm² (None for a single photo).
    standard_error : of the mean, N·mm² (None for a single photo).
    photos : the result from each.
    notes : remarks about the photos.
    """

    bending_modulus_n_mm2: float
    standard_deviation: float | None
    standard_error: float | None
    photos: tuple[BendingPhoto, ...]
    notes: tuple[str, ...]


def measure_bending(
    paths: Sequence[Path],
    *,
    linear_density_g_per_m: float,
    length_mm: float | Sequence[float] | None = None,
    px_per_mm: float | None = None,
) -> MeasuredBending:
    """Bending modulus from photos.

    Parameters
    ----------
    paths : photos, level, cropped to the hanging part with the clamp at one side.
    linear_density_g_per_m : mass per length of the yarn (0.5 g/m = 500 tex).
    length_mm : hanging length, one for all photos or one per photo.
    px_per_mm : scale, if it is known. Without it the traced length is the hanging length.

    Raises
    ------
    InputError
        If a photo does not show a hanging yarn, or its scale is unknown.
    """
    if not paths:
        raise InputError("images", "no photo is given.", "Give at least one photo.")
    check_linear_density(linear_density_g_per_m)
    lengths = _lengths(length_mm, len(paths))
    if px_per_mm is not None:
        check_positive("px_per_mm", px_per_mm, "px/mm", "a scale")
    photos, notes = [], []
    for path, length in zip(paths, lengths, strict=True):
        if length is None and px_per_mm is None:
            problem = "neither the hanging length nor a scale is given, so the photo has no scale."
            remedy = "Give length_mm (clamp to free end, along the yarn) or px_per_mm."
            raise InputError("length_mm", problem, remedy)
        name, line = Path(path).name, _traced(Path(path))
        notes += _doubts(name, line, length)
        photos.append(
            _fit_photo(name, line, linear_density_g_per_m, length_mm=length, px_per_mm=px_per_mm)
        )
    values = np.array([photo.bending_modulus_n_mm2 for photo in photos])
    several = len(values) > 1
    deviation = float(values.std(ddof=1)) if several else None
    if not several:
        notes.append("One photo does not show the scatter between samples.")
    return MeasuredBending(
        bending_modulus_n_mm2=float(values.mean()),
        standard_deviation=deviation,
        standard_error=None if deviation is None else deviation / float(np.sqrt(len(values))),
        photos=tuple(photos),
        notes=tuple(notes),
    )


@in_reading_time
def _traced(path: Path) -> Centreline:
    return trace_centreline(load_grey(path), name=path.name)


def _doubts(name: str, line: Centreline, length_mm: float | None) -> list[str]:
    """Notes on a photo that may not show the whole yarn; InputError if it cannot be used."""
    notes = []
    if not line.tip_in_photo:
        if length_mm is None:
            problem = "the free end is outside the photo, so its length is unknown."
            raise InputError(name, problem, "Give length_mm, or a photo of the whole hanging yarn.")
        notes.append(f"{name}: the yarn reaches the photo's border; is its end missing?")
    if line.next_largest > 0.2:
        notes.append(
            f"{name}: something else stands out, {line.next_largest:.0%} of the yarn's area;"
            " is the yarn in pieces?"
        )
    return notes


def _lengths(length_mm: float | Sequence[float] | None, count: int) -> list[float | None]:
    if length_mm is None:
        return [None] * count
    remedy = "Give one length for all, or one per photo in the same order."
    given: list[float] = np.ravel(as_numbers("length_mm", length_mm, remedy)).tolist()
    if len(given) == 1:
        given = given * count
    if len(given) != count:
        raise InputError("length_mm", f"{len(given)} lengths are given for {count} photos.", remedy)
    for value in given:
        check_range("length_mm", value, 5, 5000, "mm", "a hanging length")
    return list(given)


def _fit_photo(
    name: str,
    line: Centreline,
    linear_density_g_per_m: float,
    *,
    length_mm: float | None,
    px_per_mm: float | None,
) -> BendingPhoto:
    scale = px_per_mm or line.length_px / (length_mm or 1.0)
    length = length_mm or line.length_px / scale
    width = line.width_px / scale
    if length_mm and px_per_mm and not 0.7 <= line.length_px / scale / length <= 1.3:
        raise InputError(
            name,
            f"the yarn in the photo is {line.length_px / scale:.0f} mm long by its scale, but"
            f" {length:.0f} mm are given.",
            "Correct px_per_mm or length_mm.",
        )
    if not 0.02 <= width <= 20:
        problem = f"with this scale the yarn is {width:.3g} mm wide."
        raise InputError(name, problem, "Check the unit of length_mm or px_per_mm.")
    arc, traced = line.arc_px / scale, np.stack([line.x_px, line.y_px], axis=1) / scale
    part = arc <= FITTED_SHARE * length
    load, rms, shift = _elastica_through(name, arc[part], traced[part], length)
    weight_n_per_mm = linear_density_g_per_m * 1e-6 * STANDARD_GRAVITY_M_PER_S2
    _, model_x, model_y = heavy_elastica(load)
    return BendingPhoto(
        name=name,
        bending_modulus_n_mm2=weight_n_per_mm * length**3 / load,
        load=load,
        length_mm=length,
        px_per_mm=scale,
        yarn_width_mm=width,
        rms_mm=rms,
        traced_mm=traced,
        fitted_mm=np.stack([model_x, model_y], axis=1) * length - shift,
    )


def _elastica_through(
    name: str, arc_mm: Array, traced_mm: Array, length_mm: float
) -> tuple[float, float, Array]:
    """Load Γ of the hanging yarn nearest to a line, the rms distance, and its shift (2,), mm."""

    def difference(log_load: float) -> Array:
        s, *model = heavy_elastica(float(np.exp(log_load)))
        there = [np.interp(arc_mm / length_mm, s, along) for along in model]
        return np.stack(there, axis=1) * length_mm - traced_mm

    def cost(log_load: float) -> float:
        return float(difference(log_load).var(axis=0).sum())

    costs = [cost(value) for value in LOG_LOADS]
    best = int(np.argmin(costs))
    if best == 0:
        problem = "the yarn does not sag under its weight."
        raise InputError(name, problem, "Hang a longer piece, and photograph it level.")
    if best == len(costs) - 1:
        raise InputError(
            name, "the yarn is too straight: its bend is not resolved.", "Hang a shorter piece."
        )
    minimum = scipy.optimize.minimize_scalar(
        cost, bounds=(LOG_LOADS[best - 1], LOG_LOADS[best + 1]), method="bounded"
    )
    rms = float(np.sqrt(minimum.fun))
    if rms > WORST_RMS_SHARE * length_mm:
        problem = f"the traced line is {rms:.1f} mm off any hanging yarn's shape."
        remedy = "The photo must be level, with the clamp at one side and the yarn hanging freely."
        raise InputError(name, problem, remedy)
    return float(np.exp(minimum.x)), rms, difference(float(minimum.x)).mean(axis=0)
