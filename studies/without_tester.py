"""A yarn without a tester, on yarns left out: ``python -m studies.without_tester``.

Each yarn of the library in turn is unknown, and its stockinette is hung with 0.5 and 1.5 kg on
110 mm, both ways; strains carry the errors that are assumed for such photos. Prints how far the
extensions at 0.1 N/mm are off, beside the library's mean and beside the simplest model.
"""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Fabric
from knitcore.materials.estimate.mixed_model import LogStrain, MixedModel, covering
from knitcore.materials.estimate.without_tester import HANGING_SCATTER, library_values
from knitcore.materials.estimate.yarn_statistics import FABRICS, LOAD_N_PER_MM
from knitcore.materials.law_uncertainty import COVERAGE

HUNG_N_PER_MM = (0.045, 0.135)
DRAWS = 5
"""Draws of measuring errors for each yarn."""
OWN = FABRICS.index(Fabric.STOCKINETTE)
OTHERS = [index for index in range(4) if index != OWN]


@dataclass(frozen=True, eq=False)
class Missed:
    """Logarithms of predicted over true extensions of yarns left out.

    Attributes
    ----------
    by_model : (yarns, draws, 4, 2) by yarn, draw, fabric and direction, for each model.
    inside : the same shape; whether the interval of the joint model, made from the other seven
        yarns alone, holds the truth.
    """

    by_model: dict[str, Array]
    inside: Array


def missed() -> Missed:
    """Errors of the library's mean, of one factor for all fabrics, and of the joint model."""
    values = library_values()
    yarns = range(len(values))
    errors = {name: np.zeros((len(values), DRAWS, 4, 2)) for name in ("mean", "factor", "joint")}
    inside = np.zeros((len(values), DRAWS, 4, 2), dtype=bool)
    for out in yarns:
        pairs = {
            other: _measured(np.delete(values, [out, other], axis=0), values[other], seed=other)
            for other in yarns
            if other != out
        }
        off = [np.abs(m.mean_of_joint - m.truth) / m.deviation for m in pairs.values()]
        width = covering(np.array(off), COVERAGE)
        own = _measured(np.delete(values, out, axis=0), values[out], seed=out)
        errors["mean"][out] = own.mean_of_library - own.truth
        errors["factor"][out] = own.mean_of_library + own.shift - own.truth
        errors["joint"][out] = own.mean_of_joint - own.truth
        inside[out] = np.abs(errors["joint"][out]) < width * own.deviation
    return Missed(errors, inside)


@dataclass(frozen=True, eq=False)
class _Draws:
    """Logarithms of extensions at 0.1 N/mm, (4, 2) or (draws, 4, 2)."""

    truth: Array
    mean_of_library: Array
    shift: Array
    mean_of_joint: Array
    deviation: Array


def _measured(known: Array, truth: Array, seed: int) -> _Draws:
    """A yarn that is hung, seen with what is known of others."""
    random = np.random.default_rng(seed)
    model = MixedModel.fit(known)
    true = MixedModel(truth, np.zeros((truth.size, truth.size)))
    before = extensions(model)[0]
    shifts, means, deviations = [], [], []
    for _ in range(DRAWS):
        points = [
            LogStrain(
                OWN, direction, stress,
                true.log_strain(OWN, direction, stress)[0] + HANGING_SCATTER * random.normal(),
                HANGING_SCATTER,
            )
            for direction in range(2)
            for stress in HUNG_N_PER_MM
        ]  # fmt: skip
        off = [p.value - model.log_strain(OWN, p.direction, p.stress_n_per_mm)[0] for p in points]
        shifts.append(np.tile(np.reshape(off, (2, 2)).mean(axis=1), (4, 1)))
        mean, deviation = extensions(model.knowing(points))
        means.append(mean)
        deviations.append(deviation)
    return _Draws(
        extensions(true)[0], before, np.array(shifts), np.array(means), np.array(deviations)
    )


def extensions(model: MixedModel) -> tuple[Array, Array]:
    """Logarithms of the extensions at 0.1 N/mm, and their deviations, (4, 2)."""
    pairs = [[model.log_strain(f, d, LOAD_N_PER_MM) for d in range(2)] for f in range(4)]
    return np.moveaxis(np.array(pairs), -1, 0)[0], np.moveaxis(np.array(pairs), -1, 0)[1]


def main() -> None:
    result = missed()
    for fabrics, name in (([OWN], "stockinette"), (OTHERS, "other fabrics")):
        for model, logs in result.by_model.items():
            rms = np.sqrt((logs[:, :, fabrics] ** 2).mean(axis=(0, 1, 2)))
            print(f"{name:14} {model:8} rms factor {np.exp(rms).round(3)} along rows, columns")
        print(f"{name:14} inside {result.inside[:, :, fabrics].mean():.0%}")


if __name__ == "__main__":
    main()
