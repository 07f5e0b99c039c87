"""One pull of one fabric, on yarns left out: ``python -m studies.one_pull``.

Each yarn of the library in turn is unknown, and one strip of one of its fabrics is pulled in one
direction to 0.3 N/mm. Prints how far the extensions of the other three fabrics at 0.1 N/mm are off:
by the library's mean, by one factor for all fabrics and directions, by one for the direction that
was pulled, and by the update that :mod:`knitcore.materials.estimate.pulled` makes.
"""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.materials.estimate.mixed_model import LogStrain, MixedModel, covering
from knitcore.materials.estimate.without_tester import (
    HANGING_SCATTER,
    LAW_STRESSES_N_PER_MM,
    library_values,
)
from knitcore.materials.estimate.yarn_statistics import DIRECTIONS, FABRICS
from knitcore.materials.law_uncertainty import COVERAGE, Z_SCORE
from studies.without_tester import extensions


@dataclass(frozen=True, eq=False)
class Missed:
    """Logarithms of predicted over true extensions of the fabrics that were not pulled.

    Attributes
    ----------
    by_model : (pulls, yarns, 3, 2) by pull, yarn, other fabric and direction, for each model.
    inside : the same shape; whether the interval of the update holds the truth. Its width before
        the pull comes from the other seven yarns alone.
    """

    by_model: dict[str, Array]
    inside: Mask


def missed() -> Missed:
    """Errors of all models after each of the eight possible pulls."""
    values = library_values()
    errors: dict[str, list[Array]] = {
        name: [] for name in ("mean", "one factor", "factor of the direction", "update")
    }
    inside = []
    for out, own in enumerate(values):
        known = np.delete(values, out, axis=0)
        model, true = MixedModel.fit(known), _exact(own)
        wider = _factor(known) / Z_SCORE
        belief = MixedModel(model.mean, wider**2 * model.covariance)
        before, truth = extensions(model)[0], extensions(true)[0]
        random = np.random.default_rng(out)
        for fabric in range(len(FABRICS)):
            others = [index for index in range(len(FABRICS)) if index != fabric]
            for axis in range(len(DIRECTIONS)):
                points = [
                    LogStrain(
                        fabric, axis, stress,
                        true.log_strain(fabric, axis, stress)[0]
                        + HANGING_SCATTER * random.normal(),
                        HANGING_SCATTER,
                    )
                    for stress in LAW_STRESSES_N_PER_MM
                ]  # fmt: skip
                off = [
                    p.value - model.log_strain(fabric, axis, p.stress_n_per_mm)[0] for p in points
                ]
                along = np.zeros(2)
                along[axis] = np.mean(off)
                after, deviation = extensions(belief.knowing(points))
                predicted = (before, before + np.mean(off), before + along, after)
                for collected, strains in zip(errors.values(), predicted, strict=True):
                    collected.append((strains - truth)[others])
                inside.append((np.abs(after - truth) < Z_SCORE * deviation)[others])
    shape = (len(values), -1, 3, 2)
    return Missed(
        {name: np.reshape(each, shape).swapaxes(0, 1) for name, each in errors.items()},
        np.reshape(np.array(inside), shape).swapaxes(0, 1),
    )


def _exact(values: Array) -> MixedModel:
    return MixedModel(values, np.zeros((values.size, values.size)))


def _factor(known: Array) -> float:
    """Standard deviations that 90 % of the extensions of yarns left out of these need."""
    off = []
    for index, own in enumerate(known):
        mean, deviation = extensions(MixedModel.fit(np.delete(known, index, axis=0)))
        off.append(np.abs(mean - extensions(_exact(own))[0]) / deviation)
    return covering(np.array(off), COVERAGE)


def main() -> None:
    """Print the table of the study."""
    result = missed()
    pulls = [f"{fabric} {direction}-wise" for fabric in FABRICS for direction in DIRECTIONS]
    for index, name in enumerate([*pulls, "all"]):
        chosen = slice(None) if name == "all" else slice(index, index + 1)
        shown = [
            f"{model} {np.exp(np.sqrt(np.mean(logs[chosen] ** 2))):.2f}"
            for model, logs in result.by_model.items()
        ]
        print(f"{name:22} {', '.join(shown)}; inside {result.inside[chosen].mean():.0%}")


if __name__ == "__main__":
    main()
