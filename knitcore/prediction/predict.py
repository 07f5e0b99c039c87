"""Predict a chart of a material by one rule.

1. A chart that is one pure fabric has that fabric's own law and size (*measured*; *estimated* or
   *swept* if the record is).
2. A chart with a yarn-level sweep of its own has that sweep's correction of the mixture of its pure
   fabrics (*swept*). The caller gives the sweep; for a simulated material, which the yarn level
   defines, it is also looked up among the packaged ones.
3. Any other chart is a mixture of the pure fabrics with a correction learned from yarn-level
   simulations of mixed charts (*learned*). It is close to every simulated repeat and continuous in
   the shares of a chart's stitches, so one stitch more or less changes little.
4. A repeat of more than 16 stitches a side is predicted patch by patch
   (:mod:`knitcore.prediction.patches`).
5. Other stitches (lace, cables, slips, tucks) change the size of the chart's knits and purls by
   their effects on knitted swatches, and widen its other intervals
   (:mod:`knitcore.prediction.stitch_effects`).
6. A known size replaces the predicted one and narrows the intervals of the stretch (*learned with
   known size*).

Measured materials do not look sweeps up: the packaged ones are of one of several shapes that a
repeat may take, and no nearer to another of its shapes than the learned prediction is.
"""

from knitcore.base.kinds import check_kind
from knitcore.chart.phases import pure_fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart, as_stitches
from knitcore.materials import Material, as_material
from knitcore.prediction.densities import densities
from knitcore.prediction.learned import SweptChart, packaged_model
from knitcore.prediction.mixed import predict_mixed
from knitcore.prediction.patches import MAX_SIDE, Patches, in_patches, is_large
from knitcore.prediction.prediction import Prediction
from knitcore.prediction.pure import predict_pure
from knitcore.prediction.size import RelaxedSize, check_size
from knitcore.prediction.stitch_effects import with_other_stitches


def predict(
    chart: StitchChart | SymbolChart | str,
    material: Material | str,
    size: RelaxedSize | None = None,
    swept: SweptChart | None = None,
) -> Prediction:
    """Predict the relaxed size, moduli and curves of a chart of a material, with their intervals.

    Parameters
    ----------
    chart : a repeat, or a swatch that may cut its last repeat off; or its text, or the name of a
        pure fabric. It may have lace, cables, slipped and tucked stitches.
    material : a yarn at one setting, or its identifier.
    size : relaxed size of the chart's mean stitch, if known.
    swept : yarn-level sweep of the chart's repeat (:mod:`knitcore.prediction.swept`), if any.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks, or an argument is not of its kind.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> garter = predict(StitchChart.of_fabric("garter", 31, 31), material("acrylic"))
    >>> round(garter.modulus_course_n_per_mm, 3), round(garter.modulus_wale_n_per_mm, 3)
    (0.134, 0.081)
    >>> predict("KKPP", "acrylic").provenance
    <Source.LEARNED: 'learned'>
    >>> predict("KKPP", "acrylic:simulation").provenance
    <Source.SWEPT: 'swept'>
    """
    stitches, of = as_stitches(chart), as_material(material)
    if isinstance(stitches, StitchChart):
        return patches_of(stitches, of, size, swept).together()
    plain = patches_of(stitches.plain, of, size, swept).together()
    return with_other_stitches(plain, stitches, of, size_is_known=size is not None)


def patches_of(
    chart: StitchChart,
    material: Material,
    size: RelaxedSize | None = None,
    swept: SweptChart | None = None,
    most: int = MAX_SIDE,
) -> Patches:
    """Divide a chart into the patches that :func:`predict` puts together; most are one patch.

    Parameters
    ----------
    chart, material, size, swept : as for :func:`predict`.
    most : patches along each side, at most.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    if size is not None:
        check_size(size)
    if swept is not None:
        check_kind("swept", swept, SweptChart, "Give a SweptChart, as swept_chart() returns it.")
    fabric = pure_fabric(chart)
    if fabric is not None:
        pure = predict_pure(fabric, material)
        return Patches.whole(chart, pure if size is None else pure.with_size(size))
    repeat = chart.repeat_cut()
    if swept is None and material.is_simulated:
        swept = packaged_model().sweep_of(repeat, material)
    if swept is None and is_large(repeat):
        return in_patches(repeat, material, size, most)
    composition = densities(repeat)
    learned = packaged_model().response(composition, material, size, swept)
    mixed = predict_mixed(repeat, composition, material, learned, size, swept)
    return Patches.whole(chart, mixed)
